use std::sync::Arc;

use parry3d::shape::{CompositeShape, TriMesh};
use sbbk_core::surface::{Around, SurfaceKind};

use super::cache::{CachedMesh, PreparedRef, TreeCache};
use super::hierarchy::Hierarchy;
use super::identity::MeshToken;
use super::neighbours::{NearTwins, Neighbours};
use super::prepared::PreparedMesh;

/// A mesh as a pair of colliders knows it from query to query: how to tell whether it still is that
/// mesh, and its tree, if there is one.
#[derive(Clone, Default)]
pub(crate) enum KnownMesh {
    /// No query has needed it yet.
    #[default]
    Unknown,
    /// Valid while the token is, for the same owner. Without a tree, for so many more queries.
    Rigid {
        token: MeshToken,
        owner: u64,
        entry: Option<PreparedRef>,
        wait: u8,
        /// Whether `entry` was there at the first query, and will be at that of any pair: so that
        /// answers may depend on it.
        is_whole: bool,
        neighbours: Neighbours,
    },
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
        *self = Self::Rigid {
            token: seen,
            owner: asking,
            entry: None,
            wait: 0,
            is_whole: false,
            neighbours: Neighbours::default(),
        };
        change
    }

    /// What is known of a mesh that [`update`](Self::update) has seen: what all pairs share of it, if
    /// it is small or registered, with its tree if that is there or can be had at once.
    pub(crate) fn look_up<'a>(
        &'a mut self,
        mesh: &'a TriMesh,
        cache: &Arc<TreeCache>,
    ) -> Option<Known<'a>> {
        /// Queries from one try to the next. More: trees come later; fewer: each costs two locks.
        const PATIENCE: u8 = 7;
        let Self::Rigid { entry, wait, is_whole, neighbours, .. } = self else {
            return None;
        };
        if *wait == 0 && entry.as_ref().is_none_or(|entry| entry.tree().is_none()) {
            *wait = PATIENCE;
            if entry.is_none() {
                *entry = cache.know(mesh);
                *is_whole = entry.is_some();
            }
            *entry = entry.take().or_else(|| cache.recognise(mesh));
            if let Some(entry) = entry {
                cache.afford(mesh, entry);
            }
        }
        *wait = wait.saturating_sub(1);
        let surface = match entry.as_deref().filter(|_| *is_whole) {
            Some(entry) => MeshSurface::Whole(entry),
            None => MeshSurface::Near(NearTwins::new(mesh, neighbours)),
        };
        Some(Known { tree: entry.as_ref().and_then(|entry| entry.tree()), surface })
    }
}

/// What a query may know of a rigid mesh.
pub(crate) struct Known<'a> {
    pub(crate) tree: Option<&'a PreparedMesh>,
    pub(crate) surface: MeshSurface<'a>,
}

/// How the triangles of a mesh hang together.
pub(crate) enum MeshSurface<'a> {
    /// Of the mesh as a whole. The same for all pairs and queries.
    Whole(&'a CachedMesh),
    /// Where it is met, of a mesh that is too large to be looked at unasked. It is no solid.
    Near(NearTwins<'a>),
}

impl MeshSurface<'_> {
    /// The surface of `mesh`, which must be this one.
    #[inline]
    pub(crate) fn around<'a>(&'a self, mesh: &'a TriMesh) -> Around<'a> {
        let (vertices, triangles) = (mesh.vertices(), mesh.indices());
        match self {
            Self::Whole(entry) => {
                let (twins, kind) = entry.surface(mesh);
                Around { twins, is_solid: kind == SurfaceKind::Solid, vertices, triangles }
            }
            Self::Near(twins) => Around { twins, is_solid: false, vertices, triangles },
        }
    }
}
