//! Triangle meshes and their trees: what is the same mesh, and where its tree is kept.

mod cache;
mod identity;
mod prepared;

pub(crate) use cache::{CacheCounts, PreparedRef, TreeCache};
pub(crate) use identity::MeshToken;
pub(crate) use prepared::PreparedMesh;
