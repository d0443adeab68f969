//! Two meshes.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use parry3d::math::{Pose, Vector};
use parry3d::query::ShapeCastHit;
use sbbk_core::contact::TriangleContact;
use sbbk_core::query::{
    Cast, CastOptions, FoundPair, MeshBodies, PartPair, SearchScratch, cast, deepest,
    first_minimum, meeting, nearest,
};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

use super::bvh_search::BvhSearch;
use super::nonlinear::NonlinearCast;
use super::{Found, status};
use crate::mesh::{MeshData, MeshView, is_minimum, use_trees};

thread_local! {
    static SCRATCH: RefCell<SearchScratch> = RefCell::default();
}

/// Data of two meshes that have trees.
type Trees = [Arc<MeshData>; 2];

fn search_trees<T>(
    trees: &Trees,
    search: impl FnOnce((&Tree, &Tree), &mut SearchScratch) -> T,
) -> T {
    let [tree1, tree2] = trees.each_ref().map(|mesh| mesh.tree().expect("built"));
    SCRATCH.with_borrow_mut(|scratch| search((tree1, tree2), scratch))
}

/// Two rigid meshes of a query.
pub(crate) struct MeshQuery<'a> {
    meshes: [MeshView<'a>; 2],
    placement: Placement,
    trees: OnceCell<Option<Trees>>,
}

impl<'a> MeshQuery<'a> {
    pub(crate) fn new(meshes: [MeshView<'a>; 2], pos12: &Pose) -> Self {
        Self { meshes, placement: Placement::new(pos12), trees: OnceCell::new() }
    }

    /// Searches by trees, or by BVHs if a mesh has none.
    fn search<T>(
        &self,
        by_trees: impl FnOnce((&Tree, &Tree), &mut SearchScratch) -> T,
        by_bvhs: impl FnOnce(BvhSearch<'_>) -> T,
    ) -> T {
        match self.trees.get_or_init(|| self.trees()) {
            Some(trees) => search_trees(trees, by_trees),
            None => {
                self.meshes[0].store.earn_tree();
                by_bvhs(self.bvhs())
            }
        }
    }

    fn bvhs(&self) -> BvhSearch<'_> {
        BvhSearch { meshes: self.meshes.each_ref(), placement: self.placement }
    }

    /// Returns true if the meshes have enough triangles for trees.
    fn use_trees(&self) -> bool {
        use_trees(self.meshes.each_ref().map(|view| view.mesh))
    }

    /// Returns the trees of meshes that are registered, or small and within the budget.
    fn trees(&self) -> Option<Trees> {
        if !self.use_trees() {
            return None;
        }
        let [mesh1, mesh2] = self.meshes.each_ref().map(|view| view.mesh);
        // A large mesh without a tree costs no hash, so the larger one comes first.
        let larger = usize::from(mesh1.indices().len() < mesh2.indices().len());
        let tree = self.meshes[larger].with_tree()?;
        let is_same = std::ptr::eq(mesh1, mesh2);
        let other =
            if is_same { Arc::clone(&tree) } else { self.meshes[1 - larger].with_tree()? };
        Some(if larger == 0 { [tree, other] } else { [other, tree] })
    }

    /// Returns triangles that touch, if any do.
    pub(super) fn touching(&self) -> Option<[u32; 2]> {
        // The hash of a small mesh would cost more than the query.
        let registered = |view: &MeshView<'_>| view.registered().filter(|_| self.use_trees());
        let [mesh1, mesh2] = self.meshes.each_ref().map(registered);
        let pair = if let (Some(tree1), Some(tree2)) = (mesh1, mesh2) {
            search_trees(&[tree1, tree2], |trees, scratch| meeting(trees, self.placement, scratch))
        } else {
            self.bvhs().meeting()
        };
        Some(pair?.name())
    }

    /// Returns the nearest pair of triangles. Its distance is not negative.
    pub(super) fn nearest(&self, limit: f64) -> Option<Found> {
        let placement = self.placement;
        let pair = self.search(
            |trees, scratch| nearest(trees, placement, limit, scratch),
            |bvhs| bvhs.nearest(limit),
        )?;
        let found = Found::of_pair(&pair, &placement);
        Some(Found { distance: found.distance.max(0.0), ..found })
    }

    /// Returns the deepest pair of triangles or, where none cross, the nearest.
    pub(super) fn deepest(&self, limit: f64) -> Option<Found> {
        let placement = self.placement;
        let pair = self.search(
            |trees, scratch| deepest(trees, placement, limit, scratch),
            |bvhs| bvhs.deepest(limit),
        )?;
        Some(Found::of_pair(&pair, &placement))
    }

    pub(super) fn cast(&self, velocity12: Vector, options: CastOptions) -> Option<ShapeCastHit> {
        let placement = self.placement;
        let cast = first_minimum(
            &options,
            |counts| {
                self.search(
                    |trees, scratch| cast(trees, placement, velocity12, options, scratch, counts),
                    |bvhs| bvhs.cast(velocity12, options, counts),
                )
            },
            |cast| self.is_minimum(cast, velocity12),
            |distance| self.nearest(distance).is_some(),
        )?;
        // The hit wants the point of mesh 2 before the motion.
        let mut pair = cast.pair;
        pair.contact.point2 -= velocity12.as_dvec3() * cast.time;
        Some(Found::of_pair(&pair, &placement).hit(cast.time, status(cast.is_penetrating)))
    }

    /// Returns false if the surfaces are nearer to each other beside the points of an impact. A
    /// body that slides along a wall within the target distance comes to the next triangles of the
    /// wall all the time.
    fn is_minimum(&self, Cast { time, pair, .. }: &Cast, velocity: Vector) -> bool {
        let FoundPair { triangle1, triangle2, contact, origin, .. } = pair;
        let TriangleContact { normal, distance, features, point1, point2 } = *contact;
        let before = point2 - velocity.as_dvec3() * *time;
        let [mesh1, mesh2] = self.meshes.each_ref().map(|mesh| mesh.mesh);
        let place2 = self.placement.to_frame2(before, *origin);
        let normal2 = (self.placement.inverse * -normal).normalize_or_zero();
        features.is_crossing()
            || is_minimum(mesh1, *triangle1, origin.as_dvec3() + point1, (normal, distance))
                && is_minimum(mesh2, *triangle2, place2, (normal2, distance))
    }

    pub(super) fn cast_nonlinear(&self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = self.search(
            |trees, scratch| {
                let balls = [trees.0, trees.1].map(Tree::bounding_ball);
                cast.first_impact(&mut MeshBodies { trees, scratch }, balls)
            },
            |mut bvhs| {
                let balls = self.meshes.each_ref().map(|mesh| mesh.ball());
                cast.first_impact(&mut bvhs, balls)
            },
        )?;
        let pair = Found::of_pair(&found.pair, &found.placement);
        Some(cast.hit(found.time, &pair, found.has_converged))
    }
}
