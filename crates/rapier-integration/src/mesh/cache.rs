//! One prepared mesh for all colliders with equal geometry.
//!
//! The lock is taken when a pair of colliders first needs its trees and when the last pair that used a tree ends, not by
//! a query of a pair that has them. Trees are built outside of it; threads that want the same one wait for it alone.

use std::collections::{HashMap, VecDeque};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use parry3d::shape::{CompositeShape, TriMesh};
use sbbk_core::tree::{BuildError, BuildOptions};

use super::deformable::{DeformableCounts, DeformableTree, DeformableTrees};
use super::identity::{ContentCopy, ContentHash, DeformedContent};
use super::prepared::PreparedMesh;
use super::unsupported::Unsupported;

pub(crate) struct TreeCache {
    options: BuildOptions,
    /// Memory that trees without users may keep. Least recently used ones go first.
    idle_bytes_limit: usize,
    entries: Mutex<Entries>,
    builds: AtomicU64,
    hits: AtomicU64,
    /// Trees that are not shared by content.
    deformable: Arc<DeformableTrees>,
    unsupported_rigid: Unsupported,
    unsupported_deformable: Unsupported,
}

#[derive(Default)]
struct Entries {
    by_content: HashMap<ContentHash, Arc<Entry>>,
    /// Entries without users, oldest first.
    idle: VecDeque<ContentHash>,
    idle_bytes: usize,
}

struct Entry {
    content: ContentHash,
    prepared: OnceLock<Result<PreparedMesh, BuildError>>,
    /// Of the mesh, from the first [`PreparedRef::keep_content`] on.
    content_copy: OnceLock<ContentCopy>,
    /// Living [`PreparedRef`]s. Rises from zero under the lock only.
    users: AtomicUsize,
}

impl Entry {
    fn bytes(&self) -> usize {
        match self.prepared.get() {
            Some(Ok(prepared)) => {
                prepared.bytes() + self.content_copy.get().map_or(0, ContentCopy::bytes)
            }
            _ => 0,
        }
    }
}

/// What the cache did so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct CacheCounts {
    pub(crate) trees: usize,
    pub(crate) idle_trees: usize,
    pub(crate) bytes: usize,
    pub(crate) builds: u64,
    pub(crate) hits: u64,
    pub(crate) deformable: DeformableCounts,
}

impl TreeCache {
    pub(crate) fn new(options: BuildOptions, idle_bytes_limit: usize) -> Self {
        Self {
            options,
            idle_bytes_limit,
            entries: Mutex::default(),
            builds: AtomicU64::new(0),
            hits: AtomicU64::new(0),
            deformable: Arc::default(),
            unsupported_rigid: Unsupported::default(),
            unsupported_deformable: Unsupported::default(),
        }
    }

    /// The prepared mesh, built now if no equal one is known.
    ///
    /// # Errors
    /// Why this mesh cannot have a tree.
    pub(crate) fn prepare(self: &Arc<Self>, mesh: &TriMesh) -> Result<PreparedRef, BuildError> {
        let content = ContentHash::of(mesh);
        let prepared = self.acquire(content);
        let mut built = false;
        let result = prepared.entry.prepared.get_or_init(|| {
            built = true;
            PreparedMesh::new(mesh, &self.options)
        });
        let counter = if built { &self.builds } else { &self.hits };
        counter.fetch_add(1, Ordering::Relaxed);
        match result {
            Ok(_) => Ok(prepared),
            Err(error) => Err(error.clone()),
        }
    }

    /// The result of preparing a mesh, which is remembered if there is no tree for it.
    pub(crate) fn noting<T>(&self, mesh: &TriMesh, result: Result<T, BuildError>) -> Option<T> {
        result.map_err(|_| self.unsupported(mesh).note(mesh)).ok()
    }

    /// Whether one of the meshes is known not to have a tree.
    pub(crate) fn is_unsupported(&self, meshes: &[&TriMesh]) -> bool {
        meshes.iter().any(|mesh| self.unsupported(mesh).contains(mesh))
    }

    /// A mesh that deforms may be broken for a step: the others must not take a lock for it for ever after.
    fn unsupported(&self, mesh: &TriMesh) -> &Unsupported {
        if mesh.is_deformable() { &self.unsupported_deformable } else { &self.unsupported_rigid }
    }

    /// The place of the tree of a deformable mesh. Takes a lock.
    pub(super) fn deformable(&self, mesh: &TriMesh) -> Arc<DeformableTree> {
        DeformableTree::of(mesh, &self.deformable)
    }

    /// Whether `tree` is what [`deformable`](Self::deformable) returns for the mesh.
    pub(super) fn is_place_of(&self, tree: &DeformableTree, mesh: &TriMesh) -> bool {
        tree.is_of(mesh, &self.deformable)
    }

