//! The trees of two meshes, for queries that come without a workspace.
//!
//! Nothing tells such a query that a mesh was edited, and the [`MeshToken`] of the contact queries misses an edit of
//! single vertices in place (`TriMesh::update_vertices`, `set_vertices`); Parry refits its boxes then, but a vertex may move within the
//! boxes of all its triangles, so they need not change. So all vertices are compared with a copy each time. Parry has no way to
//! edit single *indices*: what changes them (`reverse`, `append`, `set_flags`) changes all of them, the number of vertices, or
//! the flags, which are in the token.
//!
//! Comparing 10,000 vertices takes 2.7 µs, 24 bytes a vertex of sequential memory. A hash (xxh3, built for SSE2) reads half of that and took
//! 7 µs; the boolean query of two heads of 20,000 triangles that are near takes 2.4.
//!
//! Each thread remembers the last few meshes it asked about. Only a mesh that is not among
//! them costs a hash of all content and the lock of the cache, or its tree.

use std::cell::RefCell;
use std::sync::Arc;

use parry3d::shape::TriMesh;
use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;

use crate::mesh::{MeshToken, PreparedRef, TreeCache};

/// Meshes that a thread remembers; it keeps their trees until others take their places. More: scenes with many meshes
/// look up faster, trees live longer.
const REMEMBERED: usize = 8;

/// Memory of a thread.
#[derive(Default)]
struct Memory {
    /// The last one asked about comes first.
    recent: Vec<(MeshToken, PreparedRef)>,
    scratch: SearchScratch,
}

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

impl Memory {
    /// The prepared mesh, at the front of the memory; `None` if it cannot have a tree.
    fn recall(&mut self, cache: &Arc<TreeCache>, mesh: &TriMesh) -> Option<PreparedRef> {
        let token = MeshToken::of(mesh);
        let is_it = |(known, prepared): &(MeshToken, PreparedRef)| {
            *known == token && prepared.is_from(cache) && prepared.has_vertices_of(mesh)
        };
        match self.recent.iter().position(is_it) {
            Some(0) => {}
            Some(place) => self.recent[..=place].rotate_right(1),
            None => {
                let prepared = cache.noting(mesh, cache.prepare(mesh))?;
                self.recent.truncate(REMEMBERED - 1);
                prepared.keep_vertices(mesh);
                self.recent.insert(0, (token, prepared));
            }
        }
        Some(self.recent[0].1.clone())
    }
}

/// The trees of two meshes.
pub(crate) struct Trees([PreparedRef; 2]);

impl Trees {
    /// Finds or builds the trees; `None` if a mesh cannot have one, so that Parry must answer.
    pub(crate) fn of(cache: &Arc<TreeCache>, meshes: [&TriMesh; 2]) -> Option<Self> {
        if cache.is_unsupported(&meshes) {
            return None;
        }
        MEMORY.with_borrow_mut(|memory| {
            let tree1 = memory.recall(cache, meshes[0])?;
            let tree2 = if std::ptr::eq(meshes[0], meshes[1]) {
                tree1.clone()
            } else {
                memory.recall(cache, meshes[1])?
            };
            Some(Self([tree1, tree2]))
        })
    }

    /// Both trees.
    pub(super) fn both(&self) -> (&Tree, &Tree) {
        let [one, two] = &self.0;
        (&one.get().tree, &two.get().tree)
    }

    /// Searches with the memory of this thread.
    pub(super) fn search<T>(&self, search: impl FnOnce(&mut SearchScratch) -> T) -> T {
        MEMORY.with_borrow_mut(|memory| search(&mut memory.scratch))
    }
}
