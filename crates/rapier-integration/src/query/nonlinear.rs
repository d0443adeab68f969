//! Casts along the curves of rigid motions: of two meshes, or of a mesh and a convex shape.

use glamx::{DMat3, DQuat, DVec3};
use parry3d::math::{Real, Vector};
use parry3d::query::{NonlinearRigidMotion, ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::{Advance, AdvanceOptions, Bodies, PartPair, advance, advance_from_contact};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::touch::Touch;

/// Bodies this close have met, as a share of the radius of the ball around the smaller one. Higher:
/// fewer steps, earlier impacts.
const TOLERANCE: f64 = 1.0e-6;

/// The same as a share of how far their centres are apart, for a body that is a point: poses are
/// hardly better.
const PRECISION: f64 = 1.0e-12;

/// Steps. Head-on motions take 10 to 30, turning ones up to some hundred.
const STEP_LIMIT: usize = 2000;

/// Into how many parts, at least and at most, the time is divided for looks at what touches at the
/// start and turns.
const LOOKS: (f64, f64) = (10.0, 100.0);

/// How far what touches at the start turns from look to look, in radians: a long body that is looked
/// at after each half turn, or two, always looks the same.
const TURN: f64 = 0.5;

/// What poses lose as their quaternions, rounded to f32, are not of unit length: points are up to this
/// share faster.
const STRETCH: f64 = 1.0e-6;

/// Two bodies on their ways: what is asked.
#[derive(Copy, Clone)]
pub(crate) struct NonlinearCast<'a> {
    pub(crate) motions: [&'a NonlinearRigidMotion; 2],
    pub(crate) start: Real,
    pub(crate) end: Real,
    pub(crate) stop_at_penetration: bool,
}

impl NonlinearCast<'_> {
    /// Where body 2 is in the frame of body 1.
    pub(super) fn placement_at(&self, time: f64) -> Placement {
        let [place1, place2] = self.motions.map(|motion| place(motion, time));
        place1.inverted().of(&place2)
    }

    /// For bodies in balls.
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

    /// The first impact; `touch` tells of a pair that is found where it touches, `thickness` is how
    /// far one body must sink into the other to come out behind it, as Parry has it.
    ///
    /// If contacts at the start are not to stop the cast, Parry asks of each triangle that touches
    /// then whether its velocity and that of the other body approach until the end by more than the
    /// thickness of both, and leaves it out if they do not. (Of a thick body that turns it goes on to
    /// look at some times between.) Here it is left out; what is convex is looked at again in
    /// `moving.rs`, meshes are not.
    pub(super) fn first_impact<B: Bodies>(
        &self,
        bodies: &mut B,
        options: AdvanceOptions,
        thickness: Real,
        touch: impl Fn(&B::Pair, &Placement) -> Touch,
    ) -> Option<Advance<B::Pair>> {
        let placement_at = |time| self.placement_at(time);
        if self.stop_at_penetration {
            return advance(bodies, placement_at, options);
        }
        advance_from_contact(bodies, placement_at, options, |pair, placement| {
            let length = options.tolerance + f64::from(thickness);
            self.approaches(&touch(pair, placement), options.start, length)
        })
    }

    /// An impact as Parry has it, with what is where the pair touches.
    pub(super) fn hit<P: PartPair>(&self, found: &Advance<P>, touch: &Touch) -> ShapeCastHit {
        let Advance { time, ref pair, has_converged, .. } = *found;
        let is_at_start = time == f64::from(self.start);
        let status = if !has_converged {
            ShapeCastStatus::OutOfIterations
        } else if is_at_start && self.stop_at_penetration {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        touch.hit(pair.name(), time, status)
    }

    /// No point of one body moves faster than this against the other.
    ///
    /// With `v` the velocity of centre 2 against centre 1, `w` the turning of a body and `r` how far
    /// its points are from its centre, that is at most `|v| + |w1| r1 + |w2| r2`. In the frame of body
    /// 1, all of which turns about centre 1, points of body 2 have `|v - w1 × c| + |w2 - w1| r2`, with
    /// `c` from centre 1 to centre 2; in that of body 2 likewise. As `c` is linear in time, each is
    /// greatest at the start or at the end. Each of these takes the reach of one body only: it stays
    /// finite if the other is a half-space that turns.
    fn speed_bound(&self, balls: [Sphere; 2]) -> f64 {
        let [motion1, motion2] = self.motions;
        let [reach1, reach2] = [0, 1].map(|i| self.reach(i, &balls[i]));
        let [turn1, turn2] = self.motions.map(|motion| motion.angvel.as_dvec3());
        let [from1, from2] = self.motions.map(centre);
        let velocity = motion2.linvel.as_dvec3() - motion1.linvel.as_dvec3();
        let seen = |turn: DVec3, reach: f64| {
            let fastest = [self.start, self.end].map(|time| {
                let between = from2 - from1 + moved(velocity, time.into());
                let turning = if turn == DVec3::ZERO { DVec3::ZERO } else { turn.cross(between) };
                (velocity - turning).length()
            });
            // Not `max`: at a time without end it is NaN, and so is the sum.
            let [start, end] = fastest;
            (if end <= start { start } else { end }) + turned(turn2 - turn1, reach)
        };
        // Of numbers and NaN the numbers.
        let in_space = velocity.length() + turned(turn1, reach1) + turned(turn2, reach2);
        let least = in_space.min(seen(turn1, reach2)).min(seen(turn2, reach1));
        least * (1.0 + STRETCH)
    }

    /// How far a ball around a body reaches from the centre of its motion.
    pub(super) fn reach(&self, body: usize, ball: &Sphere) -> f64 {
        let centre = self.motions[body].local_center - ball.centre;
        centre.as_dvec3().length() + f64::from(ball.radius)
    }

    /// Bound on the speed at which points of two bodies approach along a unit vector of space that
    /// points from the first to the second.
    ///
    /// A point at `r` from the centre of its motion has the velocity `w × r` against it, of which
    /// `a·(w × r) = r·(a × w)` is along `a`; `r` turns, but is as long as before.
    pub(super) fn approach_bound(
        &self,
        [one, two]: [&NonlinearRigidMotion; 2],
        axis: DVec3,
        reaches: [f64; 2],
    ) -> f64 {
        let linear = (one.linvel.as_dvec3() - two.linvel.as_dvec3()).dot(axis);
        let turns = [one, two].map(|motion| axis.cross(motion.angvel.as_dvec3()));
        let least = linear + turned(turns[0], reaches[0]) + turned(turns[1], reaches[1]);
        least.max(0.0) * (1.0 + STRETCH)
    }

    /// Whether points of two bodies, with the velocities of a time, approach by more than a length
    /// until the end.
    pub(super) fn approaches(&self, touch: &Touch, time: f64, length: f64) -> bool {
        let rotations = self.motions.map(|motion| place(motion, time).rotation);
        let [velocity1, velocity2] = [0, 1].map(|i| {
            let motion = self.motions[i];
            let arm = rotations[i] * (touch.points[i] - motion.local_center).as_dvec3();
            motion.linvel.as_dvec3() + motion.angvel.as_dvec3().cross(arm)
        });
        let normal: DVec3 = rotations[0] * touch.normals[0].as_dvec3();
        (velocity1 - velocity2).dot(normal) * (f64::from(self.end) - time) > length
    }

    /// Times at which to look at a body again that touches at the start and turns: between two of them
    /// it travels no more than its thickness and turns no more than [`TURN`], or both by a hundredth of
    /// the way. None if it does not turn, or has no thickness.
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

/// How fast what turns moves, even if it has no end.
pub(super) fn turned(turn: DVec3, reach: f64) -> f64 {
    if turn == DVec3::ZERO { 0.0 } else { turn.length() * reach }
}

/// How far what moves comes, even in a time without end.
fn moved(velocity: DVec3, time: f64) -> DVec3 {
    if velocity == DVec3::ZERO { DVec3::ZERO } else { velocity * time }
}

/// The centre of a motion at its beginning.
fn centre(motion: &NonlinearRigidMotion) -> DVec3 {
    Placement::new(&motion.start).to_frame1(motion.local_center, Vector::ZERO)
}

/// Where a motion takes a body, in f64: Parry's `position_at_time` rounds.
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
