//! A pair of meshes: from a pose to contact manifolds.
//!
//! [`query`] is the way of the data: the state of the pair ([`state`]), the descent that collects the pairs of
//! triangles that may touch ([`candidates`]), and one manifold for each pair that does ([`exact`], [`manifolds`]).

mod candidates;
mod coherence;
mod exact;
mod manifolds;
mod query;
mod state;

pub use exact::TriangleContacts;
pub(crate) use query::{Answer, MeshPair, contact_manifolds};
