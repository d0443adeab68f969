//! Strays: triangles that touch an edge or a vertex, though no common edge leads to them.
//!
//! Meshes that people make have T-junctions, doubled triangles, parts that only touch, and vertices
//! that should be one. There a one-ring by common edges is not the whole surface around a point.
//! Strays are found by distance, and a contact at an internal edge is a ghost whichever way the mesh
//! continues.

use glamx::DVec3;

use super::one_ring::{Facets, OneRing};
use crate::contact::Feature;
use crate::simd::each;

/// Greatest distance of a stray, as a share of the longest side of the triangle. Higher: walls that
/// stand close to each other count as one surface. Lower: gaps of a modeller count as holes.
pub const SEAM: f64 = 1.0e-3;

/// Greatest distance of the strays of a triangle.
pub fn seam([a, b, c]: &[DVec3; 3]) -> f64 {
    SEAM * a.distance(*b).max(b.distance(*c)).max(c.distance(*a))
}

/// The directions in which a triangle extends from a point on it.
pub(super) struct Tangents {
    /// Area vector of the triangle, doubled.
    pub(super) normal: DVec3,
    /// Unit vectors along the sides that the point lies on, and inwards from these.
    sides: arrayvec::ArrayVec<[DVec3; 2], 3>,
}

impl Tangents {
    /// Returns `None` if the origin is farther than `seam` from the triangle, or the triangle has no area.
    pub(super) fn new(corners: &[DVec3; 3], seam: f64) -> Option<Self> {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        let up = normal.try_normalize()?;
        let mut sides = arrayvec::ArrayVec::new();
        let is_near = up.dot(a).abs() <= seam
            && (0..3).all(|i| {
                let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
                let inwards = up.cross(along);
                let beyond = inwards.dot(corners[i]);
                if beyond >= -seam {
                    sides.push([along, inwards]);
                }
                beyond <= seam
            });
        is_near.then_some(Self { normal, sides })
    }

    /// The greatest height along a unit direction of a point of the triangle at distance 1; at most 0
    /// if there is none above.
    pub(super) fn rise(&self, direction: DVec3) -> f64 {
        let flat = direction - direction.project_onto(self.normal);
        if self.sides.iter().all(|[_, inwards]| inwards.dot(flat) >= 0.0) {
            return flat.length();
        }
        let ways = self.sides.iter().flat_map(|[along, _]| [*along, -*along]);
        let ways = ways.filter(|&way| self.sides.iter().all(|side| side[1].dot(way) >= -SEAM));
        ways.map(|way| way.dot(direction)).fold(0.0, f64::max)
    }

    /// True if both lie on opposite sides of a common line.
    pub(super) fn is_across(&self, other: &Self) -> bool {
        let into =
            |tangents: &Self| tangents.sides.iter().map(|[_, inwards]| *inwards).sum::<DVec3>();
        into(self).dot(into(other)) < 0.0
    }
}

/// The strays of an edge or a vertex of a triangle, among the triangles that `near` returns for the
/// box from `low` to `high`.
pub fn find<F: Facets>(
    surface: &OneRing<F>,
    triangle: u32,
    feature: Feature,
    near: impl FnOnce(DVec3, DVec3, &mut dyn FnMut(u32)),
) -> Vec<u32> {
    let corners = each(|i| surface.facets.corner(3 * triangle, i));
    let [start, end] = match feature {
        Feature::Vertex(i) => [corners[usize::from(i)]; 2],
        Feature::Edge(i) => [corners[usize::from(i)], corners[(usize::from(i) + 1) % 3]],
        Feature::Face => return Vec::new(),
    };
    let seam = seam(&corners);
    let mut ring: Vec<u32> = surface.ring(triangle, feature).into_iter().map(|of| of / 3).collect();
    ring.sort_unstable();
    let mut strays = Vec::new();
    near(start.min(end) - seam, start.max(end) + seam, &mut |other| {
        let corners = each(|i| surface.facets.corner(3 * other, i));
        if ring.binary_search(&other).is_err() && touches(&corners, [start, end], seam) {
            strays.push(other);
        }
    });
    strays
}

/// True if a triangle comes within `seam` of a segment, or a little farther at its corners.
pub fn touches(corners: &[DVec3; 3], [start, end]: [DVec3; 2], seam: f64) -> bool {
    let [a, b, c] = *corners;
    let Some(up) = (b - a).cross(c - a).try_normalize() else { return false };
    // The part of the segment within the slab of the triangle, and within its three sides.
    let sides = each(|i| {
        let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
        (up.cross(along), corners[i])
    });
    let planes = [(up, a), (-up, a)].into_iter().chain(sides);
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (inwards, on) in planes {
        let [from, to] = [start, end].map(|place| inwards.dot(place - on) + seam);
        match [from >= 0.0, to >= 0.0] {
            [true, true] => {}
            [false, false] => return false,
            [true, false] => last = last.min(from / (from - to)),
            [false, true] => first = first.max(from / (from - to)),
        }
    }
    first <= last
}
