//! Hybrid sphere / AABB / k-DOP bounding volume hierarchies for triangle meshes.

pub mod broad_phase;
pub mod contact;
pub mod leaf;
pub mod traverse;
pub mod tree;
#[cfg(feature = "truth")]
pub mod truth;
pub mod volumes;
