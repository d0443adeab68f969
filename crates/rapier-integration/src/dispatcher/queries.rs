//! Queries without manifolds.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher,
    ShapeCastHit, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d::shape::Shape;

use super::{SbbkDispatcher, rigid_mesh};
use crate::mesh::{TwoMeshes, is_near};
use crate::pair::{ConvexSearch, ConvexShape, MeshPlace};
use crate::query::{MeshQuery, NonlinearCast, Query};

impl SbbkDispatcher {
    /// Calls `then` for two rigid meshes, or a mesh and a convex shape, and counts the search.
    /// Returns `None` if Parry must answer. `apart` holds a distance, and the result for shapes
    /// whose boxes are farther apart. `takes_balls`: true if SBBK answers for balls.
    fn search<T>(
        &self,
        pos12: &Pose,
        [g1, g2]: [&dyn Shape; 2],
        takes_balls: bool,
        apart: Option<(Real, T)>,
        then: impl FnOnce(Query<'_>) -> T,
    ) -> Option<T> {
        let answer = |answer| {
            self.store.counters.searches.raise();
            Some(answer)
        };
        let (mesh, other, mesh_place) = match [g1, g2].map(rigid_mesh) {
            [Some(mesh1), Some(mesh2)] => {
                let meshes = self.config.kinds.meshes.then_some([mesh1, mesh2])?;
                // Before all else: most pairs that a host asks about are apart.
                if let Some((distance, apart)) = apart
                    && TwoMeshes::new(meshes, pos12).are_apart(distance)
                {
                    return answer(apart);
                }
                let views = [self.view(mesh1)?, self.view(mesh2)?];
                return answer(then(Query::Meshes(MeshQuery::new(views, pos12))));
            }
            [Some(mesh), None] => (mesh, g2, MeshPlace::First),
            [None, Some(mesh)] => (mesh, g1, MeshPlace::Second),
            [None, None] => return None,
        };
        let convex = ConvexShape::of(other)?;
        let is_parrys = !takes_balls && matches!(convex, ConvexShape::Ball(_));
        if !self.config.kinds.convex_shapes || is_parrys {
            return None;
        }
        if let Some((distance, apart)) = apart
            && !is_near(mesh, other, &mesh_place.shape_in_mesh(pos12), distance)
        {
            return answer(apart);
        }
        let search = ConvexSearch::new(self.view(mesh)?, other, convex, mesh_place, pos12);
        answer(then(Query::Convex(search)))
    }
}

/// Queries of two rigid meshes, and of a rigid mesh and a convex shape. All others go to Parry.
impl QueryDispatcher for SbbkDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        let apart = Some((0.0, ShapeIntersection::new(false)));
        let found = self.search(pos12, [g1, g2], false, apart, |query| query.intersection());
        found.map_or_else(|| DefaultQueryDispatcher.intersection_test(pos12, g1, g2), Ok)
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        let found = self.search(pos12, [g1, g2], false, None, |query| query.distance());
        found.map_or_else(|| DefaultQueryDispatcher.distance(pos12, g1, g2), Ok)
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let (shapes, apart) = ([g1, g2], Some((prediction, None)));
        let ask = |query: Query<'_>| query.contact(prediction);
        let found = self.search(pos12, shapes, false, apart, ask);
        found.map_or_else(|| DefaultQueryDispatcher.contact(pos12, g1, g2, prediction), Ok)
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        let (shapes, apart) = ([g1, g2], Some((max_dist, ClosestPoints::Disjoint)));
        let ask = |query: Query<'_>| query.closest_points(max_dist);
        let found = self.search(pos12, shapes, false, apart, ask);
        found.map_or_else(|| DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist), Ok)
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let found =
            self.search(pos12, [g1, g2], true, None, |query| query.cast(local_vel12, options));
        found.map_or_else(
            || DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options),
            Ok,
        )
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let motions = [motion1, motion2];
        let cast =
            &NonlinearCast { motions, start: start_time, end: end_time, stop_at_penetration };
        let [pos1, pos2] = motions.map(|motion| motion.position_at_time(start_time));
        let found = self
            .search(&pos1.inv_mul(&pos2), [g1, g2], true, None, |query| query.cast_nonlinear(cast));
        found.map_or_else(
            || {
                DefaultQueryDispatcher.cast_shapes_nonlinear(
                    motion1,
                    g1,
                    motion2,
                    g2,
                    start_time,
                    end_time,
                    stop_at_penetration,
                )
            },
            Ok,
        )
    }
}
