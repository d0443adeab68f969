//! Triangle meshes: Parry's own hierarchy of them, what is the same mesh, and where its tree is
//! kept.

mod cache;
mod credit;
mod hierarchy;
mod identity;
mod known;
mod prepared;
mod registry;
mod soundness;

pub(crate) use cache::{CacheCounts, CachedMesh, PreparedRef, TreeCache};
pub(crate) use hierarchy::{Hierarchy, Ranks, are_near, is_near};
pub(crate) use identity::MeshToken;
pub(crate) use known::{Change, KnownMesh};
pub(crate) use prepared::PreparedMesh;
pub(crate) use registry::Registered;
