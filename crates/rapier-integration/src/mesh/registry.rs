use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock, Weak};

use parry3d::shape::{SharedShape, TriMesh};

use super::cache::PreparedRef;

/// Meshes that cannot change: as long as a clone of a [`SharedShape`] is held here, whoever edits
/// the shape edits a copy. So their addresses prove what they are.
#[derive(Default)]
pub(super) struct Registry(RwLock<HashMap<usize, Weak<Registered>>>);

/// A registered mesh and its tree.
pub(crate) struct Registered {
    shape: SharedShape,
    tree: PreparedRef,
}

impl Registered {
    /// Registers the mesh that `shape` is, unless it is registered.
    pub(super) fn new(shape: &SharedShape, tree: PreparedRef, registry: &Registry) -> Arc<Self> {
        let registered = Arc::new(Self { shape: shape.clone(), tree });
        let Some(mesh) = shape.as_trimesh() else {
            return registered;
        };
        let mut meshes = registry.0.write().unwrap_or_else(PoisonError::into_inner);
        let known = meshes.get(&address(mesh)).and_then(Weak::upgrade);
        if known.is_none() {
            meshes.insert(address(mesh), Arc::downgrade(&registered));
        }
        // The new one goes only now, if it is not needed: it may take the lock.
        drop(meshes);
        known.unwrap_or(registered)
    }

    pub(crate) fn tree(&self) -> &PreparedRef {
        &self.tree
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        if let Some(mesh) = self.shape.as_trimesh() {
            self.tree.cache().unregister(address(mesh));
        }
    }
}

impl Registry {
    pub(super) fn tree_of(&self, mesh: &TriMesh) -> Option<PreparedRef> {
        let meshes = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let registered = meshes.get(&address(mesh))?.upgrade()?;
        // It may be the last one to go, and then takes the lock.
        drop(meshes);
        Some(registered.tree.clone())
    }

    /// Forgets a mesh, unless it has been registered again.
    pub(super) fn forget(&self, address: usize) {
        let mut meshes = self.0.write().unwrap_or_else(PoisonError::into_inner);
        if meshes.get(&address).is_some_and(|mesh| mesh.strong_count() == 0) {
            meshes.remove(&address);
        }
    }
}

fn address(mesh: &TriMesh) -> usize {
    std::ptr::from_ref(mesh).addr()
}
