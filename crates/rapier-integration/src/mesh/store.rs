//! Maps meshes with equal geometry to one [`MeshData`].
//!
//! The key of a mesh is its content, or its address if the mesh is registered. Pairs keep their
//! [`MeshData`]: only first queries and those after a registration take a lock. Trees and surfaces are
//! computed outside of the locks.

use std::collections::{HashMap, VecDeque};
use std::hash::Hash;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock, Weak};

use parry3d::shape::{SharedShape, TriMesh};
use sbbk_core::surface::{Surface, SurfaceKind};
use sbbk_core::tree::{BuildError, LayerPlan};

use super::budget::BuildBudget;
use super::data::MeshData;
use super::identity::ContentHash;
use crate::stats::Counters;
use crate::{SbbkInternals, SbbkStats};

/// The meshes of a dispatcher and its clones.
#[derive(Default)]
pub(crate) struct MeshStore {
    /// Number of this store among all stores of the process.
    pub(super) id: u64,
    /// The volumes of trees.
    layers: Option<LayerPlan>,
    /// Bytes that recently used meshes may keep.
    recent_limit: usize,
    contents: Mutex<Contents>,
    registered: RwLock<RegisteredMeshes>,
    /// Number of registrations that have begun or ended.
    registrations: Arc<AtomicU64>,
    budget: BuildBudget,
    pub(crate) counters: Counters,
}

#[derive(Default)]
struct RegisteredMeshes {
    /// By address. The shape that each one holds keeps the address in use.
    shapes: HashMap<usize, Weak<Registered>>,
    /// Large meshes without a shape, by their number of triangles: only a mesh of as many triangles
    /// is hashed.
    contents: HashMap<usize, Vec<Weak<Registered>>>,
}

/// A registered mesh. While `shape` is held here, edits of the shape go to a copy, and the address
/// identifies the content.
pub(crate) struct Registered {
    shape: Option<SharedShape>,
    content: ContentHash,
    pub(crate) data: Arc<MeshData>,
    /// Counts the end of the registration; `None` for a mesh that pairs find without one.
    registrations: Option<Arc<AtomicU64>>,
}

impl Drop for Registered {
    fn drop(&mut self) {
        if let Some(registrations) = &self.registrations {
            registrations.fetch_add(1, Ordering::Release);
        }
    }
}

#[derive(Default)]
struct Contents {
    meshes: HashMap<ContentHash, Weak<MeshData>>,
    /// Recently used meshes, the oldest first.
    recent: VecDeque<Arc<MeshData>>,
    recent_bytes: usize,
}

impl MeshStore {
    pub(crate) fn new(layers: Option<LayerPlan>, recent_limit: usize) -> Self {
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        let id = NEXT_ID.fetch_add(1, Ordering::Relaxed);
        Self { id, layers, recent_limit, ..Self::default() }
    }

    /// Registers a mesh, with its tree and surface: `shape` by its address, a large mesh without a
    /// shape by its content. The registration lasts while the result lives.
    ///
    /// # Errors
    /// Says why this mesh cannot have a tree.
    pub(crate) fn register(
        &self,
        mesh: &TriMesh,
        shape: Option<&SharedShape>,
    ) -> Result<Arc<Registered>, BuildError> {
        let content = ContentHash::of(mesh);
        let data = self.entry_of(content);
        self.build(mesh, &data)?;
        if data.surface().is_none() {
            data.analyse(mesh);
            self.contents().keep_recent(&data, self.recent_limit);
        }
        let count = mesh.indices().len();
        // Pairs find small meshes without a registration.
        let is_listed = shape.is_some() || !is_small(count);
        let RegisteredMeshes { shapes, contents } =
            &mut *self.registered.write().unwrap_or_else(PoisonError::into_inner);
        if shape.is_some()
            && let Some(known) = shapes.get(&address(mesh)).and_then(Weak::upgrade)
        {
            return Ok(known);
        }
        let registrations = is_listed.then(|| Arc::clone(&self.registrations));
        let shape = shape.cloned();
        let registered = Arc::new(Registered { shape, content, data, registrations });
        if registered.shape.is_some() {
            make_room(shapes);
            shapes.insert(address(mesh), Arc::downgrade(&registered));
        } else if is_listed {
            contents.retain(|_, of_count| {
                of_count.retain(|known| known.strong_count() > 0);
                !of_count.is_empty()
            });
            contents.entry(count).or_default().push(Arc::downgrade(&registered));
        }
        if is_listed {
            self.registrations.fetch_add(1, Ordering::Release);
        }
        Ok(registered)
    }

