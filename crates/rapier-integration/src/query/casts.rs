//! Casts of two meshes: along a line, and along the curves of rigid motions.

use parry3d::math::{Pose, Vector};
use parry3d::query::ShapeCastHit;
use parry3d::query::details::ShapeCastOptions;
use sbbk_core::query::{Cast, CastOptions, FoundPair, MeshBodies, PartPair, cast};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

use super::lookup::{MeshQuery, Trees};
use super::nonlinear::NonlinearCast;
use super::touch::{Touch, status};

impl MeshQuery<'_> {
    /// As [`Trees::cast`]; `None` if a mesh has no tree, and Parry must answer.
    pub(crate) fn cast(
        &self,
        pos12: &Pose,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<Option<ShapeCastHit>> {
        Some(self.trees()?.cast(pos12, velocity12, options))
    }

    /// As [`Trees::cast_nonlinear`]; `None` if a mesh has no tree, and Parry must answer.
    pub(crate) fn cast_nonlinear(&self, cast: &NonlinearCast<'_>) -> Option<Option<ShapeCastHit>> {
        Some(self.trees()?.cast_nonlinear(cast))
    }
}

impl Trees {
    /// The first impact of mesh 2, moving by `velocity12` in the frame of mesh 1.
    fn cast(
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
        let cast: Cast =
            self.search(|scratch| cast(self.both(), placement, velocity12, core_options, scratch))?;
        // Where the point of mesh 2 was before it moved.
        let mut pair = cast.pair;
        pair.contact.point2 -= velocity12.as_dvec3() * cast.time;
        Some(touch(&pair, &placement).hit(pair.name(), cast.time, status(cast.is_penetrating)))
    }

    /// The first impact of two meshes on their ways.
    fn cast_nonlinear(&self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let trees = self.both();
        let balls = [trees.0, trees.1].map(Tree::bounding_ball);
        let found = self.search(|scratch| {
            let meshes = &mut MeshBodies { trees, scratch };
            cast.first_impact(meshes, cast.options(balls), 0.0, touch)
        })?;
        Some(cast.hit(&found, &touch(&found.pair, &found.placement)))
    }
}

/// Where two triangles touch.
pub(super) fn touch(pair: &FoundPair, placement: &Placement) -> Touch {
    Touch {
        points: [pair.point1(), pair.point2(placement)],
        normals: [pair.normal1(), pair.normal2(placement)],
    }
}
