//! Meshes that move their vertices, against height fields and compounds, and broken ones against
//! all kinds: at every frame the contacts are those of a mesh built anew of the same vertices.

/// Vertices that are no numbers.
mod broken;
/// Frame by frame, with counters and brute force.
mod frames;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// What is asked and compared, and the shapes.
mod question;
/// Rapier's soft bodies.
mod worlds;
