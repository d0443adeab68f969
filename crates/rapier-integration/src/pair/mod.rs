//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`answer`](mod@answer) is the way of a query, the same for every kind of pair: the state of the pair
//! ([`state`], [`memory`]), the candidates in stock order ([`order`]), and one manifold for each
//! that touches, those of the query before among them ([`merge`], [`pool`]), or a few for all
//! ([`outline`] chooses them, [`patches`] makes them). A kind says what is its own, by the traits of
//! [`driver`]: [`triangles`] for two meshes, or a mesh and a height field; [`convex`] for a mesh and
//! convex shapes, one or the parts of a compound or polyline.

mod answer;
mod convex;
mod driver;
mod few;
mod memory;
mod merge;
mod order;
mod outline;
mod patches;
mod pool;
mod pose;
mod seams;
mod state;
mod triangles;

pub(crate) use answer::answer;
pub(crate) use convex::{ConvexPair, ConvexSearch, FoundCast, FoundTriangle, Parts, PlacedPart};
pub(crate) use driver::{Answer, Pair};
pub(crate) use few::{FewPair, is_few};
pub(crate) use pose::{MeshPlace, PairPose};
pub use triangles::TriangleContacts;
pub(crate) use triangles::{FieldPair, MeshPair, walk};
