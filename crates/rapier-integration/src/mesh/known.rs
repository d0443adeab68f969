use std::sync::Arc;

use parry3d::shape::{CompositeShape, TriMesh};

use super::cache::{PreparedRef, TreeCache};
use super::hierarchy::Hierarchy;
use super::identity::MeshToken;
use super::prepared::PreparedMesh;

/// A mesh as a pair of colliders knows it from query to query: how to tell whether it still is that
/// mesh, and its tree, if there is one.
#[derive(Clone, Default)]
pub(crate) enum KnownMesh {
    /// No query has needed it yet.
    #[default]
    Unknown,
    /// Valid while the token is, for the same owner. Without a tree, for so many more queries.
    Rigid { token: MeshToken, owner: u64, tree: Option<PreparedRef>, wait: u8 },
    /// May be another one at any time: has no tree.
    Deformable,
}

/// What became of a mesh since the last query of the pair.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    /// Nothing.
    Unchanged,
    /// It was not known, or another dispatcher knew it: nothing is known, but it need not be another
    /// mesh.
    Unknown,
    /// Its vertices may have moved.
    Deformed,
    /// It is another mesh: its triangles are not those of old manifolds.
    Replaced,
}

impl KnownMesh {
    pub(crate) fn is_unknown(&self) -> bool {
        matches!(self, Self::Unknown)
    }

    /// Takes note of the mesh as it is now.
    pub(crate) fn update(&mut self, seen: &Hierarchy<'_>) -> Change {
        if seen.mesh.is_deformable() {
            let is_other = matches!(self, Self::Rigid { .. });
            *self = Self::Deformable;
            return if is_other { Change::Replaced } else { Change::Deformed };
        }
        let Hierarchy { token: seen, owner: asking, .. } = *seen;
        let change = match self {
            Self::Rigid { token, owner, .. } if *token == seen && *owner == asking => {
                return Change::Unchanged;
            }
            Self::Rigid { token, .. } if *token == seen => Change::Unknown,
            Self::Unknown => Change::Unknown,
            Self::Rigid { .. } | Self::Deformable => Change::Replaced,
        };
        *self = Self::Rigid { token: seen, owner: asking, tree: None, wait: 0 };
        change
    }

    /// The tree of a mesh that [`update`](Self::update) has seen, if it is there or can be had at
    /// once.
    pub(crate) fn tree(&mut self, mesh: &TriMesh, cache: &Arc<TreeCache>) -> Option<&PreparedMesh> {
        /// Queries from one try to the next. More: trees come later; fewer: each costs two locks.
        const PATIENCE: u8 = 7;
        let Self::Rigid { tree, wait, .. } = self else {
            return None;
        };
        if tree.is_none() && *wait == 0 {
            (*tree, *wait) = (cache.afford(mesh), PATIENCE);
        }
        *wait = wait.saturating_sub(1);
        tree.as_ref().map(|tree| tree.prepared())
    }
}
