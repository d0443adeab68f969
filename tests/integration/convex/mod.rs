//! Meshes against convex shapes, by brute force in f64 or by Parry, triangle by triangle.

/// Balls: flags, prediction distances, data.
mod balls;
/// Linear casts, against brute force.
mod casts;
/// Shapes that slide, roll and fly under continuous collision detection.
mod ccd;
/// Shapes that change between queries, and pairs taken over from stock.
mod change;
/// First queries, by brute force and by Parry's distances.
mod fresh;
/// Nonlinear casts, against brute force.
mod nonlinear;
/// Queries without manifolds, against brute force.
mod queries;
/// Parry's distance of each triangle, and checks against brute force.
mod question;
/// A head at rest on a floor.
mod rest;
/// Contacts at edges within a surface.
mod seams;
/// A shape of each kind, and where it meets a mesh.
pub mod shapes;
/// Shapes that start in solids.
mod solids;
