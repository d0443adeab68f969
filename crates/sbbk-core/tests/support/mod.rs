//! Inputs for the tests of this crate: small meshes, poses, and a seeded random source.
#![allow(dead_code)] // Each test binary uses a part.

use std::ops::ControlFlow;

use glamx::{DVec3, Pose3, Quat, Vec3};
use sbbk_core::field::{FieldFrame, FieldLeaves, FieldTriangle, HeightGrid};
use sbbk_core::surface::{Facets, RayTriangles, Surface};
use sbbk_core::traverse::{DescentCounts, TestedBox};
use sbbk_core::tree::{LayerPlan, LeafBatch, Tree};
use sbbk_core::volumes::Kdop;

/// A mesh as the tree takes it.
#[derive(Clone, Debug)]
pub struct Soup {
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Triangles without common vertices, one of each three corners.
    pub fn apart(corners: impl IntoIterator<Item = Vec3>) -> Self {
        let vertices: Vec<Vec3> = corners.into_iter().collect();
        let triangles = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        Self { triangles: triangles.collect(), vertices }
    }

    /// The tree of a plan, or of the plan that is chosen for the mesh.
    pub fn tree(&self, layers: impl Into<Option<LayerPlan>>) -> Tree {
        Tree::build(&self.vertices, &self.triangles, layers.into()).expect("the mesh is valid")
    }

    pub fn surface(&self) -> Surface {
        Surface::new(&self.vertices, &self.triangles, self)
    }

    pub fn facets<'a>(&'a self, surface: &'a Surface) -> PlainFacets<'a> {
        PlainFacets { mesh: self, surface }
    }
}

/// Each ray tests all triangles.
impl RayTriangles for Soup {
    fn count(&self) -> u32 {
        self.triangles.len() as u32
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|corner| self.vertices[corner as usize].as_dvec3())
    }

    fn bounds(&self) -> [DVec3; 2] {
        let vertices = || self.vertices.iter().map(|vertex| vertex.as_dvec3());
        [
            vertices().fold(DVec3::INFINITY, DVec3::min),
            vertices().fold(-DVec3::INFINITY, DVec3::max),
        ]
    }

    fn near(&self, _: u32, _: f64, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let _ = (0..self.count()).try_for_each(visit);
    }

    fn along(&self, _: DVec3, _: DVec3, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let _ = (0..self.count()).try_for_each(visit);
    }
}

/// The triangles of a mesh whose surface has no strays.
#[derive(Clone, Copy)]
pub struct PlainFacets<'a> {
    mesh: &'a Soup,
    surface: &'a Surface,
}

impl Facets for PlainFacets<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        self.surface.twin(half_edge)
    }

    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        self.mesh.corners(half_edge / 3)[(half_edge as usize + i) % 3]
    }
}

/// The k-DOP around some points, as leaves and nodes have them.
pub fn kdop(points: &[Vec3]) -> Kdop {
    let corners = |three: &[Vec3]| [0, 1, 2].map(|i| three[i.min(three.len() - 1)]);
    let fit = |three: &[Vec3]| LeafBatch::gather(&[0], |_| corners(three)).kdop();
    points.chunks(3).map(fit).fold(Kdop::EMPTY, |all, kdop| all.merge(&kdop))
}

/// SplitMix64: enough for test inputs, the same on every machine.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In `[low, high)`.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.bits() >> 40) as f32 / (1u64 << 24) as f32)
    }

    pub fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.range(-size, size), self.range(-size, size), self.range(-size, size))
    }

    pub fn rotation(&mut self) -> Quat {
        loop {
            let q = Quat::from_array([0; 4].map(|_| self.range(-1.0, 1.0)));
            if q.length_squared() > 0.1 && q.length_squared() < 1.0 {
                return q.normalize();
            }
        }
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// In `[low, high)`, with all digits of f64.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly over the orders of magnitude.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.within(low.ln(), high.ln()).exp()
    }

    /// In the cube from -1 to 1.
    pub fn point(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.within(-1.0, 1.0)))
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let point = self.point();
            if (0.01..=1.0).contains(&point.length_squared()) {
                return point.normalize();
            }
        }
    }

    pub fn pose(&mut self, distance: f32) -> Pose3 {
        Pose3::from_parts(self.vector(distance), self.rotation())
    }

    /// A pose near another one: turned and moved by about `size` (radians, units).
    pub fn near(&mut self, pose: &Pose3, size: f32) -> Pose3 {
        let turn = Quat::from_scaled_axis(self.vector(size));
        let rotation = (turn * pose.rotation).normalize();
        Pose3::from_parts(pose.translation + self.vector(size), rotation)
    }
}

