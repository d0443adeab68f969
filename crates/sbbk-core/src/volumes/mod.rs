//! Bounding volumes: [`Sphere`], [`Aabb`] and [`Kdop`].
//!
//! A volume contains its points in *exact* arithmetic, as it grows by a bound on the [`rounding`]
//! of f32. A NaN coordinate makes a volume useless but never panics. A [`Tree`](crate::tree::Tree)
//! rejects such input. [`traverse`](crate::traverse) compares volumes.

mod aabb;
pub mod directions;
mod kdop;
pub mod rounding;
mod sphere;

pub use aabb::Aabb;
pub use directions::SLABS;
pub use kdop::Kdop;
pub use sphere::Sphere;
