//! Queries without manifolds for a pair of meshes, or a mesh and a convex shape: from Parry's question to a search and back.
//!
//! Hosts keep nothing for such a query, so each one has to find the trees of its meshes anew
//! ([`lookup`]). With trees the search is that of [`sbbk_core::query`]. Where a mesh is large and
//! not registered it goes down Parry's hierarchies and decides by the same exact contacts
//! ([`walk`]); casts are Parry's then. A mesh and a convex shape ([`convex`]) have no trees.
//! Casts along curves are one search for both ([`nonlinear`]).

mod casts;
mod convex;
mod moving;
mod nonlinear;
mod pairs;
mod proximity;
mod touch;
mod trees;
mod walk;

pub(crate) use convex::ConvexQuery;
pub(crate) use nonlinear::NonlinearCast;
pub(crate) use walk::MeshQuery;
