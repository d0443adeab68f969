//! The contact points of a triangle and a face or edge of a convex shape that it meets.
//!
//! Seen along the normal, the overlap of both has corners at vertices of one inside the other, and
//! at crossings of edges. The distance takes its extremes there.

use crate::contact::Feature;
use crate::contact::closest::has_one_sign;
use arrayvec::ArrayVec;
use glamx::{DVec2, DVec3};

/// Least sine between the normal and the plane of a feature at which points are projected to that
/// plane, as for two triangles.
const EDGE_ON: f64 = 1.0e-5;

/// Corners of a feature at most.
const FEATURE_CORNERS: usize = 4;

/// Each corner and each crossing of two edges.
const CAPACITY: usize = 3 + FEATURE_CORNERS + 3 * FEATURE_CORNERS;

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
    let count = feature.len();
    if !(2..=FEATURE_CORNERS).contains(&count) {
        return;
    }
    // Relative to a point of one of them: what cancels is small then.
    let origin = triangle[0];
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new((p - origin).dot(x), (p - origin).dot(y));
    let own = triangle.map(flat);
    let mut other = [DVec2::ZERO; FEATURE_CORNERS];
    for (flattened, &corner) in other.iter_mut().zip(feature) {
        *flattened = flat(corner);
    }
    let (next, after) = (|i: usize| (i + 1) % 3, |j: usize| (j + 1) % count);
    // On which side of edge `i` of the triangle corner `j` of the feature is, and the reverse.
    let mut beside = [[0.0; FEATURE_CORNERS]; 3];
    let mut beside_other = [[0.0; 3]; FEATURE_CORNERS];
    for i in 0..3 {
        let edge = own[next(i)] - own[i];
        for j in 0..count {
            beside[i][j] = edge.perp_dot(other[j] - own[i]);
        }
    }
    for j in 0..count {
        let edge = other[after(j)] - other[j];
        for i in 0..3 {
            beside_other[j][i] = edge.perp_dot(own[i] - other[j]);
        }
    }
    if count > 2
        && let Some(slope) = slope([feature[0], feature[1], feature[2]], normal)
    {
        for (i, &corner) in triangle.iter().enumerate() {
            let sides = [0, 1, 2].map(|j| beside_other[j][i]);
            let last = if count == 4 { beside_other[3][i] } else { sides[2] };
            if has_one_sign(sides) && has_one_sign([sides[0], sides[1], last]) {
                let distance = (feature[0] - corner).dot(slope);
                out.push(FeaturePoint {
                    on_triangle: corner,
                    on_shape: corner + normal * distance,
                    distance,
                    features: [Feature::Vertex(i as u8), Feature::Face],
                });
            }
        }
    }
    if let Some(slope) = slope(*triangle, normal) {
        for (j, &corner) in feature.iter().enumerate() {
            if has_one_sign([0, 1, 2].map(|i| beside[i][j])) {
                let distance = (corner - triangle[0]).dot(slope);
                out.push(FeaturePoint {
                    on_triangle: corner - normal * distance,
                    on_shape: corner,
                    distance,
                    features: [Feature::Face, Feature::Vertex(j as u8)],
                });
            }
        }
    }
    for i in 0..3 {
        // An edge is one, not two.
        for j in 0..if count == 2 { 1 } else { count } {
            let [from, to] = [beside_other[j][i], beside_other[j][next(i)]];
            let [start, end] = [beside[i][j], beside[i][after(j)]];
            if from * to < 0.0 && start * end < 0.0 {
                let on_triangle = triangle[i].lerp(triangle[next(i)], from / (from - to));
                let on_shape = feature[j].lerp(feature[after(j)], start / (start - end));
                out.push(FeaturePoint {
                    on_triangle,
                    on_shape,
                    distance: (on_shape - on_triangle).dot(normal),
                    features: [Feature::Edge(i as u8), Feature::Edge(j as u8)],
                });
            }
        }
    }
}

/// The normal of a plane, scaled so that its product with a vector to the plane is the distance
/// along `normal`. `None` for a plane that is seen edge-on.
#[inline(always)]
fn slope([a, b, c]: [DVec3; 3], normal: DVec3) -> Option<DVec3> {
    let face = (b - a).cross(c - a);
    let cosine = face.dot(normal);
    (cosine * cosine > EDGE_ON * EDGE_ON * face.length_squared()).then(|| face / cosine)
}
