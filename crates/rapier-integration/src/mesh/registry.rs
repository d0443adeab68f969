use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock, RwLockWriteGuard, Weak};

use parry3d::shape::{SharedShape, TriMesh};

/// Meshes that cannot change, with their trees: as long as a clone of a [`SharedShape`] is held
/// here, whoever edits the shape edits a copy. So their addresses prove what they are.
pub(super) struct Registry<T>(RwLock<HashMap<usize, Weak<Registered<T>>>>);

/// A registered mesh and its tree.
pub(crate) struct Registered<T> {
    shape: SharedShape,
    pub(crate) tree: T,
    registry: Arc<Registry<T>>,
}

impl<T> Default for Registry<T> {
    fn default() -> Self {
        Self(RwLock::default())
    }
}

impl<T: Clone> Registry<T> {
    /// Registers the mesh that `shape` is, unless it is registered.
    pub(super) fn register(self: &Arc<Self>, shape: &SharedShape, tree: T) -> Arc<Registered<T>> {
        let (shape, registry) = (shape.clone(), Arc::clone(self));
        let registered = Arc::new(Registered { shape, tree, registry });
        let Some(address) = registered.address() else {
            return registered;
        };
        let mut meshes = self.write();
        let known = meshes.get(&address).and_then(Weak::upgrade);
        if known.is_none() {
            meshes.insert(address, Arc::downgrade(&registered));
        }
        // The new one goes only now, if it is not needed: it takes the lock.
        drop(meshes);
        known.unwrap_or(registered)
    }

    /// The tree of a registered mesh.
    pub(super) fn tree_of(&self, mesh: &TriMesh) -> Option<T> {
        let meshes = self.0.read().unwrap_or_else(PoisonError::into_inner);
        let registered = meshes.get(&address(mesh))?.upgrade()?;
        // It may be the last one to go, and then takes the lock.
        drop(meshes);
        Some(registered.tree.clone())
    }
}

impl<T> Registry<T> {
    fn write(&self) -> RwLockWriteGuard<'_, HashMap<usize, Weak<Registered<T>>>> {
        self.0.write().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> Registered<T> {
    fn address(&self) -> Option<usize> {
        self.shape.as_trimesh().map(address)
    }
}

impl<T> Drop for Registered<T> {
    fn drop(&mut self) {
        let Some(address) = self.address() else {
            return;
        };
        let mut meshes = self.registry.write();
        // It may have been registered again.
        if meshes.get(&address).is_some_and(|mesh| mesh.strong_count() == 0) {
            meshes.remove(&address);
        }
    }
}

fn address(mesh: &TriMesh) -> usize {
    std::ptr::from_ref(mesh).addr()
}

#[cfg(test)]
mod tests {
    use parry3d::shape::Ball;

    use super::*;

    /// Would catch a mesh that is forgotten when one of its registrations goes, one that is never
    /// forgotten, and a second tree of it that takes the place of the first.
    #[test]
    fn a_mesh_is_known_until_its_last_registration_goes() {
        let (vertices, triangles) = Ball::new(1.0).to_trimesh(6, 3);
        let [shape, other] =
            [0, 1].map(|_| SharedShape::trimesh(vertices.clone(), triangles.clone()).unwrap());
        let of = |shape: &SharedShape, registry: &Registry<u32>| {
            registry.tree_of(shape.as_trimesh().unwrap())
        };
        let registry = Arc::new(Registry::default());
        let first = registry.register(&shape, 1);
        let second = registry.register(&shape.clone(), 2);
        assert!(Arc::ptr_eq(&first, &second));
        assert_eq!([of(&shape, &registry), of(&other, &registry)], [Some(1), None]);
        drop(first);
        assert_eq!(of(&shape, &registry), Some(1));
        drop(second);
        assert_eq!((of(&shape, &registry), registry.write().len()), (None, 0));

        // The last one goes while the mesh is registered anew.
        let old = registry.register(&shape, 3);
        let address = old.address().unwrap();
        registry.write().remove(&address);
        let new = registry.register(&shape, 4);
        drop(old);
        assert_eq!(of(&shape, &registry), Some(4));
        drop(new);
        assert_eq!(of(&shape, &registry), None);
    }
}
