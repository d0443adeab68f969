//! The same terrain is always at hand as a mesh: what brute force and the pair of meshes say of it
//! is expected of the field.

/// Fields and manifolds that change between queries.
mod change;
/// Cells visited and memory allocated.
mod cost;
/// Contact normals constrained at internal edges of the field.
mod edges;
/// Heads at rest, and worlds that are saved.
mod rest;
/// Fields as meshes, and places on them.
pub mod terrain;
/// Brute force over all triangles.
mod truth;