    /// The tree of a deformable mesh as it is now, see [`DeformableTree::current`].
    pub(super) fn refitted(
        &self,
        tree: &DeformableTree,
        mesh: &TriMesh,
        content: DeformedContent,
    ) -> Result<Arc<PreparedMesh>, BuildError> {
        tree.current(mesh, content, || {
            self.builds.fetch_add(1, Ordering::Relaxed);
            PreparedMesh::new(mesh, &self.options)
        })
    }

    fn acquire(self: &Arc<Self>, content: ContentHash) -> PreparedRef {
        let mut entries = self.lock();
        let entry = entries.by_content.entry(content).or_insert_with(|| {
            let (prepared, content_copy) = (OnceLock::new(), OnceLock::new());
            Arc::new(Entry { content, prepared, content_copy, users: AtomicUsize::new(0) })
        });
        let entry = Arc::clone(entry);
        if entry.users.fetch_add(1, Ordering::AcqRel) == 0
            && let Some(place) = entries.idle.iter().position(|&idle| idle == content)
        {
            entries.idle.remove(place);
            entries.idle_bytes -= entry.bytes();
        }
        PreparedRef { entry, cache: Arc::clone(self) }
    }

    /// Called when the last user of an entry has gone; another may have come since.
    fn release(&self, entry: &Entry) {
        let mut entries = self.lock();
        let known = entries.by_content.get(&entry.content);
        let is_idle = entry.users.load(Ordering::Acquire) == 0
            && known.is_some_and(|known| std::ptr::eq(&**known, entry))
            && !entries.idle.contains(&entry.content);
        if is_idle {
            match entry.bytes() {
                // A mesh that cannot have a tree: nothing to keep.
                0 => drop(entries.by_content.remove(&entry.content)),
                bytes => {
                    entries.idle.push_back(entry.content);
                    entries.idle_bytes += bytes;
                    entries.shrink_idle(self.idle_bytes_limit);
                }
            }
        }
    }

    /// Drops all trees that no pair uses.
    pub(crate) fn release_idle(&self) {
        let mut entries = self.lock();
        while !entries.idle.is_empty() {
            entries.drop_oldest_idle();
        }
    }

    pub(crate) fn counts(&self) -> CacheCounts {
        let entries = self.lock();
        CacheCounts {
            trees: entries.by_content.len(),
            idle_trees: entries.idle.len(),
            bytes: entries.by_content.values().map(|entry| entry.bytes()).sum(),
            builds: self.builds.load(Ordering::Relaxed),
            hits: self.hits.load(Ordering::Relaxed),
            deformable: self.deformable.counts(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Entries> {
        // No code that holds the lock can leave the entries half changed.
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Entries {
    fn shrink_idle(&mut self, limit: usize) {
        while self.idle_bytes > limit {
            self.drop_oldest_idle();
        }
    }

    fn drop_oldest_idle(&mut self) {
        if let Some(content) = self.idle.pop_front()
            && let Some(entry) = self.by_content.remove(&content)
        {
            self.idle_bytes -= entry.bytes();
        }
    }
}

/// A prepared mesh in use. The last one to go makes the tree idle.
pub(crate) struct PreparedRef {
    entry: Arc<Entry>,
    cache: Arc<TreeCache>,
}

impl PreparedRef {
    /// Whether this cache made it.
    pub(crate) fn is_from(&self, cache: &Arc<TreeCache>) -> bool {
        Arc::ptr_eq(&self.cache, cache)
    }

    /// Copies vertices and triangles of the mesh that this has just been prepared for, if nobody has yet.
    pub(crate) fn keep_content(&self, mesh: &TriMesh) {
        self.entry.content_copy.get_or_init(|| ContentCopy::of(mesh));
    }

    /// Whether vertices and triangles of a mesh are, bit for bit, those kept by [`keep_content`](Self::keep_content).
    pub(crate) fn has_content_of(&self, mesh: &TriMesh) -> bool {
        self.entry.content_copy.get().is_some_and(|copy| copy.is_of(mesh))
    }

    /// The same for a single triangle.
    pub(crate) fn has_triangle_of(&self, mesh: &TriMesh, triangle: u32) -> bool {
        self.entry.content_copy.get().is_some_and(|copy| copy.has_triangle_of(mesh, triangle))
    }

    pub(crate) fn get(&self) -> &PreparedMesh {
        match self.entry.prepared.get() {
            Some(Ok(prepared)) => prepared,
            _ => unreachable!("`TreeCache::prepare` returns references to finished trees only"),
        }
    }
}

impl Clone for PreparedRef {
    fn clone(&self) -> Self {
        self.entry.users.fetch_add(1, Ordering::AcqRel);
        Self { entry: Arc::clone(&self.entry), cache: Arc::clone(&self.cache) }
    }
}

impl Drop for PreparedRef {
    fn drop(&mut self) {
        if self.entry.users.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.cache.release(&self.entry);
        }
    }
}
