//! The motion bound and the map of a placement.

use crate::prelude::*;
use glamx::DPose3;

/// Would catch a bound without the lever of the rotation, the motion of the centre in the wrong
/// frame, and a uselessly large bound.
#[test]
fn no_point_moves_farther_than_the_bound() {
    let mut random = Random(31);
    let mut tightest = f64::INFINITY;
    for i in 0..5_000 {
        let (centre, radius) = (random.vector(3.0), random.range(0.0, 2.0));
        let before = random.pose(5.0);
        let size = [1e-4, 1e-2, 1.0][i % 3];
        let after = random.near(&before, size);
        let placements = [Placement::new(&before), Placement::new(&after)];
        let bound = placements[1].motion_bound(&placements[0], centre, radius);
        for _ in 0..20 {
            let direction = random.vector(1.0).as_dvec3().normalize();
            let point: DVec3 = centre.as_dvec3() + direction * f64::from(radius);
            let at = |p: &Placement| p.rotation * point + p.translation;
            let moved = at(&placements[1]).distance(at(&placements[0]));
            assert!(moved <= bound, "moved {moved}, bound {bound}");
            tightest = tightest.min(bound / moved);
        }
    }
    assert!(tightest < 1.5, "the bound is never better than {tightest} times the motion");
}

/// The map is Parry's, `q v q*`, also for quaternions off unit length.
#[test]
fn the_map_is_that_of_the_quaternion() {
    let mut random = Random(32);
    for scale in [1.0, 0.9, 1.001] {
        for _ in 0..1_000 {
            let mut pose = random.pose(5.0);
            pose.rotation *= scale;
            let (x, origin) = (random.vector(3.0), random.vector(3.0));
            let exact = DPose3::from(pose);
            let placement = Placement::new(&pose);
            let moved = placement.to_frame1(x, origin);
            let expected = exact.transform_point(x.as_dvec3()) - origin.as_dvec3();
            assert!(moved.distance(expected) < 1e-13, "{moved:?} {expected:?}");
            let back = placement.to_frame2(moved, origin);
            assert!(back.distance(x.as_dvec3()) < 1e-13, "{back:?} {x:?}");
        }
    }
}
