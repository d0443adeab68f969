//! Seeded random orientations and directions, and ways to the first touch of two shapes.

use std::f32::consts::TAU;

use glamx::{Quat, Vec3};
use oorandom::Rand32;

/// Uniformly distributed over all rotations (K. Shoemake, "Uniform random rotations", 1992).
pub fn rotation(random: &mut Rand32) -> Quat {
    let [split, angle1, angle2] = std::array::from_fn(|_| random.rand_float());
    let (radius1, radius2) = ((1.0 - split).sqrt(), split.sqrt());
    let [(sin1, cos1), (sin2, cos2)] = [angle1, angle2].map(|angle| (TAU * angle).sin_cos());
    Quat::from_xyzw(radius1 * sin1, radius1 * cos1, radius2 * sin2, radius2 * cos2).normalize()
}

/// Uniformly distributed over all unit vectors.
pub fn direction(random: &mut Rand32) -> Vec3 {
    rotation(random) * Vec3::Y
}

/// Steps of the coarse search for the first touch. Higher: slower tests and studies; lower: thin
/// parts pass through each other.
const COARSE_STEPS: u16 = 64;

/// Finds where two shapes meet that come closer from `farthest`. Returns a distance at which they
/// meet, at most `precision` below one at which they do not; all bits are right for 0.
pub fn first_touch(
    farthest: f32,
    precision: f32,
    mut meet: impl FnMut(f32) -> bool,
) -> Option<f32> {
    let step = farthest / f32::from(COARSE_STEPS);
    let mut distances = (0..COARSE_STEPS).map(|i| farthest - step * f32::from(i));
    let mut inside = distances.find(|&distance| meet(distance))?;
    let mut outside = inside + step;
    loop {
        let middle = 0.5 * (inside + outside);
        if outside - inside <= precision || middle <= inside || middle >= outside {
            return Some(inside);
        }
        *(if meet(middle) { &mut inside } else { &mut outside }) = middle;
    }
}
