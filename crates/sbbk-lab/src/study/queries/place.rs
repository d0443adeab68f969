//! Where the second mesh is.

use std::fmt;

use glamx::Pose3;
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::details::ShapeCastOptions;
use serde::Serialize;

use crate::backend::SharedDispatcher;
use crate::scene::random;

/// How far the second mesh stands off the first touch on its way, in sizes of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// 0.03 beyond it.
    Crossing,
    /// 0.001 short of it.
    HardlyApart,
    /// 0.05 short of it.
    Near,
    /// 1 short of it.
    Far,
}

impl Place {
    /// All of them, from inside out.
    pub const ALL: [Self; 4] = [Self::Crossing, Self::HardlyApart, Self::Near, Self::Far];

    /// Way back from the first touch, in sizes.
    pub(super) fn back(self) -> Real {
        match self {
            Self::Crossing => -0.03,
            Self::HardlyApart => 0.001,
            Self::Near => 0.05,
            Self::Far => 1.0,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Crossing => "crossing",
            Self::HardlyApart => "hardly apart",
            Self::Near => "near",
            Self::Far => "far",
        })
    }
}

/// A pose, and the way on which the mesh came there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub pos12: Pose,
    /// Unit vector from the first mesh, against the way of the second one.
    pub back: glamx::Vec3,
}

/// Poses at `place`: the second mesh comes in a random orientation, along a random direction.
pub(super) fn poses(
    caster: &SharedDispatcher,
    shape: &SharedShape,
    size: Real,
    place: Place,
    count: usize,
) -> Vec<Placed> {
    let mut random = Rand32::new(1);
    let mut poses = Vec::new();
    while poses.len() < count {
        let (rotation, back) = (random::rotation(&mut random), random::direction(&mut random));
        let start = Pose3::from_parts(4.0 * size * back, rotation);
        let options = ShapeCastOptions::with_max_time_of_impact(8.0 * size);
        let hit = caster.cast_shapes(&start, -back, &**shape, &**shape, options);
        // A mesh may pass through a hole of the other.
        if let Ok(Some(hit)) = hit {
            let distance = 4.0 * size - hit.time_of_impact + place.back() * size;
            poses.push(Placed { pos12: Pose3::from_parts(distance * back, rotation), back });
        }
    }
    poses
}
