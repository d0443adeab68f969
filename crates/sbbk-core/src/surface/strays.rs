//! Strays: triangles that touch an edge or a vertex, though no common edge leads to them.
//!
//! Meshes that people make have T-junctions, doubled triangles, parts that only touch, and vertices
//! that should be one. There a one-ring by common edges is not the whole surface around a point.
//! Strays are found by distance, and a contact at an internal edge is a ghost whichever way the mesh
//! continues.

use std::ops::ControlFlow;

use glamx::DVec3;

use super::one_ring::{Facets, OneRing, area_vector};
use crate::contact::Feature;
use crate::simd::each;

/// Greatest distance of a stray, as a share of the longest side of the triangle: that of a needle, and
/// that of other triangles. Higher: walls that stand close to each other count as one surface. Lower:
/// gaps of a modeller count as holes.
const SEAM: [f64; 2] = [1.0e-5, 1.0e-3];

/// Greatest distance of the strays of a triangle. At most half the least height, as slivers would have
/// many others as strays.
pub fn seam(corners @ [a, b, c]: &[DVec3; 3]) -> f64 {
    let longest = a.distance(*b).max(b.distance(*c)).max(c.distance(*a));
    let height = area_vector(corners).length() / longest;
    (0.5 * height).max(SEAM[0] * longest).min(SEAM[1] * longest)
}

/// True if an edge or a vertex of a triangle has strays. So has each edge without a twin: what goes on
/// there is not known.
pub fn has_strays<F: Facets>(surface: &OneRing<F>, triangle: u32, feature: Feature) -> bool {
    let corners = each(|i| surface.facets.corner(3 * triangle, i));
    let mut ring = surface.ring(triangle, feature);
    let [start, end] = match feature {
        Feature::Vertex(i) => [corners[usize::from(i)]; 2],
        Feature::Edge(_) if ring.len() == 1 => return true,
        Feature::Edge(i) => [i, (i + 1) % 3].map(|end| corners[usize::from(end)]),
        Feature::Face => return false,
    };
    let seam = seam(&corners);
    ring.iter_mut().for_each(|half_edge| *half_edge /= 3);
    ring.sort_unstable();
    let is_edge = start != end;
    let is_stray = |other: u32| {
        if ring.binary_search(&other).is_ok() {
            return false;
        }
        let corners = each(|i| surface.facets.corner(3 * other, i));
        // Triangles at an end of an edge touch it there.
        let is_at_end = is_edge && corners.iter().any(|corner| [start, end].contains(corner));
        !is_at_end && touches(&corners, [start, end], seam)
    };
    let mut found = false;
    surface.facets.near([start.min(end) - seam, start.max(end) + seam], &mut |other| {
        found = is_stray(other);
        if found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    found
}

/// True if a triangle with an area comes within `seam` of a segment, or a little farther at its
/// corners.
pub fn touches(corners: &[DVec3; 3], [start, end]: [DVec3; 2], seam: f64) -> bool {
    let [a, ..] = *corners;
    let area = area_vector(corners);
    // Most triangles end here, without a root.
    let heights = [start, end].map(|place| area.dot(place - a));
    let most = seam * seam * area.length_squared();
    let is_beyond = heights.iter().all(|height| height * height > most);
    if is_beyond && heights[0] * heights[1] > 0.0 {
        return false;
    }
    let Some(up) = area.try_normalize() else { return false };
    let sides = each(|i| {
        let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
        (up.cross(along), corners[i])
    });
    let planes = [(up, a), (-up, a)].into_iter().chain(sides);
    // The part of the segment on the inner side of all planes.
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
