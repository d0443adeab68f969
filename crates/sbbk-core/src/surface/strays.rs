//! Strays: triangles that touch an edge or a vertex, though no common edge leads to them.
//!
//! Real meshes have T-junctions, doubled triangles, touching parts, and several vertices at one
//! place. There a one-ring by common edges is not the whole surface around a point. Strays are
//! found by distance, and a contact at an internal edge is a ghost whichever way the mesh
//! continues.

use std::ops::ControlFlow;

use super::facets::Facets;
use super::one_ring::Around;
pub use super::triangle::{seam, touches};
use crate::contact::Feature;
use crate::simd::each;

/// Number of other triangles near a closed one-ring beyond which they do not matter. Higher: dense
/// meshes take longer. Lower: bodies stumble where many parts touch.
const MANY: usize = 64;

/// True if an edge or a vertex of a triangle has strays. So has each edge without a twin: what goes
/// on there is not known. With more than 64 others near, a closed one-ring counts as whole.
pub fn has_strays<F: Facets>(surface: &Around<F>, triangle: u32, feature: Feature) -> bool {
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