/// A bumpy ball of radius about 1: `2 · rings · (2 · rings)` triangles less the poles.
pub fn bumpy_ball(rings: u32, bumps: f32) -> Soup {
    let segments = 2 * rings;
    let mut vertices = Vec::new();
    for ring in 0..=rings {
        for segment in 0..segments {
            let polar = std::f32::consts::PI * ring as f32 / rings as f32;
            let azimuth = std::f32::consts::TAU * segment as f32 / segments as f32;
            let direction =
                Vec3::new(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
            let radius = 1.0 + bumps * (5.0 * azimuth).sin() * (4.0 * polar).sin();
            vertices.push(direction * radius);
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let at = |r: u32, s: u32| r * segments + s % segments;
            let (a, b) = (at(ring, segment), at(ring, segment + 1));
            let (c, d) = (at(ring + 1, segment), at(ring + 1, segment + 1));
            if ring > 0 {
                triangles.push([a, c, b]);
            }
            if ring + 1 < rings {
                triangles.push([b, c, d]);
            }
        }
    }
    Soup { vertices, triangles }
}

/// A cube of half-length 1 along the axes: `2 · cells²` triangles on each side, one side after the
/// other.
pub fn cube(cells: u32) -> Soup {
    let along = |cell: u32| 2.0 * cell as f32 / cells as f32 - 1.0;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for side in 0..6 {
        for cell in 0..cells * cells {
            let first = vertices.len() as u32;
            for [u, v] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
                let mut corner = Vec3::splat(if side < 3 { -1.0 } else { 1.0 });
                corner[(side + 1) % 3] = along(cell % cells + u);
                corner[(side + 2) % 3] = along(cell / cells + v);
                vertices.push(corner);
            }
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    Soup { vertices, triangles }
}

/// Triangles with no connection, of edges up to `size`, in a cube of half-length 1.
pub fn soup(random: &mut Random, count: u32, size: f32) -> Soup {
    let mut triangle = || {
        let centre = random.vector(1.0);
        [0; 3].map(|_| centre + random.vector(size))
    };
    Soup::apart((0..count).flat_map(|_| triangle()))
}

/// Triangles with corners on the integer lattice `0..=side`; some are degenerate.
pub fn lattice_soup(random: &mut Random, count: u32, side: u64) -> Soup {
    let mut corner = || Vec3::from_array([0; 3].map(|_| (random.bits() % (side + 1)) as f32));
    Soup::apart((0..3 * count).map(|_| corner()))
}

/// Walks a tree by the tests of a field. Calls `found` with the triangles of the field and of the
/// mesh that may touch.
pub fn descend_field<F: HeightGrid>(
    tree: &Tree,
    frame: &FieldFrame<'_, F>,
    mut found: impl FnMut(FieldTriangle, u32),
) -> DescentCounts {
    let leaves = FieldLeaves::new(frame, tree.bounding_ball().centre, tree.magnitude());
    let mut counts = DescentCounts::default();
    let mut nodes = vec![tree.root()];
    while let Some(node) = nodes.pop() {
        let aabb = node.aabb();
        counts.aabb_tests += 1;
        if frame.meets(TestedBox::new(aabb.min, aabb.max)) {
            nodes.extend(node.children().into_iter().flatten());
            if let Some(leaf) = node.leaf() {
                leaves.visit(leaf, &mut found);
            }
        }
    }
    counts.cells = frame.cells.get();
    counts
}
