//! The kind of surface that a mesh forms, by rays from samples of its triangles.

use super::memo::PlaceMemo;
use super::rays::{RayTriangles, sequence};
use super::sides::{RayMesh, Side, WallLimit};
use super::triangle::area_vector;

/// The kind of surface that a mesh forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceKind {
    /// A body with outward normals, closed or nearly so. It may consist of several components, with
    /// hollows.
    Solid,
    /// A body with inward normals.
    InsideOut,
    /// An open surface, a triangle soup, or triangles that disagree about the outside. It collides
    /// on both sides.
    Sheet,
}

/// Greatest share of rays that leave a solid through holes. Higher: bodies in a vase are pushed out
/// of it. Lower: a head with a hole is a sheet.
const HOLES: f64 = 0.06;

/// Numbers of triangles that are tested for [`HOLES`]: the next one if one leaves doubt. The first
/// is enough for terrains. Higher: slower. Lower: chance decides about more meshes.
const SAMPLES: [u32; 3] = [16, 256, 2048];

/// Standard deviations from [`HOLES`] that leave no doubt.
const SURE: f64 = 3.0;

/// Number of triangles that decide which way the normals of a closed surface point.
const VOTES: u32 = 16;

/// Triangles that are considered for samples, evenly spread over the mesh. Higher: a large mesh
/// takes longer. Lower: single large triangles among many are missed.
const CONSIDERED: u32 = 1 << 14;

/// Classifies a mesh by up to 4096 rays, and more at walls.
pub fn kind(triangles: &impl RayTriangles) -> SurfaceKind {
    let memo = &PlaceMemo::default();
    of_samples(&RayMesh::new(triangles, None, memo, WallLimit::MESH))
}

/// Returns true if a mesh is a sheet, by a few rays that meet nothing at all. Such a mesh needs no
/// [`Surface`](super::Surface) to tell. The mesh must have a border.
pub fn is_surely_open(triangles: &impl RayTriangles) -> bool {
    let memo = &PlaceMemo::default();
    let (mesh, samples) =
        (RayMesh::new(triangles, None, memo, WallLimit::MESH), Samples::of(triangles));
    let most = SAMPLES[0];
    let is_bare = |i: &u32| samples.triangle(*i).is_some_and(|triangle| mesh.is_bare(triangle, *i));
    let mut open = (0..most).filter(is_bare).zip(1..);
    open.any(|(_, count)| is_sure(count, most) && share(count, most) > HOLES)
}

/// Triangles of a mesh by a sequence over its area.
struct Samples {
    /// Every so many triangles are considered.
    step: u32,
    /// Area of the considered triangles up to each one.
    areas: Vec<f64>,
}

impl Samples {
    fn of(triangles: &impl RayTriangles) -> Self {
        let step = triangles.count().div_ceil(CONSIDERED).max(1);
        let areas = (0..triangles.count() / step).scan(0.0, |sum, i| {
            let area = area_vector(&triangles.corners(step * i)).length();
            *sum += if area.is_finite() { area } else { 0.0 };
            Some(*sum)
        });
        Self { step, areas: areas.collect() }
    }

    /// Returns triangle `i` of the sequence; `None` if no triangle has an area.
    fn triangle(&self, i: u32) -> Option<u32> {
        let whole = self.areas.last().filter(|whole| **whole > 0.0)?;
        let place = whole * sequence(f64::from(i), 0);
        Some(self.step * self.areas.partition_point(|&sum| sum < place) as u32)
    }
}

fn share(count: u32, of: u32) -> f64 {
    f64::from(count) / f64::from(of)
}

/// Returns true if the share of open triangles is farther from [`HOLES`] than chance explains.
fn is_sure(open: u32, tested: u32) -> bool {
    let doubt = SURE * (HOLES * (1.0 - HOLES) / f64::from(tested)).sqrt();
    (share(open, tested) - HOLES).abs() > doubt
}

/// Classifies a mesh. Closed meshes have no holes.
pub(super) fn of_samples(mesh: &RayMesh<impl RayTriangles>) -> SurfaceKind {
    let is_closed = mesh.is_closed();
    let samples = Samples::of(mesh.triangles);
    let mut counts = [0; 4];
    let mut tested = 0;
    for most in if is_closed { [VOTES; 3] } else { SAMPLES } {
        let may_go_on = |i: &u32| *i < VOTES || !mesh.is_exhausted();
        for i in (tested..most).take_while(may_go_on) {
            let Some(triangle) = samples.triangle(i) else { return SurfaceKind::Sheet };
            counts[mesh.sample_of_mesh(triangle, i) as usize] += 1;
            tested = i + 1;
        }
        let open = counts[Side::Sheet as usize];
        if is_closed || is_sure(open, tested) || mesh.is_exhausted() {
            break;
        }
    }
    let [faces, turned, _, open] = counts;
    if !is_closed && f64::from(open) > HOLES * f64::from(tested) || faces.max(turned) == 0 {
        SurfaceKind::Sheet
    } else if faces >= turned {
        SurfaceKind::Solid
    } else {
        SurfaceKind::InsideOut
    }
}
