//! The trees of two meshes, for queries that come without a workspace.
//!
//! Nothing tells such a query that a mesh was edited, or dropped and another one built in its
//! place, and the [`MeshToken`] of the contact queries misses single vertices that moved (Parry
//! refits its boxes then, but a vertex may move within the boxes of all its triangles) and single
//! triangles that are others. So all of both are compared with a copy each time, 24 bytes a vertex
//! and a triangle of sequential memory.
//!
//! Two triangles that meet need no such comparison: if both are where they were, they meet in the
//! meshes of now, whatever else has changed. So a query that such a pair answers asks the trees
//! first ([`Trees::remembered`]).
//!
//! Each thread remembers the last few meshes it asked about, without keeping their trees: the cache
//! does that, and goes with its dispatcher. Only a mesh that is not among them costs a hash of all
//! content and the lock of the cache, or its tree.

use std::cell::RefCell;
use std::sync::{Arc, Weak};

use parry3d::shape::TriMesh;
use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;

use crate::mesh::{CachedMesh, MeshToken, TreeCache};

/// Meshes that a thread remembers. More: scenes with many meshes look up faster.
const REMEMBERED: usize = 8;

/// Memory of a thread.
#[derive(Default)]
struct Memory {
    /// The last one asked about comes first.
    recent: Vec<Remembered>,
    scratch: SearchScratch,
}

struct Remembered {
    token: MeshToken,
    cache: Weak<TreeCache>,
    mesh: Weak<CachedMesh>,
}

impl Remembered {
    /// The mesh, if it has this token, is of this cache and still there.
    fn get(&self, cache: &Arc<TreeCache>, token: MeshToken) -> Option<Arc<CachedMesh>> {
        let is_it = self.token == token && std::ptr::eq(self.cache.as_ptr(), &**cache);
        is_it.then(|| self.mesh.upgrade())?
    }
}

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

impl Memory {
    /// A prepared mesh with this token that fits, then at the front of the memory.
    fn recall(
        &mut self,
        cache: &Arc<TreeCache>,
        token: MeshToken,
        fits: impl Fn(&CachedMesh) -> bool,
    ) -> Option<Arc<CachedMesh>> {
        let fitting = |known: &Remembered| known.get(cache, token).filter(|mesh| fits(mesh));
        let (place, mesh) = self
            .recent
            .iter()
            .enumerate()
            .find_map(|(place, known)| Some((place, fitting(known)?)))?;
        self.recent[..=place].rotate_right(1);
        Some(mesh)
    }

    /// The prepared mesh; `None` if it cannot have a tree.
    fn prepare(&mut self, cache: &Arc<TreeCache>, mesh: &TriMesh) -> Option<Arc<CachedMesh>> {
        let token = MeshToken::of(mesh);
        self.recall(cache, token, |known| known.is_of(mesh)).or_else(|| {
            let prepared = cache.noting(mesh, cache.prepare_for_queries(mesh))?;
            self.recent.retain(|known| known.mesh.strong_count() > 0);
            self.recent.truncate(REMEMBERED - 1);
            let (cache, mesh) = (Arc::downgrade(cache), Arc::downgrade(&prepared));
            self.recent.insert(0, Remembered { token, cache, mesh });
            Some(prepared)
        })
    }
}

/// The trees of two meshes.
pub(crate) struct Trees([Arc<CachedMesh>; 2]);

impl Trees {
    /// Finds or builds the trees; `None` if a mesh cannot have one, so that Parry must answer.
    pub(crate) fn of(cache: &Arc<TreeCache>, meshes: [&TriMesh; 2]) -> Option<Self> {
        if cache.is_unsupported(&meshes) {
            return None;
        }
        Self::each(meshes, |memory, mesh| memory.prepare(cache, mesh))
    }

    /// The trees that the meshes had of late. They may be of other vertices and triangles than the
    /// meshes have now.
    pub(super) fn remembered(cache: &Arc<TreeCache>, meshes: [&TriMesh; 2]) -> Option<Self> {
        Self::each(meshes, |memory, mesh| memory.recall(cache, MeshToken::of(mesh), |_| true))
    }

    fn each(
        [mesh1, mesh2]: [&TriMesh; 2],
        tree_of: impl Fn(&mut Memory, &TriMesh) -> Option<Arc<CachedMesh>>,
    ) -> Option<Self> {
        MEMORY.with_borrow_mut(|memory| {
            let tree1 = tree_of(memory, mesh1)?;
            let is_same = std::ptr::eq(mesh1, mesh2);
            let tree2 = if is_same { tree1.clone() } else { tree_of(memory, mesh2)? };
            Some(Self([tree1, tree2]))
        })
    }

    /// Whether the trees are of the vertices and triangles that the meshes have now.
    pub(super) fn are_of(&self, [mesh1, mesh2]: [&TriMesh; 2]) -> bool {
        let [tree1, tree2] = &self.0;
        let is_same = std::ptr::eq(mesh1, mesh2);
        tree1.is_of(mesh1) && (is_same || tree2.is_of(mesh2))
    }

    /// Whether these triangles of the meshes are where they are in the trees.
    pub(super) fn have(&self, meshes: [&TriMesh; 2], triangles: [u32; 2]) -> bool {
        (0..2).all(|i| self.0[i].has_triangle_of(meshes[i], triangles[i]))
    }

    /// Both trees.
    pub(super) fn both(&self) -> (&Tree, &Tree) {
        let [one, two] = &self.0;
        (&one.prepared().tree, &two.prepared().tree)
    }

    /// Searches with the memory of this thread.
    pub(super) fn search<T>(&self, search: impl FnOnce(&mut SearchScratch) -> T) -> T {
        MEMORY.with_borrow_mut(|memory| search(&mut memory.scratch))
    }
}
