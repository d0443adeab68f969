//! What tells a solid from a sheet.

use glamx::{DVec3, Vec3};

/// What a mesh bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceKind {
    /// A body: closed, or with holes that are small beside it, and wound so that normals point out
    /// of it. Several components, and hollows in them, may make it up.
    Solid,
    /// As a solid, but its normals point inwards.
    InsideOut,
    /// Anything else: an open surface, triangles that disagree about the outside, a soup. It is met
    /// from both sides.
    Sheet,
}

/// Holes of a solid together, as a share of its surface. The eyes of a monkey's head take TODO of
/// it, the opening of a glove TODO, that of a half sphere a half, of a box without lid a fifth. Higher:
/// bodies in a vase are pushed out of it. Lower: a head with a hole is a sheet.
const GREATEST_HOLES: f64 = 0.02;

/// Volume over surface times extent. Zero for a sheet of two layers, 1/2000 for a plate a thousandth
/// as thick as wide.
const LEAST_VOLUME: f64 = 1.0e-6;

pub(super) fn of(vertices: &[Vec3], triangles: &[[u32; 3]], uneven: &[[u32; 2]]) -> SurfaceKind {
    let Some(&first) = triangles.first().and_then(|triangle| vertices.get(triangle[0] as usize))
    else {
        return SurfaceKind::Sheet;
    };
    let corner = |index: u32| vertices[index as usize].as_dvec3() - first.as_dvec3();
    let (mut area, mut volume, mut extent) = (0.0, 0.0, 0.0_f64);
    for triangle in triangles {
        let [a, b, c] = triangle.map(corner);
        let twice = (b - a).cross(c - a);
        area += twice.length() / 2.0;
        volume += a.dot(twice) / 6.0;
        extent = extent.max(a.length());
    }
    // The vector area of the loops of borders: what a cover of the holes has at least.
    let holes: f64 = loops(uneven)
        .iter()
        .map(|edges| {
            let vector: DVec3 = edges.iter().map(|&[a, b]| corner(a).cross(corner(b))).sum();
            vector.length() / 2.0
        })
        .sum();
    let is_closed = holes <= GREATEST_HOLES * area;
    let least = LEAST_VOLUME * area * extent;
    if is_closed && volume > least {
        SurfaceKind::Solid
    } else if is_closed && volume < -least {
        SurfaceKind::InsideOut
    } else {
        SurfaceKind::Sheet
    }
}

/// Edges that hang together.
fn loops(edges: &[[u32; 2]]) -> Vec<Vec<[u32; 2]>> {
    let mut parent: rustc_hash::FxHashMap<u32, u32> = Default::default();
    fn root(parent: &mut rustc_hash::FxHashMap<u32, u32>, mut vertex: u32) -> u32 {
        loop {
            let above = *parent.entry(vertex).or_insert(vertex);
            if above == vertex {
                return vertex;
            }
            let top = *parent.entry(above).or_insert(above);
            parent.insert(vertex, top);
            vertex = above;
        }
    }
    for &[a, b] in edges {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent.insert(a.max(b), a.min(b));
    }
    let mut loops: std::collections::BTreeMap<u32, Vec<[u32; 2]>> = Default::default();
    for &edge in edges {
        loops.entry(root(&mut parent, edge[0])).or_default().push(edge);
    }
    loops.into_values().collect()
}
