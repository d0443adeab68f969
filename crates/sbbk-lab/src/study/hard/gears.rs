//! A gear that drives another one.
//!
//! At 5 rad/s teeth come 8 cm far in a step, four prediction distances. The solver lets them come no nearer
//! to each other along a contact than they are, so contacts of edges that only pass each other brake.

use std::f32::consts::PI;

use glamx::{Quat, Vec2, Vec3};
use rapier3d::dynamics::{RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle};
use rapier3d::pipeline::PhysicsWorld;

use super::Trial;
use super::figures::Figures;
use super::kit::{Form, Kit};
use crate::mesh::Gear;

const GEAR: Gear = Gear { teeth: 20, module: 0.1, thinned: 0.01, half_width: 0.2 };
/// Friction of all machines: that of greased metal.
const FRICTION: f32 = 0.05;
/// Damping of the wheel that is driven, in 1/s.
const LOAD: f32 = 0.5;
/// Steps, and those of them at the start in which the motor may speed up.
const STEPS: usize = 360;
const SPEED_UP: usize = 60;

pub(super) fn trials() -> Vec<Trial> {
    let trial = |speed: f32| {
        let name = format!("gears, {speed} rad/s");
        Trial::new(name, move |kit| run(kit, speed))
    };
    [1.0, 5.0].map(trial).into()
}

/// The teeth, and the disc that they stand on.
fn form() -> Form {
    let tooth = GEAR.tooth();
    let turned = |angle: f32, points: &[Vec2]| {
        let turn = Vec2::from_angle(angle);
        let ends = |point: &Vec2| {
            [-1.0, 1.0].map(|side| turn.rotate(*point).extend(side * GEAR.half_width))
        };
        points.iter().flat_map(ends).collect::<Vec<Vec3>>()
    };
    let feet = [tooth[0], tooth[tooth.len() - 1]];
    let disc = GEAR.angles().flat_map(|angle| turned(angle, &feet)).collect();
    let teeth = GEAR.angles().map(|angle| turned(angle, &tooth));
    Form::parts(GEAR.mesh(), teeth.chain([disc]))
}

fn run(kit: &Kit, speed: f32) -> Figures {
    let mut world = kit.world();
    let collider = kit.collider(&form()).friction(FRICTION);
    let mut wheel = |x: f32, turn: f32, load: f32, motor: Option<f32>| {
        let place = Vec3::X * x;
        let axle = world.insert_body(RigidBodyBuilder::fixed().translation(place));
        let body = RigidBodyBuilder::dynamic().translation(place).rotation(Vec3::Z * turn);
        let body = body.angular_damping(load).can_sleep(false);
        let body = world.add(body, &collider);
        let joint = RevoluteJointBuilder::new(Vec3::Z);
        let joint = motor.iter().fold(joint, |joint, &speed| joint.motor_velocity(speed, 1e4));
        world.insert_impulse_joint(axle, body, joint);
        body
    };
    let driver = wheel(0.0, 0.0, 0.0, Some(speed));
    // A gap of the second is where a tooth of the first is.
    let driven = wheel(2.0 * GEAR.pitch_radius(), PI / GEAR.teeth as f32, LOAD, None);
    let mut turns = [driver, driven].map(|body| Turn::new(&world, body, Vec3::Z));
    let (mut away, mut after_speed_up) = (0.0_f32, 0.0);
    for step in 1..=STEPS {
        world.step();
        turns.iter_mut().for_each(|turn| turn.see(&world));
        away = away.max((turns[0].angle + turns[1].angle).abs());
        if step == SPEED_UP {
            after_speed_up = turns[0].angle;
        }
    }
    let seconds = (STEPS - SPEED_UP) as f32 * world.integration_parameters.dt;
    let reached = (turns[0].angle - after_speed_up) / seconds / speed;
    let backlash = 2.0 * GEAR.thinned / GEAR.pitch_radius();
    Figures::default().within("driver's speed", reached, 0.99, 1.01).at_most(
        "driven away by",
        away,
        f64::from(backlash),
    )
}

/// Counts the turns of a body about an axis.
pub(super) struct Turn {
    body: RigidBodyHandle,
    axis: Vec3,
    last: Quat,
    /// Since the start, in radians.
    pub angle: f32,
}

impl Turn {
    pub fn new(world: &PhysicsWorld, body: RigidBodyHandle, axis: Vec3) -> Self {
        Self { body, axis, last: *world.bodies[body].rotation(), angle: 0.0 }
    }

    /// Adds what it has turned since the last call: less than half a turn.
    pub fn see(&mut self, world: &PhysicsWorld) {
        let now = *world.bodies[self.body].rotation();
        self.angle += (now * self.last.inverse()).to_scaled_axis().dot(self.axis);
        self.last = now;
    }
}
