//! Trees of two meshes, for queries without a workspace.

use std::cell::RefCell;
use std::sync::Arc;

use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;

use crate::mesh::{MeshData, MeshView};

thread_local! {
    static SCRATCH: RefCell<SearchScratch> = RefCell::default();
}

/// The trees of two meshes.
pub(super) struct Trees([Arc<MeshData>; 2]);

impl Trees {
    /// Returns the trees of meshes that are registered or small.
    pub(super) fn of([mesh1, mesh2]: [&MeshView<'_>; 2]) -> Option<Self> {
        // A large mesh without a tree costs no hash, so the larger one comes first.
        if mesh1.mesh.indices().len() < mesh2.mesh.indices().len() {
            let tree2 = mesh2.with_tree()?;
            return Some(Self([mesh1.with_tree()?, tree2]));
        }
        let tree1 = mesh1.with_tree()?;
        let is_same = std::ptr::eq(mesh1.mesh, mesh2.mesh);
        let tree2 = if is_same { Arc::clone(&tree1) } else { mesh2.with_tree()? };
        Some(Self([tree1, tree2]))
    }

    /// Returns the trees of registered meshes.
    pub(super) fn of_registered(meshes: [&MeshView<'_>; 2]) -> Option<Self> {
        let [mesh1, mesh2] = meshes.map(MeshView::registered);
        Some(Self([mesh1?, mesh2?]))
    }

    pub(super) fn search<T>(
        &self,
        search: impl FnOnce((&Tree, &Tree), &mut SearchScratch) -> T,
    ) -> T {
        let [tree1, tree2] = self.0.each_ref().map(|mesh| mesh.tree().expect("built"));
        SCRATCH.with_borrow_mut(|scratch| search((tree1, tree2), scratch))
    }
}
