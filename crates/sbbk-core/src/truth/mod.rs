//! The f64 reference that everything else is judged by: slow, short, and written with other
//! formulas than the code under test.
//!
//! [`contact`](fn@contact) answers for two triangles, [`pairs_within`] for two meshes,
//! [`ConvexBody`] for a triangle and a convex body. All take plain data; nalgebra does the linear
//! algebra inside.

mod convex;
mod convex_truth;
mod curved;
mod mesh;
mod polytope;
mod triangle;

pub use convex::ConvexBody;
pub use convex_truth::ConvexTruth;
pub use mesh::{TruthPair, pairs_within};
pub use triangle::{TruthContact, contact, separation};