    /// Returns the registration of a mesh. Hashes the content of a large mesh if one of as many
    /// triangles is registered without a shape.
    pub(crate) fn registered(&self, mesh: &TriMesh) -> Option<Arc<Registered>> {
        let meshes = self.registered.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = meshes.shapes.get(&address(mesh)).and_then(Weak::upgrade) {
            return Some(known);
        }
        let of_count = meshes.contents.get(&mesh.indices().len())?;
        let known: Vec<_> = of_count.iter().filter_map(Weak::upgrade).collect();
        drop(meshes);
        let content = (!known.is_empty()).then(|| ContentHash::of(mesh))?;
        known.into_iter().find(|known| known.content == content)
    }

    /// Rises when a registration begins or ends.
    #[inline]
    pub(super) fn registrations(&self) -> u64 {
        self.registrations.load(Ordering::Acquire)
    }

    /// Returns the data of a mesh: of a small one by a hash of all its content, of a large one by a
    /// hash of samples.
    pub(super) fn entry(&self, mesh: &TriMesh) -> Arc<MeshData> {
        let count = mesh.indices().len();
        if !is_small(count) {
            return self.entry_of(ContentHash::of_samples(mesh));
        }
        // A hash takes a 64th of the time of a tree.
        self.budget.charge(count / 64);
        self.entry_of(ContentHash::of(mesh))
    }

    fn entry_of(&self, content: ContentHash) -> Arc<MeshData> {
        let mut contents = self.contents();
        let known = contents.meshes.get(&content).and_then(Weak::upgrade);
        let data = known.unwrap_or_else(|| {
            let data = Arc::default();
            make_room(&mut contents.meshes);
            contents.meshes.insert(content, Arc::downgrade(&data));
            data
        });
        if data.tree().is_some() {
            self.counters.tree_hits.raise();
        }
        contents.keep_recent(&data, self.recent_limit);
        data
    }

    /// Returns the data of a small mesh, if its tree is there or the budget covers the tree.
    /// Charges no hash: queries without a workspace compute one each time, and would never save up
    /// for a tree.
    pub(super) fn small_with_tree(&self, mesh: &TriMesh) -> Option<Arc<MeshData>> {
        let is_small = is_small(mesh.indices().len());
        let data = is_small.then(|| self.entry_of(ContentHash::of(mesh)))?;
        self.build_within_budget(mesh, &data);
        data.tree().is_some().then_some(data)
    }

    /// Builds the tree of a small mesh, if the budget covers it and no thread has begun to.
    pub(super) fn build_within_budget(&self, mesh: &TriMesh, data: &Arc<MeshData>) {
        let count = mesh.indices().len();
        if !data.has_build_begun() && self.budget.spend(count) && data.begin_build() {
            // A mesh that cannot have a tree does without.
            let _ = self.build(mesh, data);
        }
    }

    fn build(&self, mesh: &TriMesh, data: &Arc<MeshData>) -> Result<(), BuildError> {
        if data.build(mesh, self.layers)? {
            self.counters.tree_builds.raise();
            self.contents().keep_recent(data, self.recent_limit);
        }
        Ok(())
    }

