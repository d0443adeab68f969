//! Bodies that fly about in a closed box whose faces look outward.

use super::prelude::*;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let halves = Vec3::from_array([(); 3].map(|()| draw.within(2.2, 3.5)));
    let room = draw.room(halves);
    let pose = Pose3::from_rotation(draw.yaw());
    let mut bodies = vec![Body::fixed(room, pose)];
    let ratio = draw.log(1.0, 100.0);
    for index in 0..draw.count(1, 8) {
        let corner = [index & 1, index >> 1 & 1, index >> 2].map(|k| 2.1 * (k as f32 - 0.5));
        let part = draw.solid();
        let place = pose * Pose3::from_parts(Vec3::from_array(corner), draw.turn());
        let speed = draw.turn() * Vec3::X * draw.within(0.0, 4.0);
        let body = Body::moving(part, place).damped(draw).thrown(speed, Vec3::ZERO);
        bodies.push(body.density(draw.log(1.0, ratio)));
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let beyond = (1..bodies.len()).map(|body| {
        let inside = pose.inverse_transform_point(stage.place(body)).abs() - halves;
        largest(inside.to_array().map(|beyond| beyond.max(-halves.x)))
    });
    let beyond = beyond.reduce(|a, b| largest([a, b])).unwrap_or(f32::NAN);
    let figures = figures.at_most("beyond a wall", beyond, 0.0);
    figures.at_most("deepest", stage.deepest(1), 0.03)
}
