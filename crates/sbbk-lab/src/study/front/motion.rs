//! Poses of a pair, step by step.

use glamx::{Pose3, Quat};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use serde::Serialize;

use super::super::contacts::{FAST, Place, SLOW, motion};
use crate::scene::random;

/// Steps of one motion, after its first query.
pub const STEP_COUNT: usize = 48;
/// Greatest shift of a resting pair from its place, and greatest way of a point one unit from its centre by turning, in
/// prediction distances: what the solver leaves of a body at rest.
const JITTER: Real = 0.02;
/// Turning of a tumbling pair, in radians a step: a bit less than a turn a second at 60 steps a second.
const TUMBLING: Real = 0.08;

/// How a pair moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum FrontMotion {
    /// It slides and turns through the place, [`SLOW`] prediction distances a step.
    Slow,
    /// The same, [`FAST`] prediction distances a step.
    Fast,
    /// It stays at the place, but for a shift and turn at random at each step.
    Resting,
    /// It turns on the spot, about a random axis.
    Tumbling,
}

impl FrontMotion {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Slow, Self::Fast, Self::Resting, Self::Tumbling];

    /// The poses of one motion.
    pub(super) fn poses(
        self,
        shape: &SharedShape,
        place: &Place,
        prediction: Real,
        random: &mut Rand32,
    ) -> Vec<Pose3> {
        let Place { pos12, .. } = *place;
        match self {
            Self::Slow => motion(shape, place, SLOW * prediction, STEP_COUNT),
            Self::Fast => motion(shape, place, FAST * prediction, STEP_COUNT),
            Self::Resting => {
                let size = JITTER * prediction;
                let mut jitter = || (2.0 * random.rand_float() - 1.0) * size;
                let mut pose = || {
                    let [shift, turn] = [(); 2].map(|()| [(); 3].map(|()| jitter()));
                    let turn = Quat::from_scaled_axis(turn.into());
                    Pose3::from_parts(
                        pos12.translation + glamx::Vec3::from(shift),
                        turn * pos12.rotation,
                    )
                };
                (0..=STEP_COUNT).map(|_| pose()).collect()
            }
            Self::Tumbling => {
                let axis = random::direction(random);
                let turned = |step: usize| {
                    let turn = Quat::from_axis_angle(axis, TUMBLING * step as Real);
                    Pose3::from_parts(pos12.translation, turn * pos12.rotation)
                };
                (0..=STEP_COUNT).map(turned).collect()
            }
        }
    }
}

impl std::fmt::Display for FrontMotion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Slow => "slow",
            Self::Fast => "fast",
            Self::Resting => "resting, jitter",
            Self::Tumbling => "tumbling",
        })
    }
}
