//! Contacts of crossing triangles that lead out of solids.
//!
//! The least translation of two triangles may push one of them into the other body, or along a
//! surface that continues beyond the triangle. Here only axes that lead out of the solids count:
//! face normals, and products of edges that point outside of both. The contact is on the axis of
//! least overlap among these.

use super::TriangleContact;
use super::clip::{ManifoldPoints, clip_triangles};
use super::feature::Feature;
use super::touching::deepest;
use super::triangle::{NEAR_PARALLEL, NEXT, PREVIOUS, Triangle};
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Sine of the angle by which an axis may lean into a solid. Higher: walls push up bodies that they
/// do not carry. Lower: an edge of a box that stands not quite upright no longer pushes up.
const LEAN: f64 = 0.05;

/// Sine of the angle between an edge and the plane of the other triangle above which the edge
/// determines the sign of the axis. Higher: more axes are tried. Lower: a nut jams on its bolt.
const STEEP: f64 = 0.55;

/// Share of the overlap that the deepest points must show. Higher: contacts are left to neighbours
/// that show more. Lower: contacts far from the end of the overlap.
const SHOWN: f64 = 0.9;

/// Vertices within this distance of the farthest one along an axis are equally far, in triangle
/// sizes. Higher: edges count as level. Lower: rounding picks a vertex.
const LEVEL: f64 = 1.0e-6;

/// Returns the contact of two overlapping triangles along the outward axis of least overlap.
/// `solid` is true for triangles of a solid, whose normals point outside. `is_extremal` returns
/// true if no neighbour of a feature of triangle 1 (0) or 2 (1) is farther in a direction. Extremal
/// axes come first.
///
/// The distance is that of the deepest points; `out` gets the points of [`clip`](super::clip).
/// Returns `None` if the triangles face away from each other, or if no points are in line with the
/// axis.
///
/// With `most`, returns only an extremal contact of at most this depth, at less cost.
pub fn penetration_out_of_solid(
    t1: &[DVec3; 3],
    t2: &[DVec3; 3],
    solid: [bool; 2],
    is_extremal: impl Fn(usize, Feature, DVec3) -> bool,
    most: Option<f64>,
    out: &mut ManifoldPoints,
) -> Option<TriangleContact> {
    let triangles @ [t1, t2] = [&Triangle::new(t1), &Triangle::new(t2)];
    let axes = axes(triangles, solid, most.map_or(f64::INFINITY, |most| most / SHOWN));
    let ends = |i: usize, t: &Triangle, axis: DVec3| is_extremal(i, farthest(t, axis), axis);
    let extremal = axes.iter().find(|&&(_, axis)| ends(0, t1, axis) && ends(1, t2, -axis));
    let any = || axes.first().filter(|_| most.is_none());
    let &(gap, normal) = extremal.or_else(any)?;
    clip_triangles(t1, t2, normal, out);
    let contact = deepest(out, normal)?;
    let contact = TriangleContact { features: contact.features.crossing(), ..contact };
    let is_shown = contact.distance <= SHOWN * gap;
    most.is_none_or(|most| is_shown && contact.distance >= -most).then_some(contact)
}

/// The gap along an axis, and the axis.
type OutwardAxis = (f64, DVec3);

/// The outward axes along which the triangles overlap by at most `most`, least overlap first.
fn axes([t1, t2]: [&Triangle; 2], solid: [bool; 2], most: f64) -> ArrayVec<OutwardAxis, 22> {
    let areas = [t1.area_vector(), t2.area_vector()];
    let [normal1, normal2] = areas.map(|area| area.normalize_or_zero());
    let mut axes = ArrayVec::new();
    let mut consider = |direction: DVec3| {
        let length_squared = direction.length_squared();
        let is_out = |is_solid: bool, along: f64| {
            !is_solid || along >= 0.0 || along * along <= LEAN * LEAN * length_squared
        };
        // Before the division: most directions end here.
        if is_out(solid[0], direction.dot(normal1)) && is_out(solid[1], -direction.dot(normal2)) {
            let axis = direction / length_squared.sqrt();
            let ([_, max1], [min2, _]) =
                (t1.shadow(DVec3::ZERO, axis), t2.shadow(DVec3::ZERO, axis));
            let gap = min2 - max1;
            if gap >= -most {
                axes.push((gap, axis));
            }
        }
    };
    for normal in [normal1, normal2] {
        if normal != DVec3::ZERO {
            consider(normal);
            consider(-normal);
        }
    }
    // Sign with which an edge runs through the plane of the other triangle; 0 if nearly parallel.
    let slopes = |t: &Triangle, normal: DVec3| {
        t.edges.map(|edge| {
            let slope = edge.dot(normal);
            if slope * slope <= STEEP * STEEP * edge.length_squared() {
                0.0
            } else {
                slope.signum()
            }
        })
    };
    let (slopes1, slopes2) = (slopes(t1, normal2), slopes(t2, normal1));
    for (i, j) in (0..9).map(|pair| (pair / 3, pair % 3)) {
        // The edges are in front only if both have one sign, that of the axis (see `axes.rs`).
        let (sign1, sign2) = (slopes1[i], slopes2[j]);
        if sign1 * sign2 < 0.0 {
            continue;
        }
        let (e1, e2) = (t1.edges[i], t2.edges[j]);
        let cross = e1.cross(e2);
        let least = NEAR_PARALLEL * NEAR_PARALLEL * e1.length_squared() * e2.length_squared();
        if cross.length_squared() <= least {
            continue;
        }
        let sign = sign1 + sign2;
        if sign >= 0.0 {
            consider(cross);
        }
        if sign <= 0.0 {
            consider(-cross);
        }
    }
    axes.sort_unstable_by(|(a, _), (b, _)| b.total_cmp(a));
    axes
}

/// The feature that is farthest along an axis.
fn farthest(t: &Triangle, axis: DVec3) -> Feature {
    let heights = t.heights(t.vertices[0], axis);
    let top = heights[0].max(heights[1]).max(heights[2]);
    let is_top = heights.map(|height| height >= top - LEVEL * t.size);
    let first = (0..3).find(|&i| is_top[i] && !is_top[PREVIOUS[i]]);
    match first {
        None => Feature::Face,
        Some(i) if is_top[NEXT[i]] => Feature::Edge(i as u8),
        Some(i) => Feature::Vertex(i as u8),
    }
}