    /// Returns the surface of a mesh. Analyses the mesh if no query has done so.
    #[inline]
    pub(super) fn surface<'a>(&self, mesh: &TriMesh, data: &'a Arc<MeshData>) -> &'a Surface {
        data.surface().unwrap_or_else(|| self.analyse(mesh, data))
    }

    #[cold]
    fn analyse<'a>(&self, mesh: &TriMesh, data: &'a Arc<MeshData>) -> &'a Surface {
        // A surface takes a sixth of the time of a tree.
        self.budget.charge(mesh.indices().len() / 6);
        let surface = data.analyse(mesh);
        self.contents().keep_recent(data, self.recent_limit);
        surface
    }

    /// Notes a descent or a search without trees, which earns time for trees.
    pub(crate) fn earn_tree(&self) {
        self.budget.earn();
    }

    /// Drops the data of meshes that no pair uses.
    pub(crate) fn release_idle(&self) {
        let Contents { meshes, recent, recent_bytes } = &mut *self.contents();
        recent.retain(|data| {
            let is_used = Arc::strong_count(data) > 1;
            *recent_bytes -= if is_used { 0 } else { data.counted_bytes.load(Ordering::Relaxed) };
            is_used
        });
        meshes.retain(|_, data| data.strong_count() > 0);
    }

    /// Returns all counts.
    pub(crate) fn stats(&self) -> SbbkStats {
        let counted = self.counters.stats();
        let contents = self.contents();
        let meshes: Vec<_> = contents.meshes.values().filter_map(Weak::upgrade).collect();
        let of_kind = |kind| meshes.iter().filter(|data| data.kind() == Some(kind)).count();
        // Besides the recent list, `meshes` holds each one.
        let is_idle = |data: &&Arc<MeshData>| data.tree().is_some() && Arc::strong_count(data) == 2;
        SbbkStats {
            solids: of_kind(SurfaceKind::Solid),
            sheets: of_kind(SurfaceKind::Sheet),
            inside_out: of_kind(SurfaceKind::InsideOut),
            trees: meshes.iter().filter(|data| data.tree().is_some()).count(),
            tree_bytes: meshes.iter().map(|data| data.bytes()).sum(),
            internals: SbbkInternals {
                idle_trees: contents.recent.iter().filter(is_idle).count(),
                ..counted.internals
            },
            ..counted
        }
    }

    /// Takes all locks.
    #[cfg(test)]
    pub(super) fn lock_all(&self) -> impl Sized {
        (self.contents(), self.registered.write().expect("not poisoned"))
    }

    fn contents(&self) -> MutexGuard<'_, Contents> {
        // No code that holds the lock can panic between two changes.
        self.contents.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Contents {
    /// Keeps a mesh that was used or has grown, and drops the oldest ones beyond `limit` bytes. A
    /// mesh that was used since it came to the front goes to the end once more.
    fn keep_recent(&mut self, data: &Arc<MeshData>, limit: usize) {
        let bytes = data.bytes();
        let counted = data.counted_bytes.swap(bytes, Ordering::Relaxed);
        self.recent_bytes = self.recent_bytes + bytes - counted;
        if counted == 0 {
            self.recent.push_back(Arc::clone(data));
        } else {
            data.was_used_again.store(true, Ordering::Relaxed);
        }
        while self.recent_bytes > limit
            && let Some(oldest) = self.recent.pop_front()
        {
            if oldest.was_used_again.swap(false, Ordering::Relaxed) {
                self.recent.push_back(oldest);
            } else {
                self.recent_bytes -= oldest.counted_bytes.swap(0, Ordering::Relaxed);
            }
        }
    }
}

/// Least number of triangles of both meshes for which a pair uses trees. Higher: slower descents.
/// Lower: all of a mesh in a room is near the box of a leaf with four walls.
const LEAST_FOR_TREES: usize = 64;

/// True if two meshes have enough triangles for trees. Parry's BVHs serve others.
pub(crate) fn use_trees(meshes: [&TriMesh; 2]) -> bool {
    meshes.iter().all(|mesh| mesh.indices().len() >= LEAST_FOR_TREES)
}

/// True if a mesh of so many triangles may get a tree in a step.
pub(super) fn is_small(triangle_count: usize) -> bool {
    triangle_count <= BuildBudget::LIMIT as usize
}

/// Removes dead entries, if the map is full.
fn make_room<K: Eq + Hash, V>(map: &mut HashMap<K, Weak<V>>) {
    if map.len() == map.capacity() {
        map.retain(|_, value| value.strong_count() > 0);
        map.reserve(map.len() + 1);
    }
}

fn address(mesh: &TriMesh) -> usize {
    std::ptr::from_ref(mesh).addr()
}

#[cfg(test)]
mod tests {
    use parry3d::shape::Ball;

    use super::*;

    fn ball(radius: f32) -> TriMesh {
        let (vertices, triangles) = Ball::new(radius).to_trimesh(8, 4);
        TriMesh::new(vertices, triangles).unwrap()
    }

    fn store(recent_limit: usize) -> MeshStore {
        MeshStore::new(None, recent_limit)
    }

    #[test]
    fn recent_meshes_keep_to_the_limit_in_bytes() {
        let wide = store(usize::MAX);
        drop(wide.register(&ball(1.0), None).unwrap());
        let bytes = wide.stats().tree_bytes;
        for (limit, stay) in [(bytes, 1), (bytes - 1, 0)] {
            let store = store(limit);
            drop(store.register(&ball(1.0), None).unwrap());
            let SbbkStats { trees, internals, .. } = store.stats();
            assert_eq!((trees, internals.idle_trees), (stay, stay), "{limit}");
        }
    }

