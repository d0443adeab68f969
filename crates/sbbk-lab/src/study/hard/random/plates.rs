//! Thin plates with soft CCD that fly onto a ground.

use super::prelude::*;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let thick = draw.log(0.02, 0.15);
    let speed = draw.log(3.0, 40.0);
    let ground = draw.ground(8.0);
    let mut bodies = vec![Body::fixed(ground, Pose3::from_rotation(draw.yaw()))];
    let count = 3;
    for index in 0..count {
        let [x, z] = [(); 2].map(|()| draw.within(0.3, 0.6));
        let part = draw.brick(Vec3::new(x, 0.5 * thick, z));
        let turn = draw.yaw() * Quat::from_rotation_x(draw.within(-0.6, 0.6));
        let place = Vec3::new(3.0 * (index as f32 - 1.0), 1.0 + draw.within(0.5, 1.5), 0.3);
        let heading = Vec3::new(draw.within(-0.3, 0.3), -1.0, draw.within(-0.3, 0.3));
        let mut body = Body::moving(part, Pose3::from_parts(place, turn));
        body = body.thrown(speed * heading, Vec3::ZERO);
        let fastest = 1.1 * speed + 2.0 * draw.gravity.sqrt();
        body.builder.soft_ccd_prediction = 1.2 * fastest * draw.dt;
        bodies.push(body);
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let mut lowest = 0.0;
    for _ in 0..draw.steps(2.0) {
        stage.world.step();
        // A plate on the ground is above it, however it lies.
        let heights = (1..=count).map(|body| {
            let place = stage.place(body);
            let is_over = place.x.abs().max(place.z.abs()) < 5.0;
            if is_over || !place.is_finite() { -place.y } else { 0.0 }
        });
        lowest = largest([lowest, largest(heights)]);
    }
    Figures::default().at_most("below the ground", lowest, 0.05)
}
