//! Towers of boxes that stand, heavy ones on light ones among them.

use super::prelude::*;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let count = draw.count(2, 6);
    let ratio = draw.log(1.0, 100.0);
    let gap = draw.pick(&[0.0, 0.005]);
    let friction = draw.within(0.3, 0.9);
    let mut bodies = vec![Body::fixed(draw.ground(3.0), Pose3::from_rotation(draw.yaw()))];
    let mut top = 0.0;
    for _ in 0..count {
        let halves = Vec3::from_array([0.3, 0.15, 0.3].map(|low| draw.within(low, 0.6)));
        // The middles of all above are at most 0.16 aside of the middle of one, which is 0.3 wide.
        let aside = Quat::from_rotation_y(draw.within(0.0, TAU)) * Vec3::X * draw.within(0.0, 0.08);
        let turn = Quat::from_rotation_y(draw.within(0.0, TAU));
        let pose = Pose3::from_parts(aside + Vec3::Y * (top + gap + halves.y), turn);
        top += gap + 2.0 * halves.y;
        bodies.push(Body::moving(draw.brick(halves), pose).density(draw.log(1.0, ratio)));
    }
    let bodies: Vec<Body> = bodies.into_iter().map(|body| body.friction(friction)).collect();
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let moves: Vec<Vec3> = (1..bodies.len()).map(|k| stage.moved(k)).collect();
    figures
        .at_most("aside", largest(moves.iter().map(|way| way.with_y(0.0).length())), 0.05)
        .at_most("down or up", largest(moves.iter().map(|way| way.y.abs())), 0.05)
}
