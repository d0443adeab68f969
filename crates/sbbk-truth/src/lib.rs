//! The f64 reference for tests: slow, short, and with other formulas than the code under test,
//! which this crate does not know.
//!
//! [`contact`](fn@contact) serves two triangles, [`pairs_within`] two meshes, [`ConvexBody`] a
//! triangle and a convex body. All take plain data.

mod convex;
mod curved;
mod mesh;
mod polytope;
mod triangle;

pub use convex::ConvexBody;
pub use mesh::{TruthPair, pairs_within};
pub use polytope::ConvexTruth;
pub use triangle::{TruthContact, contact, separation};
