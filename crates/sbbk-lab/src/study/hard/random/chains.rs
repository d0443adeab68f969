//! Rings that hang in each other, with a weight at the end.

use super::prelude::*;
use crate::study::hard::resting::ring;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let tube = draw.within(0.07, 0.12);
    let radius = 0.5 - tube;
    let segments = [draw.count(14, 28), draw.count(8, 14)];
    let part = draw.sometimes_flawed("ring", Part::new(ring(radius, tube, segments)));
    // Between the middles of two rings of a chain that is taut.
    let pitch = 2.0 * (radius - tube);
    let (count, load) = (draw.count(3, 8), draw.log(1.0, 100.0));
    let (slack, start) = (draw.within(0.01, 0.05), draw.within(0.0, TAU));
    let mut bodies = Vec::new();
    for index in 0..=count {
        let upright = Quat::from_rotation_x(FRAC_PI_2);
        let turn = Quat::from_rotation_y(start + FRAC_PI_2 * (index % 2) as f32) * upright;
        let pose = Pose3::from_parts(-Vec3::Y * index as f32 * (pitch - slack), turn);
        let body = if index == 0 { Body::fixed } else { Body::moving };
        let density = if index == count { load } else { 1.0 };
        bodies.push(body(part.clone(), pose).density(density));
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    // A ring's tube is thin: with Rapier's defaults a chain of hulls parts as well.
    stage.world.integration_parameters.length_unit *= 0.1;
    stage.world.integration_parameters.num_solver_iterations = 16;
    let gain = stage.gain(4.0);
    let last = count as usize;
    let apart = (0..last).map(|k| stage.place(k).distance(stage.place(k + 1)));
    Figures::default()
        .at_most("longest link", largest(apart) / pitch, 1.0 + f64::from(tube / pitch))
        .at_most("energy gained", gain, 0.05)
}