    #[test]
    fn the_mesh_that_was_not_used_for_longest_goes_first() {
        let bytes = {
            let store = store(usize::MAX);
            let _data = store.entry(&ball(1.0));
            store.stats().tree_bytes
        };
        let store = store(5 * bytes / 2);
        let is_there = |radius| {
            let content = ContentHash::of(&ball(radius));
            store.contents().meshes.get(&content).is_some_and(|data| data.strong_count() > 0)
        };
        [1.0, 2.0, 1.0, 3.0].iter().for_each(|&radius| drop(store.entry(&ball(radius))));
        assert_eq!([1.0, 2.0, 3.0].map(is_there), [true, false, true]);
    }

    #[test]
    fn dropped_meshes_leave_the_map() {
        let store = store(0);
        (1..1000).for_each(|i| drop(store.entry(&ball(i as f32))));
        assert!(store.contents().meshes.len() < 20);
        assert_eq!(store.stats().tree_bytes, 0);
    }

    #[test]
    fn a_mesh_is_registered_until_its_last_registration_goes() {
        let store = store(0);
        let [shape, other] = [(); 2].map(|()| SharedShape::new(ball(1.0)));
        let mesh = shape.as_trimesh().unwrap();
        let first = store.register(mesh, Some(&shape)).unwrap();
        let second = store.register(mesh, Some(&shape.clone())).unwrap();
        assert!(Arc::ptr_eq(&first, &second));
        assert!(store.registered(other.as_trimesh().unwrap()).is_none());
        drop(first);
        assert!(store.registered(mesh).is_some());
        let count = store.registrations();
        drop(second);
        assert!(store.registered(mesh).is_none() && store.registrations() > count);
        let _again = store.register(mesh, Some(&shape)).unwrap();
        assert!(store.registered(mesh).is_some());
    }

    /// Would catch a count that rises though nothing changed: every pair of a world then searches
    /// again.
    #[test]
    fn registrations_that_change_nothing_are_not_counted() {
        let store = store(0);
        let shape = SharedShape::new(ball(1.0));
        let mesh = shape.as_trimesh().unwrap();
        let first = store.register(mesh, Some(&shape)).unwrap();
        let count = store.registrations();
        drop(store.register(mesh, Some(&shape)).unwrap());
        drop(store.register(&ball(2.0), None).unwrap());
        assert_eq!(store.registrations(), count);
        drop(first);
        assert_eq!(store.registrations(), count + 1);
    }

    #[test]
    fn copies_of_a_large_mesh_are_registered_by_their_content() {
        let (vertices, triangles) = Ball::new(1.0).to_trimesh(100, 100);
        let mesh = TriMesh::new(vertices, triangles).unwrap();
        let mut other = mesh.clone();
        other.transform_vertices(&parry3d::math::Pose::translation(0.0, 1.0, 0.0));
        let store = store(0);
        let registered = store.register(&mesh, None).unwrap();
        let found = [&mesh, &mesh.clone(), &other].map(|mesh| store.registered(mesh).is_some());
        assert_eq!(found, [true, true, false]);
        let count = store.registrations();
        drop(registered);
        assert!(store.registered(&mesh).is_none() && store.registrations() > count);
    }

    #[test]
    fn a_declared_kind_replaces_the_computed_one() {
        let (store, mesh) = (store(usize::MAX), ball(1.0));
        let data = store.entry(&mesh);
        assert_eq!(data.kind(), None);
        assert_eq!(data.kind_by_rays(&mesh), SurfaceKind::Solid);
        for kind in [SurfaceKind::Sheet, SurfaceKind::InsideOut, SurfaceKind::Solid] {
            data.declare_kind(kind);
            assert_eq!(data.kind(), Some(kind));
        }
    }

    /// A hundred meshes that land in one step are analysed, as contacts depend on that. Fails if
    /// trees are built in the same step as if the analysis took no time.
    #[test]
    fn surfaces_leave_no_budget_for_trees() {
        let store = store(usize::MAX);
        let meshes: Vec<TriMesh> = (1..100).map(|i| ball(i as f32)).collect();
        let count = meshes[0].indices().len();
        for mesh in meshes.iter().cycle().take(100 * BuildBudget::LIMIT as usize / count) {
            let data = store.entry(mesh);
            store.analyse(mesh, &data);
        }
        for mesh in &meshes {
            store.build_within_budget(mesh, &store.entry(mesh));
        }
        assert_eq!(store.stats().internals.tree_builds, 0);
    }

    #[test]
    fn a_tree_that_another_thread_builds_is_not_waited_for() {
        let (store, mesh) = (store(usize::MAX), ball(1.0));
        let data = store.entry(&mesh);
        assert!(data.begin_build());
        store.build_within_budget(&mesh, &data);
        assert!(data.tree().is_none());
        assert!(store.register(&mesh, None).unwrap().data.tree().is_some());
    }
}
