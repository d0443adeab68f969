//! One prepared mesh for all colliders with equal geometry.
//!
//! A pair of two rigid meshes asks for their trees until it has both. It gets one that is there, or
//! that is small enough and paid for ([`credit`](super::credit)); else it does without, and asks
//! again some queries later.
//!
//! That takes a lock, and so does the end of the last pair that used a tree, but no query of a pair
//! that has its trees, or needs none. Each takes time that grows with the logarithm of the number of
//! trees. Trees are built outside of the lock; threads that want the same one wait for it alone.

use std::collections::hash_map::Entry as HashEntry;
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::ops::Deref;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use parry3d::shape::{CompositeShape, SharedShape, TriMesh};
use sbbk_core::surface::{Surface, SurfaceKind};
use sbbk_core::tree::{BuildError, BuildOptions};

use super::credit::Credit;
use super::hierarchy::Hierarchy;
use super::identity::{ContentCopy, ContentHash, MeshToken};
use super::prepared::PreparedMesh;
use super::registry::{Registered, Registry};
use super::soundness::Soundness;

pub(crate) struct TreeCache {
    /// Of this cache alone.
    id: u64,
    options: BuildOptions,
    /// Memory that trees without users may keep. Least recently used ones go first.
    idle_bytes_limit: usize,
    entries: Mutex<Entries>,
    builds: AtomicU64,
    hits: AtomicU64,
    pairs: AtomicU64,
    walks: AtomicU64,
    credit: Credit,
    registry: Arc<Registry<PreparedRef>>,
    soundness: Soundness,
}

/// Meshes without a pair that are kept for queries without manifolds, whatever the limit of idle
/// ones, which may be zero. More: scenes with many such meshes rebuild less.
const QUERIED: usize = 8;

#[derive(Default)]
pub(super) struct Entries {
    by_content: HashMap<ContentHash, Entry>,
    /// Entries without users, by when they became idle.
    idle: BTreeMap<u64, ContentHash>,
    /// When the next one becomes idle.
    now: u64,
    idle_bytes: usize,
    /// How many of the meshes have so many triangles. Others need no hash to be told apart.
    counts: HashMap<usize, usize>,
    /// The last meshes for which a query without manifolds needed the lock. Each counts as a user.
    queried: VecDeque<Arc<CachedMesh>>,
}

struct Entry {
    mesh: Arc<CachedMesh>,
    idle: Option<Idle>,
}

#[derive(Copy, Clone)]
struct Idle {
    since: u64,
    bytes: usize,
}

/// A prepared mesh that all colliders with equal geometry share.
pub(crate) struct CachedMesh {
    content: ContentHash,
    triangle_count: usize,
    prepared: OnceLock<Result<PreparedMesh, BuildError>>,
    /// Whether that has been paid for.
    is_begun: AtomicBool,
    /// From the first contact on.
    surface: OnceLock<Surface>,
    /// What the user says that the mesh bounds.
    kind: OnceLock<SurfaceKind>,
    /// Of the mesh, from the first query without manifolds on.
    copy: OnceLock<ContentCopy>,
    /// Living [`PreparedRef`]s, and a place in [`Entries::queried`]. Rises from zero under the lock
    /// only.
    users: AtomicUsize,
}

impl CachedMesh {
    fn new(content: ContentHash, triangle_count: usize) -> Self {
        Self {
            content,
            triangle_count,
            prepared: OnceLock::new(),
            is_begun: AtomicBool::new(false),
            surface: OnceLock::new(),
            kind: OnceLock::new(),
            copy: OnceLock::new(),
            users: AtomicUsize::new(0),
        }
    }

    /// All memory that goes with the mesh: its own, and its places in maps that are half empty at
    /// most.
    fn bytes(&self) -> usize {
        const PLACES: usize =
            2 * (size_of::<(ContentHash, Entry)>() + size_of::<(u64, ContentHash)>());
        const COUNTERS: usize = 2 * size_of::<usize>();
        // These count themselves, which are within this value.
        let tree = self.tree().map_or(0, |tree| tree.bytes() - size_of::<PreparedMesh>());
        let surface = self.surface.get().map_or(0, |own| own.bytes() - size_of::<Surface>());
        let copy = self.copy.get().map_or(0, ContentCopy::bytes);
        size_of::<Self>() + tree + surface + copy + COUNTERS + PLACES
    }

