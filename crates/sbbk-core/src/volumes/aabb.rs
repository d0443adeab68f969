use glamx::{Pose3, Vec3};

use super::Volume;
use super::rounding::gamma;

/// An axis-aligned box.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// Half of the surface area: the cost of a node in the surface area heuristic. Zero if empty.
    pub fn half_area(&self) -> f32 {
        let d = (self.max - self.min).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The box grown to contain `point`.
    #[must_use]
    pub fn with_point(&self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The middle of the box.
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The largest absolute coordinate of the box: what rounding errors are relative to.
    pub fn magnitude(&self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }
}

impl Volume for Aabb {
    const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    fn fit(points: &[Vec3]) -> Self {
        points.iter().fold(Self::EMPTY, |aabb, &p| aabb.with_point(p))
    }

    fn merge(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn overlaps(&self, other: &Self, margin: f32) -> bool {
        // One subtraction, and rounding is monotonic: an exact gap within the margin rounds to one
        // that is.
        let gap = (self.min - other.max).max(other.min - self.max);
        gap.cmple(Vec3::splat(margin)).all()
    }

    /// Rotates centre and half-lengths: `c' = R c + t`, `e' = |R| e` (Arvo, *Transforming
    /// Axis-Aligned Bounding Boxes*, 1990).
    ///
    /// Rounding: each entry of R is a sum of three products of quaternion entries of magnitude at
    /// most 1 (γ_5), the row product adds γ_3 and the translation γ_1: below γ_12 of
    /// `|R| (|c| + e) + |t|`, and all terms of |R| are at most 1. The box grows by that.
    fn transformed(&self, pose: &Pose3) -> Self {
        let rotation = glamx::Mat3::from_quat(pose.rotation);
        let centre = rotation * self.centre() + pose.translation;
        let absolute = glamx::Mat3::from_cols(
            rotation.x_axis.abs(),
            rotation.y_axis.abs(),
            rotation.z_axis.abs(),
        );
        let magnitude = 3.0 * self.magnitude() + pose.translation.abs().max_element();
        let extent = absolute * (0.5 * self.max - 0.5 * self.min) + gamma(12) * magnitude;
        Self { min: centre - extent, max: centre + extent }
    }

    fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }
}
