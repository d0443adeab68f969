use glamx::{Quat, Vec3};
use rapier_integration::ContactSet;
use rapier3d::math::{Pose, Real};
use sbbk_lab::mesh;

use crate::support::{Query, distance, fresh, having, shape};

/// A body that lies on a face, not quite flat, is held up at its other corners as well: it rocks onto
/// them. Would catch corners that are left out as the lower ones are nearer.
#[test]
fn corners_above_a_face_count_though_others_are_nearer() {
    let [floor, cube] = [mesh::floor(4.0, 1), mesh::cuboid(Vec3::splat(0.5), 1)].map(|m| shape(&m));
    let tilt: Real = 0.07;
    let turn = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(tilt);
    let height = 0.5 * (tilt.sin() + tilt.cos());
    let at = Pose::from_parts(Vec3::new(0.3, height + 0.001, 0.2), turn);
    let found = fresh(&having(ContactSet::Surfaces), &Query::new(&floor, &cube, at).within(0.1));
    let at_corners = |near: Real, far: Real| {
        let distances = found.iter().map(|manifold| distance(manifold));
        distances.filter(|distance| (near..far).contains(distance)).count()
    };
    assert!(at_corners(0.0, 0.002) > 0 && at_corners(0.069, 0.073) > 0, "{found:?}");
}
