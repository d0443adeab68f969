//! Trees of meshes that deform: one for each mesh, wherever it is, not for each content.
//!
//! A tree is known by the addresses of the mesh's buffers. That names it only among the meshes that
//! exist at a time, and so each query compares the content as well: by [`DeformedContent`], which
//! it reads off the mesh. The first query after a change refits the tree, or builds one where the
//! triangles are others or the refitted one has become bad; queries of other pairs on other threads
//! wait for it and find it done.
//!
//! While a query uses a tree it holds a reference, and gives it back at its end. No mesh changes
//! while it is borrowed by a query, so when a tree must be refitted no other query holds it, and it
//! is changed in place.
//!
//! The locks here are taken by pairs with a deformable mesh only. A tree is dropped when the last
//! pair that knows it ends.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use parry3d::shape::TriMesh;
use sbbk_core::tree::BuildError;

use super::identity::DeformedContent;
use super::prepared::PreparedMesh;

/// Where a mesh is.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
struct Address {
    vertices: usize,
    triangles: usize,
}

impl Address {
    fn of(mesh: &TriMesh) -> Self {
        Self {
            vertices: mesh.vertices().as_ptr().addr(),
            triangles: mesh.indices().as_ptr().addr(),
        }
    }
}

#[derive(Default)]
pub(super) struct DeformableTrees {
    trees: Mutex<HashMap<Address, Weak<DeformableTree>>>,
    refits: AtomicU64,
    rebuilds: AtomicU64,
}

/// What was done for deformable meshes so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct DeformableCounts {
    pub(crate) trees: usize,
    pub(crate) bytes: usize,
    pub(crate) refits: u64,
    pub(crate) rebuilds: u64,
}

impl DeformableTrees {
    pub(super) fn counts(&self) -> DeformableCounts {
        // Not dropped under the lock: a tree that goes takes it.
        let trees: Vec<_> = self.lock().values().filter_map(Weak::upgrade).collect();
        DeformableCounts {
            trees: trees.len(),
            bytes: trees.iter().map(|tree| tree.bytes()).sum(),
            refits: self.refits.load(Ordering::Relaxed),
            rebuilds: self.rebuilds.load(Ordering::Relaxed),
        }
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Address, Weak<DeformableTree>>> {
        self.trees.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tree of one deformable mesh.
pub(crate) struct DeformableTree {
    address: Address,
    owner: Arc<DeformableTrees>,
    latest: Mutex<Option<Latest>>,
}

/// What the last query found, or why there is no tree.
struct Latest {
    content: DeformedContent,
    prepared: Result<Arc<PreparedMesh>, BuildError>,
}

impl DeformableTree {
    /// That of `mesh`, new if none is known.
    pub(super) fn of(mesh: &TriMesh, owner: &Arc<DeformableTrees>) -> Arc<Self> {
        let address = Address::of(mesh);
        let mut trees = owner.lock();
        if let Some(tree) = trees.get(&address).and_then(Weak::upgrade) {
            return tree;
        }
        let tree = Self { address, owner: Arc::clone(owner), latest: Mutex::default() };
        let tree = Arc::new(tree);
        trees.insert(address, Arc::downgrade(&tree));
        tree
    }

    /// Whether this is the place for the tree of `mesh`.
    pub(super) fn is_of(&self, mesh: &TriMesh, owner: &Arc<DeformableTrees>) -> bool {
        self.address == Address::of(mesh) && Arc::ptr_eq(&self.owner, owner)
    }

    /// The tree of the mesh with this content; brought up to date, or built by `build`, if the mesh
    /// has changed. To be given back before the mesh changes again.
    ///
    /// # Errors
    /// Why the mesh, as it is now, cannot have a tree.
    pub(super) fn current(
        &self,
        mesh: &TriMesh,
        content: DeformedContent,
        build: impl Fn() -> Result<PreparedMesh, BuildError>,
    ) -> Result<Arc<PreparedMesh>, BuildError> {
        let mut latest = self.lock();
        if let Some(latest) = latest.as_ref().filter(|latest| latest.content == content) {
            return latest.prepared.clone();
        }
        let prepared = match latest.take() {
            Some(Latest { content: old, prepared: Ok(prepared) })
                if old.topology == content.topology =>
            {
                self.refit(prepared, mesh, &build)
            }
            _ => build().map(Arc::new),
        };
        latest.insert(Latest { content, prepared }).prepared.clone()
    }

    fn refit(
        &self,
        mut prepared: Arc<PreparedMesh>,
        mesh: &TriMesh,
        build: &impl Fn() -> Result<PreparedMesh, BuildError>,
    ) -> Result<Arc<PreparedMesh>, BuildError> {
        // A host that edits a mesh during a query is answered as well, if slowly. So is a broken
        // mesh.
        if let Some(unused) = Arc::get_mut(&mut prepared)
            && let Ok(cost) = unused.refit(mesh)
        {
            self.owner.refits.fetch_add(1, Ordering::Relaxed);
            if !cost.needs_rebuild() {
                return Ok(prepared);
            }
        }
        self.owner.rebuilds.fetch_add(1, Ordering::Relaxed);
        build().map(Arc::new)
    }

    fn bytes(&self) -> usize {
        let latest = self.lock();
        let prepared = latest.as_ref().and_then(|latest| latest.prepared.as_ref().ok());
        prepared.map_or(0, |prepared| prepared.bytes())
    }

    fn lock(&self) -> MutexGuard<'_, Option<Latest>> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for DeformableTree {
    fn drop(&mut self) {
        let mut trees = self.owner.lock();
        // Another one may be in its place by now.
        if trees.get(&self.address).is_some_and(|tree| tree.strong_count() == 0) {
            trees.remove(&self.address);
        }
    }
}
