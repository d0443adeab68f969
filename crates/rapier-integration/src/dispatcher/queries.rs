//! Queries without manifolds.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher,
    ShapeCastHit, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d::shape::{Shape, TriMesh};

use super::{SbbkDispatcher, rigid_mesh};
use crate::mesh::{are_near, is_near};
use crate::pair::{ConvexPair, ConvexSearch, MeshPlace, PairPose, Parts};
use crate::query::{ConvexQuery, MeshQuery, NonlinearCast};

impl SbbkDispatcher {
    /// Returns what [`find`](Self::find) does, and counts it.
    fn search<T>(
        &self,
        pos12: &Pose,
        shapes: [&dyn Shape; 2],
        balls: Balls,
        apart: Option<(Real, T)>,
        of_meshes: impl FnOnce(MeshQuery<'_>) -> T,
        of_convex: impl FnOnce(ConvexQuery<'_>) -> T,
    ) -> Option<T> {
        let found = self.find(pos12, shapes, balls, apart, of_meshes, of_convex);
        if found.is_some() {
            self.counters.add_search();
        }
        found
    }

    /// Calls `of_meshes` for two rigid meshes, or `of_convex` for a mesh and a convex shape. Returns
    /// `None` if Parry must answer. `apart` holds a distance, and the result for shapes whose boxes are
    /// farther apart. `balls` selects who handles balls.
    fn find<T>(
        &self,
        pos12: &Pose,
        [g1, g2]: [&dyn Shape; 2],
        balls: Balls,
        apart: Option<(Real, T)>,
        of_meshes: impl FnOnce(MeshQuery<'_>) -> T,
        of_convex: impl FnOnce(ConvexQuery<'_>) -> T,
    ) -> Option<T> {
        let (mesh, other, mesh_place) = match [g1, g2].map(rigid_mesh) {
            [Some(mesh1), Some(mesh2)] => {
                let meshes = [mesh1, mesh2];
                let is_answered = self.config.kinds.meshes;
                // Before all else: most pairs that a host asks about are apart.
                return match apart.filter(|_| is_answered) {
                    Some((distance, apart)) if !are_near(meshes, pos12, distance) => Some(apart),
                    _ => self.mesh_query(meshes).map(of_meshes),
                };
            }
            [Some(mesh), None] => (mesh, g2, MeshPlace::First),
            [None, Some(mesh)] => (mesh, g1, MeshPlace::Second),
            [None, None] => return None,
        };
        let is_parrys = balls == Balls::Parrys && other.as_ball().is_some();
        if !self.config.kinds.convex_shapes || is_parrys || !other.is_convex() {
            return None;
        }
        if let Some((distance, apart)) = apart {
            let in_mesh = mesh_place.shape_in_mesh(pos12);
            if !is_near(mesh, other, &in_mesh, distance) {
                return Some(apart);
            }
        }
        let parts = Parts::of(other).filter(|parts| matches!(parts, Parts::One(_)))?;
        let [mesh] = self.view([mesh])?;
        let pose = &PairPose::new(pos12, 0.0);
        let pair = ConvexPair {
            pose,
            mesh,
            parts,
            mesh_place,
            has_surfaces: false,
            leave_solids: false,
            has_patches: false,
        };
        Some(of_convex(ConvexQuery { search: ConvexSearch::new(&pair, other)?, mesh_place }))
    }

    /// Returns `None` if Parry must answer.
    fn mesh_query<'a>(&'a self, meshes: [&'a TriMesh; 2]) -> Option<MeshQuery<'a>> {
        let meshes = self.config.kinds.meshes.then(|| self.view(meshes))??;
        Some(MeshQuery { meshes })
    }
}

/// Who answers queries without manifolds about a ball.
#[derive(PartialEq)]
enum Balls {
    /// SBBK, as for other convex shapes.
    Ours,
    /// Parry: exactly, in less time, and inside a mesh with pseudo-normals a ball meets it.
    Parrys,
}

/// Queries of two rigid meshes, and of a rigid mesh and a convex shape. All others go to Parry.
impl QueryDispatcher for SbbkDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((0.0, ShapeIntersection::new(false))),
            |meshes| meshes.intersection(pos12),
            |pair| pair.intersection(),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.intersection_test(pos12, g1, g2),
        }
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            None,
            |meshes| meshes.distance(pos12),
            |pair| pair.distance(),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.distance(pos12, g1, g2),
        }
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((prediction, None)),
            |meshes| meshes.contact(pos12, prediction),
            |pair| pair.contact(prediction),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.contact(pos12, g1, g2, prediction),
        }
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((max_dist, ClosestPoints::Disjoint)),
            |meshes| meshes.closest_points(pos12, max_dist),
            |pair| pair.closest_points(max_dist),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist),
        }
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Ours,
            None,
            |meshes| meshes.cast(pos12, local_vel12, options),
            |pair| pair.cast(local_vel12, options),
        );
        match found {
            Some(hit) => Ok(hit),
            None => DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options),
        }
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
        let found = self.search(
            &pos1.inv_mul(&pos2),
            [g1, g2],
            Balls::Ours,
            None,
            |meshes| meshes.cast_nonlinear(cast),
            |pair| pair.cast_nonlinear(cast),
        );
        match found {
            Some(hit) => Ok(hit),
            None => DefaultQueryDispatcher.cast_shapes_nonlinear(
                motion1,
                g1,
                motion2,
                g2,
                start_time,
                end_time,
                stop_at_penetration,
            ),
        }
    }
}
