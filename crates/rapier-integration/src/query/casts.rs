//! Shape casts: along a line, and along the curves of rigid motions.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{NonlinearRigidMotion, ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::{
    Advance, AdvanceOptions, Cast, CastOptions, FoundPair, advance, advance_from_contact, cast,
};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

use super::lookup::{MeshQuery, Trees};

/// Meshes this close have met, for a nonlinear cast, as a share of their size. Poses along a motion
/// are computed in f32 and no better than that. Higher: fewer steps, earlier impacts.
const TOLERANCE: f64 = 1.0e-6;

/// Steps of a nonlinear cast. Head-on motions take 10 to 30, turning ones up to some hundred.
const STEP_LIMIT: usize = 2000;

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
    pub(crate) fn cast_nonlinear(
        &self,
        motions: [&NonlinearRigidMotion; 2],
        times: (Real, Real),
        stop_at_penetration: bool,
    ) -> Option<Option<ShapeCastHit>> {
        Some(self.trees()?.cast_nonlinear(motions, times, stop_at_penetration))
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
        let status = if cast.is_penetrating {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        // Where the point of mesh 2 was before it moved.
        let mut pair = cast.pair;
        pair.contact.point2 -= velocity12.as_dvec3() * cast.time;
        Some(hit(&pair, &placement, cast.time, status))
    }

    /// The first impact of two meshes on their ways.
    ///
    /// If contacts at the start are not to stop the cast, Parry asks of each pair of triangles that
    /// touches then whether its velocities approach, and leaves it out for good if they do not.
    /// (For thicker shapes it goes on to look at times between; the thickness of a triangle is
    /// zero.) Here too; "approach" is to come closer, until the end, by more than the tolerance.
    fn cast_nonlinear(
        &self,
        [motion1, motion2]: [&NonlinearRigidMotion; 2],
        (start, end): (Real, Real),
        stop_at_penetration: bool,
    ) -> Option<ShapeCastHit> {
        let (tree1, tree2) = self.both();
        let placement_at = |time: f64| {
            let [pos1, pos2] =
                [motion1, motion2].map(|motion| motion.position_at_time(time as Real));
            Placement::new(&pos1.inv_mul(&pos2))
        };
        let size = tree1.bounding_ball().radius.min(tree2.bounding_ball().radius);
        let linear = (motion2.linvel - motion1.linvel).as_dvec3().length();
        let options = AdvanceOptions {
            start: f64::from(start),
            end: f64::from(end),
            speed_bound: linear + turning_speed(motion1, tree1) + turning_speed(motion2, tree2),
            tolerance: TOLERANCE * f64::from(size),
            step_limit: STEP_LIMIT,
        };
        let trees = (tree1, tree2);
        let found = self.search(|scratch| {
            if stop_at_penetration {
                return advance(trees, placement_at, options, scratch);
            }
            let approaches = |pair: &FoundPair, placement: &Placement| {
                let speed = approach_speed([motion1, motion2], start, pair, placement);
                speed * (options.end - options.start) > options.tolerance
            };
            advance_from_contact(trees, placement_at, options, approaches, scratch)
        });
        let Advance { time, pair, placement, has_converged } = found?;
        let is_at_start = time == f64::from(start);
        let status = if !has_converged {
            ShapeCastStatus::OutOfIterations
        } else if is_at_start && stop_at_penetration {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        Some(hit(&pair, &placement, time, status))
    }
}

fn hit(
    pair: &FoundPair,
    placement: &Placement,
    time: f64,
    status: ShapeCastStatus,
) -> ShapeCastHit {
    ShapeCastHit {
        time_of_impact: time as Real,
        witness1: pair.point1(),
        witness2: pair.point2(placement),
        normal1: pair.normal1(),
        normal2: pair.normal2(placement),
        status,
        subshape1: pair.triangle1,
        subshape2: pair.triangle2,
    }
}

/// How fast the turning of a motion moves any point of a mesh, at most.
fn turning_speed(motion: &NonlinearRigidMotion, tree: &Tree) -> f64 {
    let ball = tree.bounding_ball();
    let reach = (motion.local_center - ball.centre).as_dvec3().length() + f64::from(ball.radius);
    motion.angvel.as_dvec3().length() * reach
}

/// How fast two triangles approach along the normal of their contact, at a time of their motions.
fn approach_speed(
    [motion1, motion2]: [&NonlinearRigidMotion; 2],
    time: Real,
    pair: &FoundPair,
    placement: &Placement,
) -> f64 {
    let rotation = |motion: &NonlinearRigidMotion| motion.position_at_time(time).rotation;
    let velocity = |motion: &NonlinearRigidMotion, point: Vector| {
        let arm = rotation(motion) * (point - motion.local_center);
        motion.linvel + motion.angvel.cross(arm)
    };
    let relative = velocity(motion2, pair.point2(placement)) - velocity(motion1, pair.point1());
    -f64::from(relative.dot(rotation(motion1) * pair.normal1()))
}
