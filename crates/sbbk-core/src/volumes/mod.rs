//! Bounding volumes: [`Sphere`], [`Aabb`] and [`Kdop`], and the tests between them.
//!
//! All have the same four abilities, the [`Volume`] trait: fit points, merge, overlap with a margin,
//! and a conservative transform. A volume always contains what it was fitted to in *exact*
//! arithmetic; where f32 rounds, the volume grows by a bound derived at that place.

mod aabb;
mod directions;
mod kdop;
pub mod rounding;
mod sphere;

pub use aabb::Aabb;
pub use directions::{DirectionSet, Directions, Slabs};
pub use kdop::{Kdop, Kdop14, Kdop18, Kdop26};
pub use sphere::Sphere;

use glamx::{Pose3, Vec3};

/// A convex volume that bounds points, in the frame of these points.
pub trait Volume: Copy {
    /// The volume of no point at all: merging with it changes nothing, nothing overlaps it.
    const EMPTY: Self;

    /// The volume around `points`. A NaN coordinate makes the volume useless but never panics:
    /// such input is rejected where a [`Tree`](crate::tree::Tree) is built.
    fn fit(points: &[Vec3]) -> Self;

    /// The volume around two volumes.
    #[must_use]
    fn merge(&self, other: &Self) -> Self;

    /// Whether the volumes come within `margin` of each other, along each of the directions that
    /// this kind of volume tests. Inclusive. `false` if anything is NaN.
    fn overlaps(&self, other: &Self, margin: f32) -> bool;

    /// A volume of the same kind, in another frame, that contains this one moved by `pose`.
    #[must_use]
    fn transformed(&self, pose: &Pose3) -> Self;

    /// Whether `point` is in the volume.
    fn contains(&self, point: Vec3) -> bool;
}
