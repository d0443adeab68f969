//! The f64 reference that everything else is judged by: slow, short, and written with other
//! formulas than the code under test.
//!
//! [`contact`](fn@contact) answers for two triangles, [`pairs_within`] for two meshes. Both take
//! plain data; nalgebra does the linear algebra inside.

mod mesh;
mod triangle;

pub use mesh::{TruthPair, pairs_within};
pub use triangle::{TruthContact, contact, separation};
