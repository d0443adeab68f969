//! Meshes that may deform. At every frame the contacts are those of a mesh built anew.

/// Vertices that are no numbers.
mod broken;
/// Frame by frame, with counters and brute force.
mod frames;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// Comparisons and shapes.
mod question;
/// Rapier's soft bodies.
mod worlds;
