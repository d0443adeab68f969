//! Tables of boxes, with things on them.

use super::prelude::*;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let ground = Body::fixed(draw.ground(4.0), Pose3::from_rotation(draw.yaw()));
    let top = Vec3::new(draw.within(0.9, 1.5), draw.within(0.04, 0.1), draw.within(0.8, 1.2));
    let leg = Vec3::new(draw.within(0.05, 0.12), draw.within(0.3, 0.6), draw.within(0.05, 0.12));
    let height = 2.0 * (leg.y + top.y);
    let start = Pose3::translation(0.0, 0.001, 0.0);
    let mut bodies = vec![ground, Body::moving(draw.table(top, leg), start)];
    let ratio = draw.log(1.0, 100.0);
    for index in 0..draw.count(1, 4) {
        let halves = Vec3::from_array([(); 3].map(|()| draw.within(0.1, 0.25)));
        let side = Vec3::new((index % 2) as f32 - 0.5, 0.0, (index / 2) as f32 - 0.5);
        let place = 0.9 * top.with_y(0.0) * side + Vec3::Y * (height + halves.y + 0.002);
        let pose = Pose3::from_parts(place, draw.yaw());
        let part = draw.brick(halves);
        bodies.push(Body::moving(part, pose).density(draw.log(1.0, ratio)));
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let up = stage.pose(1).rotation * Vec3::Y;
    let moves = (1..bodies.len()).map(|k| stage.moved(k).length());
    figures.at_most("tilt", 1.0 - up.y, 1e-4).at_most("moved", largest(moves), 0.05)
}
