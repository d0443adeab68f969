//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`driver`] is the way of a query, the same for every kind of pair: the state of the pair
//! ([`state`], [`memory`]), the candidates in stock order ([`order`]), and one manifold for each
//! that touches, those of the query before among them ([`merge`], [`pool`]), or a few for all
//! ([`patches`]). A kind says what is
//! its own: [`triangles`] for two meshes, or a mesh and a height field; [`convex`] for a mesh and
//! convex shapes, one or the parts of a compound or polyline.

mod convex;
mod driver;
mod few;
mod memory;
mod merge;
mod order;
mod patches;
mod pool;
mod pose;
mod state;
mod triangles;

pub(crate) use convex::{ConvexPair, ConvexSearch, FoundTriangle, Parts};
pub(crate) use driver::{Answer, Pair, answer};
pub(crate) use few::{FewPair, is_few};
pub(crate) use pose::{MeshPlace, PairPose};
pub use triangles::TriangleContacts;
pub(crate) use triangles::{FieldPair, MeshPair, walk};
