//! Triangle meshes: Parry's own hierarchy of a mesh ([`hierarchy`]), what is the same mesh
//! ([`identity`], [`registry`]), and where its tree is kept ([`cache`]).

mod cache;
mod credit;
mod hierarchy;
mod identity;
mod known;
#[cfg(test)]
mod locks;
mod neighbours;
mod prepared;
mod registry;
mod soundness;

pub(crate) use cache::{CacheCounts, CachedMesh, PreparedRef, TreeCache};
pub(crate) use hierarchy::{
    BEHIND, Hierarchy, are_near, box_of, is_covered, is_near, may_be_inside, nearest,
};
pub(crate) use identity::MeshToken;
pub(crate) use known::{Change, KnownMesh, MeshSurface};
pub(crate) use prepared::PreparedMesh;
pub(crate) use registry::Registered;
pub(crate) use soundness::whole_ones;
