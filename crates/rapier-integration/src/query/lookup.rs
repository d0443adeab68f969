//! The trees of two meshes, for queries that come without a workspace.
//!
//! A registered mesh is known by its address. Of the others nothing tells that they were edited, or
//! dropped and another one built in their place, and the [`MeshToken`] of the contact queries misses
//! single vertices that moved (Parry refits its boxes then, but a vertex may move within the boxes of
//! all its triangles) and single triangles that are others. So all of a mesh is compared with a copy
//! each time, 24 bytes a vertex and a triangle of sequential memory: less than the search takes, as
//! this is done for small meshes only. Large ones are searched by Parry's own hierarchy, which needs
//! no proof ([`walk`](super::walk)).
//!
//! Two triangles that meet need no such comparison: if both are where they were, they meet in the
//! meshes of now, whatever else has changed. So a query that such a pair answers asks the trees
//! first ([`MeshQuery::remembered`]).
//!
//! Each thread remembers the last few meshes it asked about, without keeping their trees: the cache
//! does that, and goes with its dispatcher. Only a mesh that is not among them costs a hash of all
//! content and the lock of the cache, or its tree.

use std::cell::RefCell;
use std::sync::{Arc, Weak};

use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;

use super::walk::Walk;
use crate::mesh::{CachedMesh, Hierarchy, MeshToken, TreeCache};

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
    /// The mesh, if it has this token, is of this cache and still there. Another cache's tree would give
    /// the same answers, by layers that were not asked for.
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

    /// The prepared mesh, with a tree that is built now if need be.
    fn prepare(&mut self, cache: &Arc<TreeCache>, seen: &Hierarchy<'_>) -> Option<Arc<CachedMesh>> {
        let (mesh, token) = (seen.mesh, seen.token());
        self.recall(cache, token, |known| known.is_of(mesh)).or_else(|| {
            let prepared = cache.prepare_for_queries(mesh).ok()?;
            self.recent.retain(|known| known.mesh.strong_count() > 0);
            self.recent.truncate(REMEMBERED - 1);
            let (cache, mesh) = (Arc::downgrade(cache), Arc::downgrade(&prepared));
            self.recent.insert(0, Remembered { token, cache, mesh });
            Some(prepared)
        })
    }
}

/// Two rigid meshes of which something is asked.
pub(crate) struct MeshQuery<'a> {
    pub(crate) cache: &'a Arc<TreeCache>,
    pub(crate) meshes: [Hierarchy<'a>; 2],
}

impl MeshQuery<'_> {
    /// The trees of both meshes, if they are registered or so small that theirs are built at once.
    pub(super) fn trees(&self) -> Option<Trees> {
        let mut registered = self.meshes.each_ref().map(|seen| self.cache.registered(seen.mesh));
        let can_have_one =
            |i: usize| registered[i].is_some() || self.cache.is_small(self.meshes[i].mesh);
        if !(0..2).all(can_have_one) {
            return None;
        }
        self.each(|memory, i| {
            registered[i].take().or_else(|| memory.prepare(self.cache, &self.meshes[i]))
        })
    }

    /// The trees that the meshes had of late. They may be of other vertices and triangles than the
    /// meshes have now.
    pub(super) fn remembered(&self) -> Option<Trees> {
        self.each(|memory, i| memory.recall(self.cache, self.meshes[i].token(), |_| true))
    }

    pub(super) fn walk(&self) -> Walk<'_> {
        Walk(self.meshes.each_ref())
    }

    fn each(
        &self,
        mut tree_of: impl FnMut(&mut Memory, usize) -> Option<Arc<CachedMesh>>,
    ) -> Option<Trees> {
        let [mesh1, mesh2] = &self.meshes;
        MEMORY.with_borrow_mut(|memory| {
            let tree1 = tree_of(memory, 0)?;
            let is_same = std::ptr::eq(mesh1.mesh, mesh2.mesh);
            let tree2 = if is_same { tree1.clone() } else { tree_of(memory, 1)? };
            Some(Trees([tree1, tree2]))
        })
    }
}

/// The trees of two meshes.
pub(crate) struct Trees([Arc<CachedMesh>; 2]);

impl Trees {
    /// Whether the trees are of the vertices and triangles that the meshes have now.
    pub(super) fn are_of(&self, [mesh1, mesh2]: [Hierarchy<'_>; 2]) -> bool {
        let [tree1, tree2] = &self.0;
        let is_same = std::ptr::eq(mesh1.mesh, mesh2.mesh);
        tree1.is_of(mesh1.mesh) && (is_same || tree2.is_of(mesh2.mesh))
    }

    /// Whether these triangles of the meshes are where they are in the trees.
    pub(super) fn have(&self, meshes: [Hierarchy<'_>; 2], triangles: [u32; 2]) -> bool {
        (0..2).all(|i| self.0[i].has_triangle_of(meshes[i].mesh, triangles[i]))
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
