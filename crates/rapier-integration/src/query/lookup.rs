//! The trees of two meshes, for queries that come without a workspace.
//!
//! Nothing tells such a query that a mesh was edited, and the [`MeshToken`] of the contact queries misses an edit of
//! single vertices in place. So all vertices are hashed each time: 12 bytes a vertex of sequential memory. Parry has no way to edit single *indices*: what changes
//! them (`reverse`, `append`, `set_flags`) changes all of them, the number of vertices, or the flags, which are in the
//! token.
//!
//! Each thread remembers the last few meshes it asked about by token and vertices. Only a mesh that is not among
//! them costs a hash of all content and the lock of the cache, or its tree.

use std::cell::RefCell;
use std::sync::Arc;

use parry3d::shape::TriMesh;
use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;
use xxhash_rust::xxh3::xxh3_64;

use crate::mesh::{MeshToken, PreparedRef, TreeCache};

/// Meshes that a thread remembers; it keeps their trees until others take their places. More: scenes with many meshes
/// look up faster, trees live longer.
const REMEMBERED: usize = 8;

/// Names a mesh as it is at present.
#[derive(Copy, Clone, PartialEq)]
struct Key {
    token: MeshToken,
    vertices: u64,
}

impl Key {
    fn of(mesh: &TriMesh) -> Self {
        let vertices = xxh3_64(bytemuck::cast_slice(mesh.vertices()));
        Self { token: MeshToken::of(mesh), vertices }
    }
}

/// Memory of a thread.
#[derive(Default)]
struct Memory {
    /// The last one asked about comes first.
    recent: Vec<(Key, PreparedRef)>,
    scratch: SearchScratch,
}

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

impl Memory {
    /// The prepared mesh, at the front of the memory; `None` if it cannot have a tree.
    fn recall(&mut self, cache: &Arc<TreeCache>, key: Key, mesh: &TriMesh) -> Option<PreparedRef> {
        let is_it =
            |(known, prepared): &(Key, PreparedRef)| *known == key && prepared.is_from(cache);
        match self.recent.iter().position(is_it) {
            Some(0) => {}
            Some(place) => self.recent[..=place].rotate_right(1),
            None => {
                let prepared = cache.noting(mesh, cache.prepare(mesh))?;
                self.recent.truncate(REMEMBERED - 1);
                self.recent.insert(0, (key, prepared));
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
            let mut recall = |key, mesh| memory.recall(cache, key, mesh);
            let key1 = Key::of(meshes[0]);
            let tree1 = recall(key1, meshes[0])?;
            let tree2 = if std::ptr::eq(meshes[0], meshes[1]) {
                tree1.clone()
            } else {
                recall(Key::of(meshes[1]), meshes[1])?
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
