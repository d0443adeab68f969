//! The contact points of a triangle and a face or edge of a convex shape that it meets.

use crate::contact::Feature;
use crate::contact::clip::clip_polygon;
use crate::contact::triangle::{MOST_CORNERS, Polygon, Triangle};
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Each corner and each crossing of two edges.
const CAPACITY: usize = 3 + MOST_CORNERS + 3 * MOST_CORNERS;

/// The points of [`clip_feature`].
pub type FeaturePoints = ArrayVec<FeaturePoint, CAPACITY>;

/// A point on each body, both on one line along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeaturePoint {
    /// The point on the triangle.
    pub on_triangle: DVec3,
    /// The point on the feature of the shape.
    pub on_shape: DVec3,
    /// From the first to the second along the normal.
    pub distance: f64,
    /// The features that meet: a corner of one and the face of the other, or two edges, numbered
    /// from 0. Edge `i` runs from corner `i` to the next.
    pub features: [Feature; 2],
}

/// Fills `out` with the corners of the overlap of a triangle and a feature, seen along `normal`, a
/// unit vector from the triangle to the feature. The feature is an edge of two corners, or a plane
/// convex polygon of three or four; `out` stays empty for other counts. Points at all distances are
/// kept.
pub fn clip_feature(
    triangle: &[DVec3; 3],
    feature: &[DVec3],
    normal: DVec3,
    out: &mut FeaturePoints,
) {
    out.clear();
    let (&[a, b, ..], 2..=MOST_CORNERS) = (feature, feature.len()) else { return };
    let face = feature.first_chunk().map(Triangle::new);
    let size = face.map_or_else(|| (b - a).abs().element_sum(), |face| face.size);
    // Rounding keeps the crossings of an edge that lies along a border.
    let polygon = Polygon { corners: feature, face, size, tie: 0.0 };
    let push = |[on_triangle, on_shape]: [DVec3; 2], distance, features| {
        out.push(FeaturePoint { on_triangle, on_shape, distance, features });
    };
    clip_polygon(&Triangle::new(triangle), &polygon, normal, push);
}
