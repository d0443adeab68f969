//! Meshes that move their vertices, against height fields and compounds: at every frame the contacts are those of a mesh built
//! anew of the same vertices.

/// Frame by frame, with counters and brute force.
mod frames;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// What is asked and compared, and the shapes.
mod question;
/// Rapier's soft bodies.
mod worlds;
