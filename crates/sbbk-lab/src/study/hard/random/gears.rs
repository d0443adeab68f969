//! A gear that drives another one.

use rapier3d::dynamics::RevoluteJointBuilder;

use super::prelude::*;
use crate::mesh::Gear;
use crate::study::hard::machines::{self, Turn};

/// Damping of the wheel, in 1/s.
const LOAD: f32 = 0.5;
/// Time of a run, and of its start in which the motor may speed up, in seconds.
const SECONDS: f32 = 2.5;
const SPEED_UP: f32 = 0.5;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    draw.dt = draw.dt.max(1.0 / 120.0);
    let teeth = [(); 2].map(|()| draw.count(18, 24));
    let module = 1.0 / teeth[0] as f32;
    let thinned = draw.within(0.05, 0.15) * module;
    let half_width = draw.within(0.05, 0.25);
    let gears = teeth.map(|teeth| Gear { teeth, module, thinned, half_width });
    let bodies = mesh_up(draw, gears);
    let speed = draw.within(1.0, 5.0);
    let friction = draw.within(0.0, 0.1);
    let bodies = bodies.map(|body| body.friction(friction));
    let mut stage = Stage::new(draw, kit, &bodies);
    // Teeth are small beside the gear: Rapier's allowed error is a twentieth of a module.
    stage.world.integration_parameters.length_unit *= 10.0 * module;
    let joint = RevoluteJointBuilder::new(Vec3::Z);
    stage.world.hang(stage.handles[0], joint.motor_velocity(speed, 1e4));
    stage.world.hang(stage.handles[1], joint);
    let figures = watched(&mut stage, speed, gears);
    let lifted = (0..2).map(|k| stage.moved(k).length());
    figures.at_most("lifted", largest(lifted), 0.01)
}

/// The driver, and a wheel that has a gap where a tooth of the driver is.
fn mesh_up(draw: &mut Draw, gears: [Gear; 2]) -> [Body; 2] {
    let [driver, wheel] =
        gears.map(|gear| draw.sometimes_flawed("gear", Part::new(machines::gear(gear))));
    let way = gears[0].pitch_radius() + gears[1].pitch_radius();
    let teeth = gears[1].teeth;
    let turn = if teeth.is_multiple_of(2) { PI / teeth as f32 } else { 0.0 };
    let place = Pose3::from_parts(way * Vec3::X, Quat::from_rotation_z(turn));
    let mut wheel = Body::moving(wheel, place).density(draw.log(0.1, 10.0));
    wheel.builder.angular_damping = LOAD;
    [Body::moving(driver, Pose3::IDENTITY), wheel]
}

/// Runs the gears, and compares their turns.
fn watched(stage: &mut Stage, speed: f32, gears: [Gear; 2]) -> Figures {
    let axes = [(0, Vec3::Z), (1, -Vec3::Z)];
    let mut turns = axes.map(|(body, axis)| Turn::new(&stage.world, stage.handles[body], axis));
    let (mut away, mut before) = (0.0_f32, 0.0);
    let [speed_up, steps] = [SPEED_UP, SECONDS].map(|seconds| stage.draw.steps(seconds));
    for step in 0..steps {
        stage.world.step();
        let [one, other] = [0, 1].map(|k| turns[k].see(&stage.world));
        let driven = other * gears[1].teeth as f32 / gears[0].teeth as f32;
        away = largest([away, (one - driven).abs() - 0.01 * one.abs()]);
        if step + 1 == speed_up {
            before = one;
        }
    }
    let reached = turns[0].angle - before;
    let reached = reached / ((steps - speed_up) as f32 * stage.draw.dt * speed);
    let backlash = 2.0 * gears[0].thinned / gears[0].pitch_radius();
    let figures = Figures::default().within("driver's speed", reached, [0.98, 1.02]);
    figures.at_most("driven away by", away, f64::from(backlash))
}
