//! Queries without manifolds for a pair of meshes: from Parry's question to a search over trees
//! ([`sbbk_core::query`]) and back.
//!
//! Hosts keep nothing for such a query, so each one has to find the trees of its meshes anew
//! ([`lookup`]).

mod casts;
mod lookup;
mod proximity;
mod walk;

pub(crate) use lookup::MeshQuery;
