//! A gear that drives another one, or a rack, and a worm that drives a gear.
//!
//! At 5 rad/s teeth move by four prediction distances in a step, so contacts of edges that only pass
//! each other would brake.

use std::f32::consts::PI;

use glamx::{Quat, Vec2, Vec3};
use rapier3d::dynamics::{
    GenericJoint, PrismaticJointBuilder, RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle,
};
use rapier3d::pipeline::PhysicsWorld;

use super::Trial;
use super::figures::Figures;
use super::kit::{Form, Kit, World};
use crate::mesh::{Gear, Rack, Thread};

const GEAR: Gear = Gear { teeth: 20, module: 0.1, thinned: 0.01, half_width: 0.2 };
const RACK: Rack = Rack { gear: GEAR, teeth: 50, depth: 0.3 };
/// A worm with the flanks of the rack. The wheel is thin, as its teeth are straight.
const WORM: Thread = Thread {
    root: 0.475,
    height: 0.225,
    pitch: PI * GEAR.module,
    flank: 0.26,
    thicker: 0.018,
    turns: 6,
    segments: 64,
};
const WORM_WHEEL: Gear = Gear { half_width: 0.03, ..GEAR };
/// Friction coefficient of greased metal.
const FRICTION: f32 = 0.05;
/// Damping of the driven part, in 1/s.
const LOAD: f32 = 0.5;
/// Number of steps, and number of steps in which the motor may speed up.
const STEPS: usize = 360;
const SPEED_UP: usize = 60;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for speed in [1.0, 5.0] {
        trials.push(Trial::new(format!("gears, {speed} rad/s"), move |kit| gears(kit, speed)));
        trials.push(Trial::new(format!("a rack, {speed} rad/s"), move |kit| rack(kit, speed)));
        let worm = Trial::new(format!("a worm, {speed} rad/s"), move |kit| worm(kit, speed));
        trials.push(worm.without_control());
    }
    trials
}

/// Both ends of points of an outline.
fn pulled(points: &[Vec2]) -> Vec<Vec3> {
    let ends = |point: &Vec2| [-1.0, 1.0].map(|side| point.extend(side * GEAR.half_width));
    points.iter().flat_map(ends).collect()
}

/// The teeth, and the disc that they stand on.
fn gear() -> Form {
    let tooth = GEAR.tooth();
    let turned = |angle: f32, points: &[Vec2]| {
        let turn = Vec2::from_angle(angle);
        pulled(&points.iter().map(|&point| turn.rotate(point)).collect::<Vec<_>>())
    };
    let feet = [tooth[0], tooth[tooth.len() - 1]];
    let disc = GEAR.angles().flat_map(|angle| turned(angle, &feet)).collect();
    let teeth = GEAR.angles().map(|angle| turned(angle, &tooth));
    Form::parts(GEAR.mesh(), teeth.chain([disc]))
}

/// A driver and a wheel or rack.
struct Machine {
    world: World,
    /// The speed of the driver.
    speed: f32,
    /// Radians of the driver for one radian of the wheel.
    ratio: f32,
    steps: usize,
}

impl Machine {
    fn new(kit: &Kit, speed: f32) -> Self {
        Self { world: kit.world(), speed, ratio: 1.0, steps: STEPS }
    }

    /// Adds a part that a joint holds where it is.
    fn part(
        &mut self,
        kit: &Kit,
        form: &Form,
        body: RigidBodyBuilder,
        joint: impl Into<GenericJoint>,
    ) -> RigidBodyHandle {
        let body = self.world.add(body.can_sleep(false), &kit.collider(form).friction(FRICTION));
        let place = self.world.bodies[body].translation();
        let axle = self.world.insert_body(RigidBodyBuilder::fixed().translation(place));
        self.world.insert_impulse_joint(axle, body, joint);
        body
    }

    fn motor(&self, axis: Vec3) -> RevoluteJointBuilder {
        RevoluteJointBuilder::new(axis).motor_velocity(self.speed, 1e4)
    }

