//! Seeded random orientations and directions.

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
