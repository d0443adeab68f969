//! Meshes that may deform. Each frame has the contacts of a rigid mesh built anew.

/// Vertices that are no numbers.
mod broken;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// Comparisons and shapes.
pub mod question;
/// Rapier's soft bodies.
mod worlds;