    /// The prepared mesh, if it is.
    pub(crate) fn tree(&self) -> Option<&PreparedMesh> {
        self.prepared.get()?.as_ref().ok()
    }

    /// The prepared mesh, of a mesh that [`TreeCache::prepare`] has returned.
    pub(crate) fn prepared(&self) -> &PreparedMesh {
        self.tree().expect("prepared")
    }

    /// The surface of the mesh, which must be this one, and what it bounds.
    #[inline]
    pub(crate) fn surface(&self, mesh: &TriMesh) -> (&Surface, SurfaceKind) {
        let look = || Surface::new(mesh.vertices(), mesh.indices());
        let surface = self.surface.get_or_init(look);
        (surface, self.kind.get().copied().unwrap_or(surface.kind()))
    }

    /// Settles what the mesh bounds, unless that is settled already. Whether it is that now.
    pub(crate) fn settle_kind(&self, kind: SurfaceKind) -> bool {
        *self.kind.get_or_init(|| kind) == kind
    }

    /// What the mesh bounds, if anything had to know.
    fn kind(&self) -> Option<SurfaceKind> {
        self.kind.get().copied().or_else(|| Some(self.surface.get()?.kind()))
    }

    /// Whether vertices and triangles of a mesh are, bit for bit, those of this one. Never so
    /// before the first [`TreeCache::prepare_for_queries`].
    pub(crate) fn is_of(&self, mesh: &TriMesh) -> bool {
        self.copy.get().is_some_and(|copy| copy.is_of(mesh))
    }

    /// The same for a single triangle.
    pub(crate) fn has_triangle_of(&self, mesh: &TriMesh, triangle: u32) -> bool {
        self.copy.get().is_some_and(|copy| copy.has_triangle_of(mesh, triangle))
    }
}

/// What the cache did so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct CacheCounts {
    pub(crate) trees: usize,
    pub(crate) solids: usize,
    pub(crate) sheets: usize,
    pub(crate) inside_out: usize,
    pub(crate) idle_trees: usize,
    pub(crate) bytes: usize,
    pub(crate) builds: u64,
    pub(crate) hits: u64,
    pub(crate) pairs: u64,
    pub(crate) walks: u64,
}

