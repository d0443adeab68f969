//! Meshes that may deform. At every frame the contacts are those of a rigid mesh built anew.

/// Vertices that are no numbers.
mod broken;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// Comparisons and shapes.
pub mod question;
/// Rapier's soft bodies.
mod worlds;
