//! Bounding volumes: [`Sphere`], [`Aabb`] and [`Kdop`].
//!
//! A volume contains what it was fitted to in *exact* arithmetic: where f32 rounds, it grows by a
//! bound, see [`rounding`]. A NaN coordinate makes a volume useless but never panics: such input is
//! rejected where a [`Tree`](crate::tree::Tree) is built. Volumes are compared by the kernels of
//! [`traverse`](crate::traverse), which see them over lanes.

mod aabb;
mod directions;
mod kdop;
pub mod rounding;
mod sphere;

pub use aabb::Aabb;
pub use directions::{DirectionSet, Directions, Slabs};
pub use kdop::{Kdop, Kdop14, Kdop18, Kdop26};
pub use sphere::Sphere;
