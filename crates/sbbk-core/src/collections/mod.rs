//! What meshes and pairs of meshes are described by: short lists of numbers, and groups of things
//! that hang together.

mod groups;
mod numbers;

pub use groups::Groups;
pub use numbers::Numbers;
