//! Triangle meshes and their trees: what is the same mesh, and where its tree is kept.

mod broken;
mod cache;
mod deformable;
mod identity;
mod known;
mod prepared;
mod unsupported;

pub(crate) use broken::{placed_root_box, root_box};
pub(crate) use cache::{CacheCounts, CachedMesh, PreparedRef, TreeCache};
pub(crate) use identity::MeshToken;
pub(crate) use known::{Change, Held, KnownMesh};
pub(crate) use prepared::PreparedMesh;
