//! What Parry's routine, or brute force in f64, says of each triangle alone is expected of the whole
//! mesh.

/// Balls: flags, prediction distances, data.
mod balls;
/// Linear casts, against brute force.
mod casts;
/// Shapes that slide, roll and fly under continuous collision detection.
mod ccd;
/// Shapes that change between queries, and pairs taken over from stock.
mod change;
/// First queries: those of Parry's routine bit for bit, SBBK's own against brute force.
mod fresh;
/// Nonlinear casts, against brute force.
mod nonlinear;
/// Queries without manifolds, against brute force.
mod queries;
/// What is asked, and Parry's answer triangle by triangle.
mod question;
/// A head at rest on a floor.
mod rest;
/// Contacts at edges within a surface.
mod seams;
/// A shape of each kind, and where it meets a mesh.
pub mod shapes;
/// Shapes that start in solids.
mod solids;
