//! Triangles that cross, of solids: out of each other, not through.
//!
//! The least translation that parts two triangles may push one of them into the body of the other,
//! or along a surface that goes on beyond the triangle. Of the axes that lead out of the solids
//! the one of least overlap is taken: the face normals, and the products of edges that point to the
//! outside of both.

use super::axes::Axis;
use super::feature::{Feature, FeaturePair};
use super::touching::at_axis_deepest;
use super::triangle::{NEAR_PARALLEL, NEXT, PREVIOUS, Triangle};
use super::triangle_contact::TriangleContact;
use glamx::DVec3;

/// Sine of the angle that an axis may lean into a solid: an edge of a box that stands on another,
/// not quite upright, still pushes up. Higher: walls push up bodies that they do not carry.
const LEAN: f64 = 0.05;

/// How much of the overlap the deepest points must show: else the features that end the overlap are
/// elsewhere, in triangles that show it better.
const SHOWN: f64 = 0.9;

/// Vertices this close to the farthest one along an axis are as far, in triangle sizes.
const LEVEL: f64 = 1.0e-6;

/// An outward contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outward {
    /// The distance is that of the deepest points.
    pub contact: TriangleContact,
    /// Whether the surfaces around both triangles end where these do, along the normal.
    pub is_extremal: bool,
}

/// The contact of two triangles that overlap, along the outward axis of least overlap. `solid` says
/// which triangles are of a solid, whose outside their normals point to; `is_extremal` whether no
/// triangle around a feature of triangle 1 (0) or 2 (1) is farther in a direction. Extremal axes
/// go first. None if the triangles face away from each other, or have no points in line with the
/// axis.
pub fn outward(
    t1: &[DVec3; 3],
    t2: &[DVec3; 3],
    solid: [bool; 2],
    is_extremal: impl Fn(usize, Feature, DVec3) -> bool,
) -> Option<Outward> {
    let (t1, t2) = (&Triangle::new(t1), &Triangle::new(t2));
    let [normal1, normal2] = [t1.normal(), t2.normal()];
    let leads_out = |axis: DVec3| {
        let is_out = |is_solid: bool, cosine: f64| !is_solid || cosine >= -LEAN;
        is_out(solid[0], axis.dot(normal1)) && is_out(solid[1], -axis.dot(normal2))
    };
    let crosses =
        t1.edges.into_iter().flat_map(|e1| t2.edges.map(|e2| (e1, e2))).map(|(e1, e2)| {
            let cross = e1.cross(e2);
            let least = NEAR_PARALLEL * NEAR_PARALLEL * e1.length_squared() * e2.length_squared();
            if cross.length_squared() > least { cross.normalize() } else { DVec3::ZERO }
        });
    let axes = [normal1, normal2].into_iter().chain(crosses).flat_map(|axis| [axis, -axis]);
    let faces = FeaturePair::new(Feature::Face, Feature::Face);
    let [mut best, mut extremal] = [Axis::NONE; 2];
    for axis in axes.filter(|&axis| axis != DVec3::ZERO && leads_out(axis)) {
        let along = Axis::one_way(t1, t2, axis, faces);
        if along.gap > best.gap {
            best = along;
        }
        let ends = || {
            is_extremal(0, farthest(t1, axis), axis) && is_extremal(1, farthest(t2, -axis), -axis)
        };
        if along.gap > extremal.gap && ends() {
            extremal = along;
        }
    }
    let is_extremal = extremal.normal != DVec3::ZERO;
    let axis = if is_extremal { extremal } else { best };
    let contact = at_axis_deepest(t1, t2, &axis)?;
    let is_extremal = is_extremal && contact.distance <= SHOWN * axis.gap;
    let contact = TriangleContact { features: contact.features.crossing(), ..contact };
    Some(Outward { contact, is_extremal })
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
