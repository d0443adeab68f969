//! Meshes against height fields, by brute force and by the same terrain as a mesh.

/// Fields and manifolds that change between queries.
mod change;
/// Contact normals constrained at internal edges of the field.
mod edges;
/// Heads at rest, and worlds that are saved.
mod rest;
/// Fields as meshes, and places on them.
pub mod terrain;
/// Brute force over all triangles.
mod truth;
