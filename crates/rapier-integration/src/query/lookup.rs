//! Trees of two meshes, for queries without a workspace.
//!
//! No query before can prove that an unregistered mesh is still the same, so only registered meshes
//! have trees here. [`Walk`] searches the BVHs of all others.

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
    /// Returns the trees of both meshes, if both are registered.
    pub(super) fn trees(&self) -> Option<Trees> {
        let [mesh1, mesh2] = self.meshes.each_ref().map(MeshView::registered);
        Some(Trees([mesh1?, mesh2?]))
    }

    pub(super) fn walk(&self) -> Walk<'_> {
        Walk(self.meshes.each_ref())
    }
}

/// The trees of two registered meshes.
pub(crate) struct Trees([Arc<MeshData>; 2]);

impl Trees {
    /// Both trees.
    pub(super) fn both(&self) -> (&Tree, &Tree) {
        let [tree1, tree2] =
            self.0.each_ref().map(|mesh| mesh.tree().expect("registered meshes have trees"));
        (tree1, tree2)
    }

    /// Searches with the scratch memory of this thread.
    pub(super) fn search<T>(&self, search: impl FnOnce(&mut SearchScratch) -> T) -> T {
        SCRATCH.with_borrow_mut(search)
    }
}
