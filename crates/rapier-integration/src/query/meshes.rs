//! Two meshes.

use parry3d::math::{Pose, Vector};
use parry3d::query::ShapeCastHit;
use parry3d::query::details::ShapeCastOptions;
use sbbk_core::contact::TriangleContact;
use sbbk_core::query::{
    Cast, CastOptions, FoundPair, MeshBodies, PartPair, SearchScratch, cast, deepest, meeting,
    nearest,
};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

use super::found::{Found, status};
use super::nonlinear::NonlinearCast;
use super::trees::Trees;
use super::walk::Walk;
use crate::mesh::{MeshView, is_minimum};

/// Two rigid meshes of a query.
pub(crate) struct MeshQuery<'a> {
    meshes: [MeshView<'a>; 2],
    placement: Placement,
}

impl<'a> MeshQuery<'a> {
    pub(crate) fn new(meshes: [MeshView<'a>; 2], pos12: &Pose) -> Self {
        Self { meshes, placement: Placement::new(pos12) }
    }

    /// Searches by trees, or by BVHs if a mesh has none.
    fn search<T>(
        &self,
        by_trees: impl FnOnce((&Tree, &Tree), &mut SearchScratch) -> T,
        by_walk: impl FnOnce(Walk<'_>) -> T,
    ) -> T {
        let meshes = self.meshes.each_ref();
        Trees::of(meshes).map_or_else(|| by_walk(Walk(meshes)), |trees| trees.search(by_trees))
    }

    /// Returns triangles that touch, if any do.
    pub(super) fn touching(&self) -> Option<[u32; 2]> {
        let (meshes, placement) = (self.meshes.each_ref(), self.placement);
        // Hashes of small meshes would take longer than most of these queries.
        let pair = match Trees::of_registered(meshes) {
            Some(trees) => trees.search(|trees, scratch| meeting(trees, placement, scratch)),
            None => Walk(meshes).meeting(placement),
        };
        Some(pair?.name())
    }

    /// Returns the nearest pair of triangles. Its distance is not negative.
    pub(super) fn nearest(&self, limit: f64) -> Option<Found> {
        let placement = self.placement;
        let pair = self.search(
            |trees, scratch| nearest(trees, placement, limit, scratch),
            |walk| walk.nearest(placement, limit),
        )?;
        let found = Found::of_pair(&pair, &placement);
        Some(Found { distance: found.distance.max(0.0), ..found })
    }

    /// Returns the deepest pair of triangles or, where none cross, the nearest.
    pub(super) fn deepest(&self, limit: f64) -> Option<Found> {
        let placement = self.placement;
        let pair = self.search(
            |trees, scratch| deepest(trees, placement, limit, scratch),
            |walk| walk.deepest(placement, limit),
        )?;
        Some(Found::of_pair(&pair, &placement))
    }

    pub(super) fn cast(
        &self,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let placement = self.placement;
        let options = CastOptions {
            max_time: options.max_time_of_impact,
            target_distance: options.target_distance.max(0.0),
            stop_at_penetration: options.stop_at_penetration,
        };
        let may_slide = !options.stop_at_penetration && options.target_distance > 0.0;
        let counts = |cast: &Cast| !may_slide || self.is_minimum(cast, velocity12);
        let cast = self.search(
            |trees, scratch| cast(trees, placement, velocity12, options, scratch, counts),
            |walk| walk.cast(placement, velocity12, options, counts),
        )?;
        // The hit wants the point of mesh 2 before the motion.
        let mut pair = cast.pair;
        pair.contact.point2 -= velocity12.as_dvec3() * cast.time;
        Some(Found::of_pair(&pair, &placement).hit(cast.time, status(cast.is_penetrating)))
    }

    /// Returns false if the surfaces are nearer to each other beside the points of an impact. A body that slides along a
    /// wall within the target distance comes to the next triangles of the wall all the time.
    fn is_minimum(&self, Cast { time, pair, .. }: &Cast, velocity: Vector) -> bool {
        let FoundPair { triangle1, triangle2, contact, origin, .. } = pair;
        let TriangleContact { normal, features, point1, point2, .. } = *contact;
        let before = point2 - velocity.as_dvec3() * *time;
        let [mesh1, mesh2] = self.meshes.each_ref().map(|mesh| mesh.mesh);
        let place2 = self.placement.to_frame2(before, *origin);
        let normal2 = (self.placement.inverse * -normal).normalize_or_zero();
        features.is_crossing()
            || is_minimum(mesh1, *triangle1, origin.as_dvec3() + point1, normal)
                && is_minimum(mesh2, *triangle2, place2, normal2)
    }

    pub(super) fn cast_nonlinear(&self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = self.search(
            |trees, scratch| {
                let balls = [trees.0, trees.1].map(Tree::bounding_ball);
                cast.first_impact(&mut MeshBodies { trees, scratch }, balls)
            },
            |mut walk| {
                let balls = self.meshes.each_ref().map(|mesh| mesh.ball());
                cast.first_impact(&mut walk, balls)
            },
        )?;
        let pair = Found::of_pair(&found.pair, &found.placement);
        Some(cast.hit(found.time, &pair, found.has_converged))
    }
}
