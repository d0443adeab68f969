//! Casts of two meshes: along a line, and along the curves of rigid motions.

use parry3d::math::{Pose, Vector};
use parry3d::query::ShapeCastHit;
use parry3d::query::details::ShapeCastOptions;
use sbbk_core::query::{CastOptions, PartPair};
use sbbk_core::traverse::Placement;

use super::nonlinear::NonlinearCast;
use super::touch::{Touch, status};
use super::walk::MeshQuery;

impl MeshQuery<'_> {
    /// Returns the first impact of mesh 2, which moves by `velocity12` in the frame of mesh 1.
    pub(crate) fn cast(
        &self,
        pos12: &Pose,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let placement = Placement::new(pos12);
        let core_options = CastOptions {
            max_time: options.max_time_of_impact,
            target_distance: options.target_distance.max(0.0),
            stop_at_penetration: options.stop_at_penetration,
        };
        let cast = match self.trees() {
            Some(trees) => trees.cast(placement, velocity12, core_options),
            None => self.walk().cast(placement, velocity12, core_options),
        }?;
        // The hit wants the point of mesh 2 before the motion.
        let mut pair = cast.pair;
        pair.contact.point2 -= velocity12.as_dvec3() * cast.time;
        Some(Touch::of(&pair, &placement).hit(pair.name(), cast.time, status(cast.is_penetrating)))
    }

    /// Returns the first impact of two meshes in motion.
    pub(crate) fn cast_nonlinear(&self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = match self.trees() {
            Some(trees) => trees.cast_nonlinear(cast),
            None => {
                let balls = self.meshes.each_ref().map(|mesh| mesh.ball());
                cast.first_impact(&mut self.walk(), cast.options(balls), 0.0, Touch::of)
            }
        }?;
        Some(cast.hit(&found, &Touch::of(&found.pair, &found.placement)))
    }
}
