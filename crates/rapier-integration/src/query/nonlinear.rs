//! Casts of two meshes, or of a mesh and a convex shape, along the curves of rigid motions.

use glamx::{DMat3, DQuat, DVec3};
use parry3d::math::{Real, Vector};
use parry3d::query::{NonlinearRigidMotion, ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::{Advance, AdvanceOptions, Bodies, FoundPair, advance, advance_from_contact};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::Found;
use crate::pair::STRETCH;

/// Distance at which bodies have met, as a share of the radius of the smaller body. Higher: fewer
/// steps, earlier impacts; lower: more steps.
const TOLERANCE: f64 = 1.0e-6;

/// Distance at which bodies have met, as a share of the distance of their centres: the rounding of
/// poses. It serves bodies that are points.
const PRECISION: f64 = 1.0e-12;

/// Steps at most. Higher: exact times of motions that nearly touch; lower: a bound on their cost.
const STEP_LIMIT: usize = 2000;

/// Least and greatest number of samples of a rotating body that touches at the start.
const LOOKS: (f64, f64) = (10.0, 100.0);

/// Rotation between two samples, in radians. Higher: a long body may look the same in each sample;
/// lower: more samples.
const TURN: f64 = 0.5;

/// A cast of two bodies in motion.
#[derive(Copy, Clone)]
pub(crate) struct NonlinearCast<'a> {
    pub(crate) motions: [&'a NonlinearRigidMotion; 2],
    pub(crate) start: Real,
    pub(crate) end: Real,
    pub(crate) stop_at_penetration: bool,
}

impl NonlinearCast<'_> {
    /// Returns the placement of the bodies at a time.
    pub(super) fn placement_at(&self, time: f64) -> Placement {
        let [place1, place2] = self.motions.map(|motion| place(motion, time));
        place1.inverted().of(&place2)
    }

    /// Returns the options of the search, given balls around the bodies.
    pub(super) fn options(&self, balls: [Sphere; 2]) -> AdvanceOptions {
        let [size1, size2] = balls.map(|ball| f64::from(ball.radius));
        let [from1, from2] = self.motions.map(centre);
        AdvanceOptions {
            start: self.start.into(),
            end: self.end.into(),
            speed_bound: self.speed_bound(balls),
            tolerance: (TOLERANCE * size1.min(size2)).max(PRECISION * from1.distance(from2)),
            step_limit: STEP_LIMIT,
        }
    }

    /// Returns the first impact of two meshes, given balls around them.
    ///
    /// Casts that do not stop at penetration skip pairs that touch at the start and part. Parry
    /// does the same.
    pub(super) fn first_impact(
        &self,
        bodies: &mut impl Bodies<Pair = FoundPair>,
        balls: [Sphere; 2],
    ) -> Option<Advance<FoundPair>> {
        let options = self.options(balls);
        let [start, end] = self.meeting_of_balls(balls, &options)?;
        let options = AdvanceOptions { start, end, ..options };
        let placement_at = |time| self.placement_at(time);
        if self.stop_at_penetration || start > f64::from(self.start) {
            return advance(bodies, &[], placement_at, options);
        }
        advance_from_contact(bodies, placement_at, options, |pair, placement| {
            self.approaches(&Found::of_pair(pair, placement), options.start, options.tolerance)
        })
    }

    /// Returns the first and last time at which balls overlap that hold the bodies however these
    /// turn; `None` if they never do.
    ///
    /// The centres of motions move in straight lines. With `c` and `v` from centre 1 to centre 2,
    /// the times solve `|c + v t| = R`. Here `R` is the sum of the radii.
    pub(super) fn meeting_of_balls(
        &self,
        balls: [Sphere; 2],
        options: &AdvanceOptions,
    ) -> Option<[f64; 2]> {
        let [lever1, lever2] = [0, 1].map(|i| lever(self.motions[i], &balls[i]));
        let [from1, from2] = self.motions.map(centre);
        let [velocity1, velocity2] = self.motions.map(|motion| motion.linvel.as_dvec3());
        let (between, velocity) = (from2 - from1, velocity2 - velocity1);
        let radius = (lever1 + lever2) * (1.0 + STRETCH) + options.tolerance;
        let speed2 = velocity.length_squared();
        let square = radius * radius * speed2 - between.cross(velocity).length_squared();
        if square < 0.0 || speed2 == 0.0 && between.length() > radius {
            return None;
        }
        let (middle, half) = (-between.dot(velocity) / speed2, square.sqrt() / speed2);
        // A number that is not finite bounds nothing: `max` and `min` drop NaN.
        let [start, end] = [options.start.max(middle - half), options.end.min(middle + half)];
        let is_empty = start > end && options.start <= options.end;
        (!is_empty).then_some([start, end])
    }

    /// Returns the hit of an impact.
    pub(super) fn hit(&self, time: f64, found: &Found, has_converged: bool) -> ShapeCastHit {
        let is_at_start = time == f64::from(self.start);
        let status = if !has_converged {
            ShapeCastStatus::OutOfIterations
        } else if is_at_start && self.stop_at_penetration {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        found.hit(time, status)
    }

    /// Returns a bound on the speed of points of one body against the other.
    ///
    /// Let `v` be the velocity of centre 2 against centre 1, `w` the angular velocity of a body,
    /// and `r` its lever. Then `|v| + |w1| r1 + |w2| r2` is a bound. In the frame of body 1 another
    /// bound is `|v - w1 × c| + |w2 - w1| r2`, with `c` from centre 1 to centre 2. The vector `c`
    /// is linear in time, so this bound is greatest at the start or at the end. It does not depend
    /// on the lever of body 1, so it is finite for a half-space that turns. A third bound swaps the
    /// bodies.
    fn speed_bound(&self, balls: [Sphere; 2]) -> f64 {
        let [motion1, motion2] = self.motions;
        let [lever1, lever2] = [0, 1].map(|i| lever(self.motions[i], &balls[i]));
        let [turn1, turn2] = self.motions.map(|motion| motion.angvel.as_dvec3());
        let [from1, from2] = self.motions.map(centre);
        let velocity = motion2.linvel.as_dvec3() - motion1.linvel.as_dvec3();
        let seen = |turn: DVec3, lever: f64| {
            let fastest = [self.start, self.end].map(|time| {
                let between = from2 - from1 + moved(velocity, time.into());
                let turning = if turn == DVec3::ZERO { DVec3::ZERO } else { turn.cross(between) };
                (velocity - turning).length()
            });
            // `max` would drop the NaN of an infinite time.
            let [start, end] = fastest;
            (if end <= start { start } else { end }) + turned(turn2 - turn1, lever)
        };
        // `min` drops NaN.
        let in_space = velocity.length() + turned(turn1, lever1) + turned(turn2, lever2);
        let least = in_space.min(seen(turn1, lever2)).min(seen(turn2, lever1));
        least * (1.0 + STRETCH)
    }

    /// True if the points of a contact, at their velocities of a time, approach by more than a
    /// length until the end.
    pub(super) fn approaches(&self, found: &Found, time: f64, length: f64) -> bool {
        let rotations = self.motions.map(|motion| place(motion, time).rotation);
        let [velocity1, velocity2] = [0, 1].map(|i| {
            let motion = self.motions[i];
            let arm = rotations[i] * (found.points[i] - motion.local_center).as_dvec3();
            motion.linvel.as_dvec3() + motion.angvel.as_dvec3().cross(arm)
        });
        let normal: DVec3 = rotations[0] * found.normals[0].as_dvec3();
        (velocity1 - velocity2).dot(normal) * (f64::from(self.end) - time) > length
    }

    /// Returns sample times for a rotating body that touches at the start. Between samples it moves
    /// by at most its thickness and turns by at most [`TURN`], unless that takes too many samples.
    /// A body without thickness or rotation has no samples.
    pub(super) fn looks(&self, thickness: Real) -> impl Iterator<Item = f64> {
        let [motion1, motion2] = self.motions;
        let is_needed = thickness > 0.0 && motion1.angvel != motion2.angvel;
        let (start, span) = (f64::from(self.start), f64::from(self.end - self.start));
        let travel = span * f64::from((motion2.linvel - motion1.linvel).length());
        let turn = span * (motion2.angvel - motion1.angvel).as_dvec3().length() / TURN;
        let count = (travel / f64::from(thickness)).max(turn).clamp(LOOKS.0, LOOKS.1).ceil();
        let count = if is_needed { count as u32 } else { 0 };
        (1..count).map(move |look| start + span * f64::from(look) / f64::from(count))
    }
}

/// Returns the greatest distance of a ball around a body from the centre of its motion.
pub(super) fn lever(motion: &NonlinearRigidMotion, ball: &Sphere) -> f64 {
    (motion.local_center - ball.centre).as_dvec3().length() + f64::from(ball.radius)
}

/// Returns `|turn| * lever`, which is 0 for no turn even if the lever is infinite.
pub(super) fn turned(turn: DVec3, lever: f64) -> f64 {
    if turn == DVec3::ZERO { 0.0 } else { turn.length() * lever }
}

/// Returns `velocity * time`, which is 0 for no velocity even if the time is infinite.
fn moved(velocity: DVec3, time: f64) -> DVec3 {
    if velocity == DVec3::ZERO { DVec3::ZERO } else { velocity * time }
}

/// The centre of a motion at its beginning.
fn centre(motion: &NonlinearRigidMotion) -> DVec3 {
    Placement::new(&motion.start).to_frame1(motion.local_center, Vector::ZERO)
}

/// Returns the pose of a body at a time, in f64. Parry's `position_at_time` uses f32.
pub(super) fn place(motion: &NonlinearRigidMotion, time: f64) -> Placement {
    if motion.angvel == Vector::ZERO {
        let mut place = Placement::new(&motion.start);
        place.translation += moved(motion.linvel.as_dvec3(), time);
        return place;
    }
    let turn = DQuat::from_scaled_axis(motion.angvel.as_dvec3() * time);
    let turn = Placement {
        rotation: DMat3::from_quat(turn),
        translation: DVec3::ZERO,
        inverse: DMat3::from_quat(turn.inverse()),
    };
    let start = Placement::new(&motion.start);
    let centre = centre(motion);
    let from_centre = Placement { translation: start.translation - centre, ..start };
    let mut place = turn.of(&from_centre);
    place.translation += centre + motion.linvel.as_dvec3() * time;
    place
}
