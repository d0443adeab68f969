//! A mesh against a height field, by brute force over the triangles of all cells: never a pair
//! lost, and no cell looked at that is not under the mesh.

/// What is visited.
mod cost;
/// A field that knows what was asked of it.
mod grid;
/// Poses, heights, scales and margins that are none, or nothing.
mod numbers;
/// Brute force.
mod oracle;
/// Random and lattice fields.
mod pairs;
