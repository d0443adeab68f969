//! Triangle meshes during a query ([`view`]), from query to query of a pair ([`known_mesh`]), and
//! what all colliders of one mesh share ([`store`]).

mod budget;
mod data;
mod facets;
mod flags;
mod identity;
mod known_mesh;
mod neighbours;
mod rays;
mod store;
mod view;

pub(crate) use data::MeshData;
pub(crate) use facets::{MeshFacets, box_between, is_minimum};
pub(crate) use known_mesh::{Change, KnownMesh, LazySurface};
pub(crate) use store::{MeshStore, Registered, use_trees};
pub(crate) use view::{
    BEHIND, MeshView, TwoMeshes, box_of, first_hit, is_covered, is_near, leaves,
};
