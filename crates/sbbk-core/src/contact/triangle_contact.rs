use super::closest::Closest;
use super::feature::FeaturePair;
use glamx::DVec3;

/// The contact of two triangles: closest points if apart, least translation that separates them if
/// they cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleContact {
    /// Unit vector from triangle 1 to triangle 2.
    pub normal: DVec3,
    /// The distance; when the triangles cross, minus the depth, which is how far triangle 2 must
    /// move along the normal to touch triangle 1 only.
    pub distance: f64,
    /// The point on triangle 1.
    pub point1: DVec3,
    /// The point on triangle 2: `point1 + distance * normal`, up to rounding.
    pub point2: DVec3,
    /// What meets.
    pub features: FeaturePair,
}

impl TriangleContact {
    pub(super) fn new(features: FeaturePair, closest: Closest) -> Self {
        let Closest { point1, point2, normal, distance } = closest;
        Self { normal, distance, point1, point2, features }
    }
}
