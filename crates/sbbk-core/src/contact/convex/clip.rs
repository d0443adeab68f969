//! The contact points of a triangle and a face or edge of a convex shape that it meets.
//!
//! Seen along the normal, the overlap of both has corners at vertices of one inside the other, and
//! at crossings of edges. The distance takes its extremes there.

use crate::contact::Feature;
use crate::contact::clip::EDGE_ON;
use crate::contact::closest::has_one_sign;
use crate::contact::triangle::NEXT;
use arrayvec::ArrayVec;
use glamx::{DVec2, DVec3};

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
    if (2..=FEATURE_CORNERS).contains(&feature.len()) {
        let sides = Sides::new(triangle, feature, normal);
        sides.push_corners_of_triangle(out);
        sides.push_corners_of_feature(out);
        sides.push_crossings(out);
    }
}

/// A triangle and a feature, seen along a normal. Tables tell on which side of each edge of one body
/// each corner of the other is.
struct Sides<'a> {
    triangle: &'a [DVec3; 3],
    feature: &'a [DVec3],
    normal: DVec3,
    /// By edge of the triangle and corner of the feature.
    beside: [[f64; FEATURE_CORNERS]; 3],
    /// By edge of the feature and corner of the triangle.
    beside_other: [[f64; 3]; FEATURE_CORNERS],
}

impl<'a> Sides<'a> {
    #[inline(always)]
    fn new(triangle: &'a [DVec3; 3], feature: &'a [DVec3], normal: DVec3) -> Self {
        // Relative to a point of one of them: what cancels is small then.
        let origin = triangle[0];
        let (x, y) = normal.any_orthonormal_pair();
        let flat = |p: DVec3| DVec2::new((p - origin).dot(x), (p - origin).dot(y));
        let own = triangle.map(flat);
        let mut other = [DVec2::ZERO; FEATURE_CORNERS];
        for (flattened, &corner) in other.iter_mut().zip(feature) {
            *flattened = flat(corner);
        }
        let mut beside = [[0.0; FEATURE_CORNERS]; 3];
        let mut beside_other = [[0.0; 3]; FEATURE_CORNERS];
        let count = feature.len();
        for i in 0..3 {
            let edge = own[NEXT[i]] - own[i];
            for j in 0..count {
                beside[i][j] = edge.perp_dot(other[j] - own[i]);
            }
        }
        for j in 0..count {
            let edge = other[(j + 1) % count] - other[j];
            for i in 0..3 {
                beside_other[j][i] = edge.perp_dot(own[i] - other[j]);
            }
        }
        Self { triangle, feature, normal, beside, beside_other }
    }

    #[inline(always)]
    fn push_corners_of_triangle(&self, out: &mut FeaturePoints) {
        // An edge holds no corner.
        let &[a, b, c, ..] = self.feature else { return };
        let Some(slope) = slope([a, b, c], self.normal) else { return };
        for (i, &corner) in self.triangle.iter().enumerate() {
            let sides = [0, 1, 2].map(|j| self.beside_other[j][i]);
            let last = if self.feature.len() == 4 { self.beside_other[3][i] } else { sides[2] };
            if has_one_sign(sides) && has_one_sign([sides[0], sides[1], last]) {
                let distance = (a - corner).dot(slope);
                out.push(FeaturePoint {
                    on_triangle: corner,
                    on_shape: corner + self.normal * distance,
                    distance,
                    features: [Feature::Vertex(i as u8), Feature::Face],
                });
            }
        }
    }

    #[inline(always)]
    fn push_corners_of_feature(&self, out: &mut FeaturePoints) {
        let Some(slope) = slope(*self.triangle, self.normal) else { return };
        for (j, &corner) in self.feature.iter().enumerate() {
            if has_one_sign([0, 1, 2].map(|i| self.beside[i][j])) {
                let distance = (corner - self.triangle[0]).dot(slope);
                out.push(FeaturePoint {
                    on_triangle: corner - self.normal * distance,
                    on_shape: corner,
                    distance,
                    features: [Feature::Face, Feature::Vertex(j as u8)],
                });
            }
        }
    }

    #[inline(always)]
    fn push_crossings(&self, out: &mut FeaturePoints) {
        let Self { triangle, feature, .. } = self;
        let count = feature.len();
        for (i, next) in NEXT.into_iter().enumerate() {
            // An edge is one, not two.
            for j in 0..if count == 2 { 1 } else { count } {
                let after = (j + 1) % count;
                let [from, to] = [self.beside_other[j][i], self.beside_other[j][next]];
                let [start, end] = [self.beside[i][j], self.beside[i][after]];
                if from * to < 0.0 && start * end < 0.0 {
                    let on_triangle = triangle[i].lerp(triangle[next], from / (from - to));
                    let on_shape = feature[j].lerp(feature[after], start / (start - end));
                    out.push(FeaturePoint {
                        on_triangle,
                        on_shape,
                        distance: (on_shape - on_triangle).dot(self.normal),
                        features: [Feature::Edge(i as u8), Feature::Edge(j as u8)],
                    });
                }
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
