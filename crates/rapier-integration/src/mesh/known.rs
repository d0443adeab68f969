use std::ops::Deref;
use std::sync::Arc;

use parry3d::shape::{CompositeShape, TriMesh};
use sbbk_core::tree::BuildError;

use super::cache::{PreparedRef, TreeCache};
use super::deformable::DeformableTree;
use super::identity::{DeformedContent, MeshToken};
use super::prepared::PreparedMesh;

/// A mesh as a pair of colliders knows it from query to query: its tree, and how to tell whether it
/// still is that mesh.
#[derive(Clone, Default)]
pub(crate) enum KnownMesh {
    /// No query has needed it yet.
    #[default]
    Unknown,
    /// Valid while the token is.
    Rigid(MeshToken, PreparedRef),
    /// The tree has been used for this content.
    Deformable(Arc<DeformableTree>, DeformedContent),
}

/// What became of a mesh since the last query of the pair.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    /// Nothing.
    Unchanged,
    /// It was not known, or another dispatcher knew it: nothing is known, but it need not be
    /// another mesh.
    Unknown,
    /// Its vertices have moved, or may have.
    Deformed,
    /// It is another mesh: its triangles are not those of old manifolds.
    Replaced,
}

/// A prepared mesh during one query.
pub(crate) enum Held<'a> {
    Rigid(&'a PreparedMesh),
    Deformable(Arc<PreparedMesh>),
}

impl Deref for Held<'_> {
    type Target = PreparedMesh;

    #[inline]
    fn deref(&self) -> &PreparedMesh {
        match self {
            Self::Rigid(prepared) => prepared,
            Self::Deformable(prepared) => prepared,
        }
    }
}

impl KnownMesh {
    pub(crate) fn is_unknown(&self) -> bool {
        matches!(self, Self::Unknown)
    }

    /// The tree of the mesh as it is now, and what has changed.
    ///
    /// # Errors
    /// Why the mesh cannot have a tree. It is unknown then.
    pub(crate) fn update(
        &mut self,
        mesh: &TriMesh,
        cache: &Arc<TreeCache>,
    ) -> Result<(Change, Held<'_>), BuildError> {
        if mesh.is_deformable() {
            return self.update_deformable(mesh, cache);
        }
        let token = MeshToken::of(mesh);
        let change = match self {
            Self::Rigid(known, tree) if *known == token && tree.is_from(cache) => Change::Unchanged,
            Self::Rigid(known, _) if *known == token => Change::Unknown,
            Self::Unknown => Change::Unknown,
            Self::Rigid(..) | Self::Deformable(..) => Change::Replaced,
        };
        if change != Change::Unchanged {
            *self = Self::Unknown;
            *self = Self::Rigid(token, cache.prepare(mesh)?);
        }
        match self {
            Self::Rigid(_, tree) => Ok((change, Held::Rigid(tree.prepared()))),
            _ => unreachable!("known just now"),
        }
    }

    /// Where the mesh is matters for its tree only: a host that copies a mesh to edit it, as a
    /// shared one must be, still has the same mesh.
    fn update_deformable(
        &mut self,
        mesh: &TriMesh,
        cache: &TreeCache,
    ) -> Result<(Change, Held<'_>), BuildError> {
        let content = DeformedContent::of(mesh);
        let (change, known) = match std::mem::take(self) {
            Self::Deformable(tree, old) => {
                let change = match old {
                    _ if old == content => Change::Unchanged,
                    _ if old.topology == content.topology => Change::Deformed,
                    _ => Change::Replaced,
                };
                (change, Some(tree))
            }
            Self::Unknown => (Change::Deformed, None),
            Self::Rigid(..) => (Change::Replaced, None),
        };
        let tree = known.filter(|tree| cache.is_place_of(tree, mesh));
        let tree = tree.unwrap_or_else(|| cache.deformable(mesh));
        let prepared = cache.refitted(&tree, mesh, content)?;
        *self = Self::Deformable(tree, content);
        Ok((change, Held::Deformable(prepared)))
    }
}
