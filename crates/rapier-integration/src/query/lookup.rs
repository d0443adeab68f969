//! Trees of two meshes, for queries without a workspace.
//!
//! Nothing proves that an unregistered mesh is still the one of an earlier query, so each query
//! computes a hash of its content. That pays for small meshes. [`Walk`] searches the BVHs of others.

use std::cell::RefCell;
use std::sync::Arc;

use sbbk_core::query::SearchScratch;
use sbbk_core::tree::Tree;

use super::walk::Walk;
use crate::mesh::{MeshData, MeshView};

thread_local! {
    static SCRATCH: RefCell<SearchScratch> = RefCell::default();
}

/// Two rigid meshes of a query.
pub(crate) struct MeshQuery<'a> {
    pub(crate) meshes: [MeshView<'a>; 2],
}

impl MeshQuery<'_> {
    /// Returns the trees of both meshes, if both are registered or small.
    pub(super) fn trees(&self) -> Option<Trees> {
        let [mesh1, mesh2] = &self.meshes;
        let tree1 = mesh1.with_tree()?;
        let is_same = std::ptr::eq(mesh1.mesh, mesh2.mesh);
        let tree2 = if is_same { Arc::clone(&tree1) } else { mesh2.with_tree()? };
        Some(Trees([tree1, tree2]))
    }

    /// Returns the trees of both meshes, if both are registered.
    pub(super) fn registered_trees(&self) -> Option<Trees> {
        let [mesh1, mesh2] = self.meshes.each_ref().map(MeshView::registered);
        Some(Trees([mesh1?, mesh2?]))
    }

    pub(super) fn walk(&self) -> Walk<'_> {
        Walk(self.meshes.each_ref())
    }
}

/// The trees of two meshes.
pub(crate) struct Trees([Arc<MeshData>; 2]);

impl Trees {
    /// Both trees.
    pub(super) fn both(&self) -> (&Tree, &Tree) {
        let [tree1, tree2] = self.0.each_ref().map(|mesh| mesh.tree().expect("built before"));
        (tree1, tree2)
    }

    /// Searches with the scratch memory of this thread.
    pub(super) fn search<T>(&self, search: impl FnOnce(&mut SearchScratch) -> T) -> T {
        SCRATCH.with_borrow_mut(search)
    }
}
