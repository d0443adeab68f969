//! Where a head stands on a terrain, and how it moves there.

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, QueryDispatcher};

use super::plan::PREDICTION;
use crate::study::contacts::{SLOW, STEP_COUNT};

/// A pose of the head that touches the ground.
pub(super) fn place(
    random: &mut Rand32,
    head: &SharedShape,
    ground: &SharedShape,
    cells: u32,
) -> Pose3 {
    let [x, z] = [(); 2].map(|()| 0.4 * cells as Real * (random.rand_float() - 0.5));
    let turn = Quat::from_rotation_y(6.0 * random.rand_float());
    let at = |y: Real| Pose3::from_parts(Vec3::new(x, y, z), turn);
    let touches = |y: Real| {
        let answer = DefaultQueryDispatcher.intersection_test(&at(y), &*ground.0, &*head.0);
        answer.is_ok_and(|answer| answer.intersecting)
    };
    let (mut below, mut above) = (-1.5, 3.0);
    for _ in 0..16 {
        let middle = 0.5 * (below + above);
        // A head that is deep in the ground touches it with its sides, one under it does not.
        *(if touches(middle) || middle < 0.0 { &mut below } else { &mut above }) = middle;
    }
    at(below - 0.2 * PREDICTION)
}

/// Slow motion along the ground.
pub(super) fn motion(start: Pose3) -> Vec<Pose3> {
    let step = Vec3::X * SLOW * PREDICTION;
    let pose = |i: usize| Pose3::from_parts(start.translation + i as Real * step, start.rotation);
    (0..=STEP_COUNT).map(pose).collect()
}
