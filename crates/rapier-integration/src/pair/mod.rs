//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`query`] is the way of the data for two meshes: the state of the pair ([`state`]), the descent that collects the pairs of
//! triangles that may touch ([`candidates`]), and one manifold for each pair that does ([`exact`], [`manifolds`]).
//! [`convex`] is the same way for a mesh and a convex shape, [`heightfield`] for a mesh and a height field,
//! [`compound`] for a mesh and convex shapes put together.

mod candidates;
mod coherence;
mod compound;
mod convex;
mod exact;
mod heightfield;
mod manifolds;
mod previous;
mod query;
mod question;
mod state;

pub(crate) use compound::CompoundPair;
pub(crate) use convex::{ConvexPair, ConvexShape};
pub use exact::TriangleContacts;
pub(crate) use heightfield::FieldPair;
pub(crate) use query::MeshPair;
pub(crate) use question::{Answer, Question};
