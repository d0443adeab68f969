//! Meshes against convex shapes, by brute force in f64, triangle by triangle.

/// Balls: prediction distances and data.
mod balls;
/// Linear casts, against brute force.
mod casts;
/// Shapes that slide, roll and fly under continuous collision detection.
mod ccd;
/// First queries, by brute force.
mod fresh;
/// A mesh and a shape on their ways, by brute force.
mod moving;
/// Nonlinear casts, against brute force.
mod nonlinear;
/// Queries without manifolds, against brute force.
mod queries;
/// A head at rest on a floor.
mod rest;
/// Thin shapes across edges of solids.
mod rods;
/// Contacts at edges within a surface.
mod seams;
/// A shape of each kind, and where it meets a mesh.
pub mod shapes;
/// Shapes that start in solids.
mod solids;
/// Bodies at the foot of a wall.
mod walls;
