//! One prepared mesh for all colliders with equal geometry.
//!
//! The lock is taken when a pair of colliders first needs its trees and when the last pair that used a tree ends, not by
//! a query of a pair that has them. Trees are built outside of it; threads that want the same one wait for it alone.

use std::collections::{HashMap, HashSet, VecDeque};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use parry3d::shape::TriMesh;
use sbbk_core::tree::{BuildError, BuildOptions};

use super::identity::{ContentHash, MeshToken};
use super::prepared::PreparedMesh;

pub(crate) struct TreeCache {
    options: BuildOptions,
    /// Memory that trees without users may keep. Least recently used ones go first.
    idle_bytes_limit: usize,
    entries: Mutex<Entries>,
    builds: AtomicU64,
    hits: AtomicU64,
    /// Meshes that cannot have a tree: not asked about again. By token, so a mesh that is taken for one of them by
    /// mistake is answered by Parry, correctly if slowly.
    unsupported: Mutex<HashSet<MeshToken>>,
    /// Whether there are any, so that nobody takes the lock where there are none.
    has_unsupported: AtomicBool,
}

/// Unsupported meshes remembered at most; then all are forgotten, and asked about once more.
const UNSUPPORTED: usize = 256;

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
    /// Living [`PreparedRef`]s. Rises from zero under the lock only.
    users: AtomicUsize,
}

impl Entry {
    fn bytes(&self) -> usize {
        match self.prepared.get() {
            Some(Ok(prepared)) => prepared.bytes(),
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
}

impl TreeCache {
    pub(crate) fn new(options: BuildOptions, idle_bytes_limit: usize) -> Self {
        Self {
            options,
            idle_bytes_limit,
            entries: Mutex::default(),
            builds: AtomicU64::new(0),
            hits: AtomicU64::new(0),
            unsupported: Mutex::default(),
            has_unsupported: AtomicBool::new(false),
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

    /// Remembers a mesh for which [`prepare`](Self::prepare) failed.
    pub(crate) fn note_unsupported(&self, mesh: &TriMesh) {
        let mut unsupported = self.unsupported.lock().unwrap_or_else(PoisonError::into_inner);
        if unsupported.len() >= UNSUPPORTED {
            unsupported.clear();
        }
        unsupported.insert(MeshToken::of(mesh));
        self.has_unsupported.store(true, Ordering::Release);
    }

    /// Whether one of the meshes is known not to have a tree.
    pub(crate) fn is_unsupported(&self, meshes: &[&TriMesh]) -> bool {
        if !self.has_unsupported.load(Ordering::Acquire) {
            return false;
        }
        let unsupported = self.unsupported.lock().unwrap_or_else(PoisonError::into_inner);
        meshes.iter().any(|mesh| unsupported.contains(&MeshToken::of(mesh)))
    }

    fn acquire(self: &Arc<Self>, content: ContentHash) -> PreparedRef {
        let mut entries = self.lock();
        let entry = entries.by_content.entry(content).or_insert_with(|| {
            Arc::new(Entry { content, prepared: OnceLock::new(), users: AtomicUsize::new(0) })
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