impl TreeCache {
    pub(crate) fn new(options: BuildOptions, idle_bytes_limit: usize) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self {
            id: NEXT.fetch_add(1, Ordering::Relaxed),
            options,
            idle_bytes_limit,
            entries: Mutex::default(),
            builds: AtomicU64::new(0),
            hits: AtomicU64::new(0),
            pairs: AtomicU64::new(0),
            walks: AtomicU64::new(0),
            credit: Credit::default(),
            registry: Arc::default(),
            soundness: Soundness::default(),
        }
    }

    /// The prepared mesh, built now if no equal one is known.
    ///
    /// # Errors
    /// Why this mesh cannot have a tree.
    pub(crate) fn prepare(self: &Arc<Self>, mesh: &TriMesh) -> Result<PreparedRef, BuildError> {
        let entry = self.know(mesh);
        self.build(mesh, &entry)?;
        Ok(entry)
    }

    /// Builds the tree of a mesh, whose entry this is, if it is not there.
    fn build(&self, mesh: &TriMesh, entry: &CachedMesh) -> Result<(), BuildError> {
        entry.is_begun.store(true, Ordering::Relaxed);
        let result = entry.prepared.get_or_init(|| {
            self.builds.fetch_add(1, Ordering::Relaxed);
            PreparedMesh::new(mesh, &self.options)
        });
        result.as_ref().map(|_| ()).map_err(BuildError::clone)
    }

    /// The same for queries without manifolds: kept for the next ones, with a copy of the mesh.
    ///
    /// # Errors
    /// Why this mesh cannot have a tree.
    pub(crate) fn prepare_for_queries(
        self: &Arc<Self>,
        mesh: &TriMesh,
    ) -> Result<Arc<CachedMesh>, BuildError> {
        let prepared = self.prepare(mesh)?;
        prepared.copy.get_or_init(|| ContentCopy::of(mesh));
        let cached = Arc::clone(&prepared.mesh);
        let mut entries = self.lock();
        if !entries.queried.iter().any(|known| Arc::ptr_eq(known, &cached)) {
            cached.users.fetch_add(1, Ordering::AcqRel);
            entries.queried.push_back(Arc::clone(&cached));
            if entries.queried.len() > QUERIED {
                entries.forget_oldest_queried(self.idle_bytes_limit);
            }
        }
        Ok(cached)
    }

    /// The same for good: as long as the result lives, a query about the shape knows its tree by
    /// its address.
    ///
    /// # Errors
    /// Why this mesh cannot have a tree.
    pub(crate) fn register(
        self: &Arc<Self>,
        shape: &SharedShape,
        mesh: &TriMesh,
    ) -> Result<Arc<Registered<PreparedRef>>, BuildError> {
        Ok(self.registry.register(shape, self.prepare(mesh)?))
    }

    /// What all pairs share of a mesh: found by a hash of all of it.
    pub(super) fn know(self: &Arc<Self>, mesh: &TriMesh) -> PreparedRef {
        self.acquire(ContentHash::of(mesh), mesh.indices().len())
    }

    /// The same of a mesh that is registered, which its address tells.
    pub(super) fn registered_tree(&self, mesh: &TriMesh) -> Option<PreparedRef> {
        self.registry.tree_of(mesh)
    }

    /// The tree of a large mesh if it is there, and queries have earned what it takes to know it.
    pub(super) fn recognise(self: &Arc<Self>, mesh: &TriMesh) -> Option<PreparedRef> {
        let count = mesh.indices().len();
        let may_be_there = self.lock().counts.contains_key(&count);
        if !may_be_there || !self.credit.spend(Credit::of_hash(count)) {
            return None;
        }
        let content = ContentHash::of(mesh);
        let is_there = self.lock().by_content.contains_key(&content);
        // Should it go meanwhile, it has no tree any more.
        is_there.then(|| self.acquire(content, count))
    }

    /// Builds the tree of a mesh, if queries have earned what it takes.
    pub(super) fn afford(&self, mesh: &TriMesh, entry: &CachedMesh) {
        let is_begun = entry.is_begun.swap(true, Ordering::Relaxed);
        if is_begun || self.is_small(mesh) && self.credit.spend(mesh.indices().len()) {
            // A mesh that cannot have one does without.
            let _ = self.build(mesh, entry);
        } else {
            entry.is_begun.store(false, Ordering::Relaxed);
        }
    }

    /// The tree of a mesh that is registered.
    pub(crate) fn registered(&self, mesh: &TriMesh) -> Option<Arc<CachedMesh>> {
        self.registered_tree(mesh).map(|tree| Arc::clone(&tree.mesh))
    }

    /// Whether the tree of a mesh can be built in the midst of things.
    pub(crate) fn is_small(&self, mesh: &TriMesh) -> bool {
        mesh.indices().len() <= Credit::MOST as usize
    }

    /// The largest mesh that is looked at as a whole unasked: in four milliseconds once, and in one to tell
    /// in each pair which mesh it is. Of two meshes of that size a query of stock's takes longer than that as
    /// long as they touch. More: longer steps where they meet; less: larger ones lock into each other.
    pub(super) const LARGEST_WHOLE: usize = 1 << 17;

    /// Whether the surface of a mesh may be looked for in the midst of things, though nobody has registered
    /// it, where it meets a mesh of so many triangles. A large one's not for a small one's sake: many may
    /// land on it together.
    pub(super) fn is_whole(&self, mesh: &TriMesh, other_count: usize) -> bool {
        let are_large = other_count > Credit::MOST as usize;
        self.is_small(mesh) || are_large && mesh.indices().len() <= Self::LARGEST_WHOLE
    }

    /// Notes a descent that had to do without trees.
    pub(crate) fn did_without(&self) {
        self.walks.fetch_add(1, Ordering::Relaxed);
        self.credit.earn();
    }

    /// Notes a pair of which nothing was known.
    pub(crate) fn met(&self) {
        self.pairs.fetch_add(1, Ordering::Relaxed);
    }

    /// A mesh as a query sees it; `None` if only Parry can answer for it: it is rigid and broken.
    #[inline]
    pub(crate) fn look_at<'a>(&self, mesh: &'a TriMesh) -> Option<Hierarchy<'a>> {
        let token = MeshToken::of(mesh);
        let is_broken = self.soundness.is_broken(mesh, token);
        let is_supported = !is_broken || mesh.is_deformable();
        is_supported.then(|| Hierarchy::new(mesh, token, self.id, is_broken))
    }

    fn acquire(self: &Arc<Self>, content: ContentHash, triangle_count: usize) -> PreparedRef {
        let mut entries = self.lock();
        let Entries { by_content, counts, .. } = &mut *entries;
        let entry = by_content.entry(content).or_insert_with(|| {
            *counts.entry(triangle_count).or_default() += 1;
            Entry { mesh: Arc::new(CachedMesh::new(content, triangle_count)), idle: None }
        });
        entry.mesh.users.fetch_add(1, Ordering::AcqRel);
        self.hits.fetch_add(entry.mesh.tree().is_some().into(), Ordering::Relaxed);
        let (mesh, idle) = (Arc::clone(&entry.mesh), entry.idle.take());
        if let Some(idle) = idle {
            entries.idle.remove(&idle.since);
            entries.idle_bytes -= idle.bytes;
        }
        PreparedRef { mesh, cache: Arc::clone(self) }
    }

    /// Drops all trees that no pair uses.
    pub(crate) fn release_idle(&self) {
        let mut entries = self.lock();
        while !entries.queried.is_empty() {
            entries.forget_oldest_queried(self.idle_bytes_limit);
        }
        entries.shrink_idle(0);
    }

    pub(crate) fn counts(&self) -> CacheCounts {
        let entries = self.lock();
        let is_queried = |entry: &&Entry| {
            let queried = || entries.queried.iter().any(|mesh| Arc::ptr_eq(mesh, &entry.mesh));
            entry.mesh.users.load(Ordering::Acquire) == 1 && queried()
        };
        let queried = entries.by_content.values().filter(is_queried).count();
        let has_tree = |content: &ContentHash| {
            entries.by_content.get(content).is_some_and(|entry| entry.mesh.tree().is_some())
        };
        let of_kind = |kind| {
            entries.by_content.values().filter(|entry| entry.mesh.kind() == Some(kind)).count()
        };
        CacheCounts {
            solids: of_kind(SurfaceKind::Solid),
            sheets: of_kind(SurfaceKind::Sheet),
            inside_out: of_kind(SurfaceKind::InsideOut),
            trees: entries.by_content.values().filter(|e| e.mesh.tree().is_some()).count(),
            idle_trees: entries.idle.values().filter(|content| has_tree(content)).count() + queried,
            bytes: entries.by_content.values().map(|entry| entry.mesh.bytes()).sum(),
            builds: self.builds.load(Ordering::Relaxed),
            hits: self.hits.load(Ordering::Relaxed),
            pairs: self.pairs.load(Ordering::Relaxed),
            walks: self.walks.load(Ordering::Relaxed),
        }
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, Entries> {
        // No code that holds the lock can leave the entries half changed.
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Entries {
    /// Called when the last user of a mesh has gone; another may have come since.
    fn release(&mut self, mesh: &CachedMesh, idle_bytes_limit: usize) {
        let Some(entry) = self.by_content.get_mut(&mesh.content) else {
            return;
        };
        let is_unused = mesh.users.load(Ordering::Acquire) == 0;
        if !is_unused || !std::ptr::eq(&*entry.mesh, mesh) || entry.idle.is_some() {
            return;
        }
        let bytes = mesh.bytes();
        entry.idle = Some(Idle { since: self.now, bytes });
        self.idle.insert(self.now, mesh.content);
        self.now += 1;
        self.idle_bytes += bytes;
        self.shrink_idle(idle_bytes_limit);
    }

    fn forget_oldest_queried(&mut self, idle_bytes_limit: usize) {
        if let Some(mesh) = self.queried.pop_front()
            && mesh.users.fetch_sub(1, Ordering::AcqRel) == 1
        {
            self.release(&mesh, idle_bytes_limit);
        }
    }

    /// Drops the oldest idle trees until the others take no more than `limit` bytes.
    fn shrink_idle(&mut self, limit: usize) {
        while self.idle_bytes > limit
            && let Some((_, content)) = self.idle.pop_first()
            && let Some(Entry { idle: Some(idle), .. }) = self.by_content.get(&content)
        {
            self.idle_bytes -= idle.bytes;
            self.remove(content);
        }
    }

    fn remove(&mut self, content: ContentHash) {
        if let Some(entry) = self.by_content.remove(&content)
            && let HashEntry::Occupied(mut count) = self.counts.entry(entry.mesh.triangle_count)
        {
            *count.get_mut() -= 1;
            if *count.get() == 0 {
                count.remove();
            }
        }
    }
}

/// A prepared mesh in use. The last one to go makes the tree idle.
pub(crate) struct PreparedRef {
    mesh: Arc<CachedMesh>,
    cache: Arc<TreeCache>,
}

impl Deref for PreparedRef {
    type Target = CachedMesh;

    fn deref(&self) -> &CachedMesh {
        &self.mesh
    }
}

impl Clone for PreparedRef {
    fn clone(&self) -> Self {
        self.mesh.users.fetch_add(1, Ordering::AcqRel);
        Self { mesh: Arc::clone(&self.mesh), cache: Arc::clone(&self.cache) }
    }
}

impl Drop for PreparedRef {
    fn drop(&mut self) {
        if self.mesh.users.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.cache.lock().release(&self.mesh, self.cache.idle_bytes_limit);
        }
    }
}

#[cfg(test)]
mod tests {
    use parry3d::math::Vector;
    use parry3d::shape::{Ball, TriMeshFlags};

    use super::*;

    fn ball(radius: f32) -> TriMesh {
        let (vertices, triangles) = Ball::new(radius).to_trimesh(8, 4);
        TriMesh::new(vertices, triangles).unwrap()
    }

    fn cache(idle_bytes_limit: usize) -> Arc<TreeCache> {
        Arc::new(TreeCache::new(BuildOptions::default(), idle_bytes_limit))
    }

    /// Would catch idle trees that go though they keep to the limit, or stay though they do not, and a
    /// copy that does not count.
    #[test]
    fn idle_trees_keep_to_the_limit_in_bytes() {
        let mesh = ball(1.0);
        let wide = cache(usize::MAX);
        drop(wide.prepare(&mesh).unwrap());
        let bytes = wide.counts().bytes;
        for (limit, stay) in [(bytes, 1), (bytes - 1, 0)] {
            let cache = cache(limit);
            drop(cache.prepare(&mesh).unwrap());
            assert_eq!((cache.counts().trees, cache.counts().idle_trees), (stay, stay), "{limit}");
        }
        drop(wide.prepare_for_queries(&mesh).unwrap());
        let copy = size_of_val(mesh.vertices()) + size_of_val(mesh.indices());
        assert_eq!(wide.counts().bytes, bytes + copy);
    }

    /// Would catch a mesh of which nothing is known that is kept, as it has as many triangles as
    /// another one.
    #[test]
    fn only_what_is_there_is_recognised() {
        let (cache, known, other) = (cache(usize::MAX), ball(1.0), ball(2.0));
        let _known = cache.prepare(&known).unwrap();
        (0..1000).for_each(|_| cache.did_without());
        assert!(cache.recognise(&other).is_none());
        assert!(cache.recognise(&known).is_some());
    }

    /// Would catch a mesh that is what it looks like, though the user says that it is something else.
    #[test]
    fn what_a_mesh_bounds_can_be_settled() {
        let (cache, mesh) = (cache(usize::MAX), ball(1.0));
        let known = cache.know(&mesh);
        known.settle_kind(SurfaceKind::Sheet);
        assert_eq!((cache.counts().solids, cache.counts().sheets), (0, 1));
        assert_eq!(known.surface(&mesh).1, SurfaceKind::Sheet);
        assert_eq!((cache.counts().solids, cache.counts().sheets), (0, 1));
    }

    /// Would catch a mesh that deforms left to Parry, and one that does not left to SBBK.
    #[test]
    fn of_broken_meshes_those_that_deform_are_answered_for() {
        for (flags, is_seen) in [(TriMeshFlags::DEFORMABLE, true), (TriMeshFlags::empty(), false)] {
            let corners = vec![Vector::ZERO, Vector::X, Vector::Y, Vector::NAN];
            let triangles = vec![[0, 1, 2], [1, 2, 3]];
            let mesh = TriMesh::with_flags(corners, triangles, flags).unwrap();
            assert_eq!(cache(0).look_at(&mesh).is_some(), is_seen);
        }
    }
}
