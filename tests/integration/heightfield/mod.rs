//! Meshes against height fields, by brute force and by the same terrain as a mesh.

/// Fields and manifolds that change between queries.
mod change;
/// Heads at rest, and worlds that are saved.
mod rest;
/// Fields as meshes, and places on them.
pub mod terrain;
/// Brute force over all triangles, and normals at internal edges.
mod truth;