    /// Runs the machine. The driver turns about an axis; `driven` returns the way of the wheel.
    fn run(
        mut self,
        (driver, axis): (RigidBodyHandle, Vec3),
        mut driven: impl FnMut(&PhysicsWorld) -> f32,
    ) -> Figures {
        let mut turn = Turn::new(&self.world, driver, axis);
        let (mut away, mut after_speed_up) = (0.0_f32, 0.0);
        for step in 1..=self.steps {
            self.world.step();
            turn.see(&self.world);
            away = away.max((turn.angle / self.ratio - driven(&self.world)).abs());
            if step == SPEED_UP {
                after_speed_up = turn.angle;
            }
        }
        let seconds = (self.steps - SPEED_UP) as f32 * self.world.integration_parameters.dt;
        let reached = (turn.angle - after_speed_up) / seconds / self.speed;
        let backlash = 2.0 * GEAR.thinned / GEAR.pitch_radius();
        Figures::default().within("driver's speed", reached, 0.99, 1.01).at_most(
            "driven away by",
            away,
            f64::from(backlash),
        )
    }
}

fn gears(kit: &Kit, speed: f32) -> Figures {
    let mut machine = Machine::new(kit, speed);
    let driver = machine.part(kit, &gear(), RigidBodyBuilder::dynamic(), machine.motor(Vec3::Z));
    // A gap of the second is where a tooth of the first is.
    let wheel = RigidBodyBuilder::dynamic()
        .translation(2.0 * GEAR.pitch_radius() * Vec3::X)
        .rotation(Vec3::Z * PI / GEAR.teeth as f32)
        .angular_damping(LOAD);
    let wheel = machine.part(kit, &gear(), wheel, RevoluteJointBuilder::new(Vec3::Z));
    let mut turn = Turn::new(&machine.world, wheel, -Vec3::Z);
    machine.run((driver, Vec3::Z), |world| {
        turn.see(world);
        turn.angle
    })
}

/// Until the gear has come to the end of the rack.
fn rack(kit: &Kit, speed: f32) -> Figures {
    let mut machine = Machine::new(kit, speed);
    machine.steps = machine.steps.min((10.0 / speed * 60.0) as usize);
    let driver = machine.part(kit, &gear(), RigidBodyBuilder::dynamic(), machine.motor(Vec3::Z));
    let teeth = (0..RACK.teeth).map(|tooth| RACK.tooth(tooth));
    let feet = [RACK.tooth(0)[0], RACK.tooth(RACK.teeth - 1)[3]];
    let back = feet.map(|foot| foot + RACK.depth * Vec2::X);
    let bar = pulled(&[feet, back].concat());
    let form = Form::parts(RACK.mesh(), teeth.map(|tooth| pulled(&tooth)).chain([bar]));
    // Whole teeth below the middle.
    let start = -16.0 * PI * GEAR.module;
    let body = RigidBodyBuilder::dynamic().translation(start * Vec3::Y).linear_damping(LOAD);
    let rack = machine.part(kit, &form, body, PrismaticJointBuilder::new(Vec3::Y));
    machine.run((driver, Vec3::Z), |world| {
        (world.bodies[rack].translation().y - start) / GEAR.pitch_radius()
    })
}

fn worm(kit: &Kit, speed: f32) -> Figures {
    let mut machine = Machine::new(kit, speed);
    machine.ratio = GEAR.teeth as f32;
    // Its lead angle is 4.8 degrees: contact clustering takes normals within five for one.
    machine.world.integration_parameters.contact_clustering = false;
    // The wheel is at the side at which the thread has three quarters of a turn behind it. There a gap
    // is where the first tooth is.
    let line = WORM.root + 1.25 * GEAR.module;
    let place = Vec3::new(GEAR.pitch_radius() + line, -2.75 * WORM.pitch, 0.0);
    let body = RigidBodyBuilder::dynamic().translation(place);
    let driver = machine.part(kit, &Form::mesh(WORM.bolt()), body, machine.motor(Vec3::Y));
    let wheel = Form::mesh(WORM_WHEEL.mesh());
    let body = RigidBodyBuilder::dynamic().angular_damping(LOAD);
    let wheel = machine.part(kit, &wheel, body, RevoluteJointBuilder::new(Vec3::Z));
    let mut turn = Turn::new(&machine.world, wheel, -Vec3::Z);
    machine.run((driver, Vec3::Y), |world| {
        turn.see(world);
        turn.angle
    })
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

    /// Adds the turn since the last call, which must be less than half a turn.
    pub fn see(&mut self, world: &PhysicsWorld) {
        let now = *world.bodies[self.body].rotation();
        self.angle += (now * self.last.inverse()).to_scaled_axis().dot(self.axis);
        self.last = now;
    }
}
