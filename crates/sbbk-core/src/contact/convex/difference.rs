//! The Minkowski difference of a convex shape and a triangle: all that leads from a point of the
//! triangle to a point of the shape.

use super::support::{SupportMap, lowest};
use glamx::DVec3;

/// The points `s - t` of points `s` of the shape and `t` of the triangle. The bodies cross where it
/// holds the origin; else its point nearest to the origin leads from one to the other.
pub(super) struct Difference<'a, S> {
    pub triangle: &'a [DVec3; 3],
    pub shape: &'a S,
}

/// A point of the difference, and the corner of the triangle that it starts from.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub point: DVec3,
    pub corner: usize,
}

impl<S: SupportMap> Difference<'_, S> {
    /// The farthest point along a direction.
    #[inline(always)]
    pub fn farthest(&self, direction: DVec3) -> Vertex {
        let corner = lowest(self.triangle, direction);
        Vertex { point: self.shape.support(direction) - self.triangle[corner], corner }
    }

    /// The three vertices that end in one point of the shape.
    #[inline(always)]
    pub fn at(&self, point: DVec3) -> [Vertex; 3] {
        [0, 1, 2].map(|corner| Vertex { point: point - self.triangle[corner], corner })
    }
}
