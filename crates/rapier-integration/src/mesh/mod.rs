//! Triangle meshes during a query ([`view`]), from query to query of a pair ([`pair_mesh`]), and
//! what all colliders of one mesh share ([`store`]).

mod budget;
mod data;
mod facets;
mod flags;
mod identity;
mod neighbours;
mod pair_mesh;
mod rays;
mod store;
mod view;

pub(crate) use data::MeshData;
pub(crate) use facets::{MeshFacets, box_between, is_minimum};
pub(crate) use pair_mesh::{Change, LazySurface, PairMesh};
pub(crate) use store::{MeshStore, Registered, use_trees};
pub(crate) use view::{
    BEHIND, MeshView, TwoMeshes, box_of, first_hit, is_covered, is_near, leaves,
};
