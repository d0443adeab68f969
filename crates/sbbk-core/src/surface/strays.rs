//! Strays: triangles that touch an edge or a vertex, though no common edge leads to them.
//!
//! Real meshes have T-junctions, doubled triangles, touching parts, and several vertices at one
//! place. There a one-ring by common edges is not the whole surface around a point.
//! Strays are found by distance, and a contact at an internal edge is a ghost whichever way the mesh
//! continues.

use std::ops::ControlFlow;

use glamx::DVec3;

use super::one_ring::{Facets, OneRing, area_vector};
use crate::contact::Feature;
use crate::simd::each;

/// Greatest distances of the strays of a needle and of a large triangle, as shares of the longest side.
/// Higher: walls that stand close to each other count as one surface. Lower: gaps of a modeller count
/// as holes.
const SEAM: [f64; 2] = [1.0e-5, 1.0e-3];

/// Returns the greatest distance of the strays of a triangle. This is half the least height, because slivers would
/// have many strays, but between 0.00001 and 0.001 of the longest side.
pub fn seam(corners @ [a, b, c]: &[DVec3; 3]) -> f64 {
    let longest = a.distance(*b).max(b.distance(*c)).max(c.distance(*a));
    let height = area_vector(corners).length() / longest;
    (0.5 * height).max(SEAM[0] * longest).min(SEAM[1] * longest)
}

/// Number of other triangles near a closed one-ring beyond which they do not matter. Higher: dense meshes take
/// longer. Lower: bodies stumble where many parts touch.
const MANY: usize = 64;

/// True if an edge or a vertex of a triangle has strays. So has each edge without a twin: what goes on
/// there is not known. With more than 64 others near, a closed one-ring counts as whole.
pub fn has_strays<F: Facets>(surface: &OneRing<F>, triangle: u32, feature: Feature) -> bool {
    let corners = each(|i| surface.facets.corner(3 * triangle, i));
    let (mut ring, is_closed) = surface.ring(triangle, feature);
    let [start, end] = match feature {
        Feature::Vertex(i) => [corners[usize::from(i)]; 2],
        Feature::Edge(_) if !is_closed => return true,
        Feature::Edge(i) => [i, (i + 1) % 3].map(|end| corners[usize::from(end)]),
        Feature::Face => return false,
    };
    let seam = seam(&corners);
    ring.iter_mut().for_each(|half_edge| *half_edge /= 3);
    ring.sort_unstable();
    let is_edge = start != end;
    let is_stray = |other: u32| {
        let corners = each(|i| surface.facets.corner(3 * other, i));
        // Triangles at an end of an edge touch it there.
        let is_at_end = is_edge && corners.iter().any(|corner| [start, end].contains(corner));
        !is_at_end && touches(&corners, [start, end], seam)
    };
    let (mut found, mut count) = (false, 0);
    surface.facets.near([start.min(end) - seam, start.max(end) + seam], &mut |other| {
        if ring.binary_search(&other).is_err() {
            found = found || is_stray(other);
            count += 1;
        }
        let is_known = if is_closed { count > MANY } else { found };
        if is_known { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    found && !(is_closed && count > MANY)
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
