use glamx::Vec3;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::Pose;
use rapier3d::parry::shape::SharedShape;
use sbbk_testkit::mesh;

use crate::support::counting;
use crate::worlds::Bodies;

/// A head that falls on a floor and comes to rest: where it is, step by step.
fn fall(floor: SharedShape, dispatcher: Option<SbbkDispatcher>) -> Vec<Pose> {
    let head = mesh::monkey_head().shape();
    let mut world = Bodies::above(floor, &head, [Vec3::new(0.3, 1.6, -0.2)], 2.0, dispatcher);
    let step = |_| {
        world.step(1);
        world.poses()[0]
    };
    (0..600).map(step).collect()
}

/// Would catch contacts that flicker, sink in or do not hold a body at rest: ten seconds on a
/// floor, beside stock. A head rolls to where it likes, which is chaos; so heights and speeds are
/// compared, not places.
#[test]
fn a_head_rests_on_a_floor_as_with_stock() {
    for shape in [SharedShape::cuboid(50.0, 0.25, 50.0), SharedShape::halfspace(Vec3::Y)] {
        let dispatcher = counting();
        let stock = fall(shape.clone(), None);
        let sbbk = fall(shape, Some(dispatcher.clone()));
        let apart = |i: usize| (stock[i].translation - sbbk[i].translation).length();
        assert!((0..40).all(|i| apart(i) < 1e-4), "apart at the first touch: {}", apart(39));
        for poses in [&stock, &sbbk] {
            let moved = (poses[599].translation - poses[540].translation).length();
            assert!(moved < 0.02, "moves by {moved} in the last second");
        }
        let height = stock[599].translation.y - sbbk[599].translation.y;
        assert!(height.abs() < 0.02, "{height} higher");
        assert!(dispatcher.stats().queries > 30, "SBBK did not answer");
    }
}
