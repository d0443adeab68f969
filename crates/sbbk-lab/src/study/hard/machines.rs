//! A nut on a bolt, a gear that drives another one or a rack, and a worm that drives a gear.
//!
//! At 5 rad/s teeth move by four prediction distances in a step, so contacts of edges that only
//! pass each other would brake.

use rapier3d::dynamics::{GenericJoint, PrismaticJointBuilder, RevoluteJointBuilder};

use super::kit::*;
use crate::mesh::{Gear, Rack, Thread};

/// A nut that runs down a bolt by its weight.
pub(super) fn screws() -> Vec<Trial> {
    let trial = |(friction, name): (f32, &str)| {
        Trial::new(name, move |kit| screw(kit, friction)).without_control()
    };
    let names =
        [(0.01, "nut runs down a bolt, friction 0.01"), (0.05, "nut is locked, friction 0.05")];
    names.map(trial).into()
}

/// Runs the nut. Contact clustering is off, as it merges normals within five degrees.
fn screw(kit: &Kit, friction: f32) -> Figures {
    const BOLT: Thread = Thread::BOLT;
    const NUT: Thread = Thread::NUT;
    let mut world = kit.world();
    world.integration_parameters.contact_clustering = false;
    world.fix(Vec3::ZERO, kit.mesh(&BOLT.bolt()).friction(friction));
    let start = BOLT.pitch * (BOLT.turns - NUT.turns) as f32;
    let body = RigidBodyBuilder::dynamic().translation(Vec3::Y * start).can_sleep(false);
    let body = world.add(body, &kit.mesh(&NUT.nut(1.2)).friction(friction));
    let mut turn = Turn::new(&world, body, Vec3::Y);
    // It first falls by the play of the thread.
    let (mut settled, mut place) = ([0.0; 2], start);
    for step in 1..=720 {
        world.step();
        turn.see(&world);
        place = world.bodies[body].translation().y;
        if step == 30 {
            settled = [turn.angle, place];
        }
        // Before it leaves the bolt.
        if place <= BOLT.pitch {
            break;
        }
    }
    let descent = (settled[1] - place) / BOLT.pitch;
    let turns = (settled[0] - turn.angle) / TAU;
    let figures = Figures::default();
    if friction > 0.03 {
        return figures.within("pitches down", descent, [-0.1, 0.3]);
    }
    let figures = figures.within("pitches down", descent, [1.0, f64::from(BOLT.turns)]);
    figures.within("turns a pitch", turns / descent, [0.98, 1.02])
}

const GEAR: Gear = Gear { teeth: 20, module: 0.1, thinned: 0.01, half_width: 0.2 };
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

pub(super) fn gears() -> Vec<Trial> {
    let trials = [1.0, 5.0].into_iter().flat_map(|speed| {
        let worm = Trial::new(format!("a worm, {speed} rad/s"), move |kit| worm(kit, speed));
        [
            Trial::new(format!("gears, {speed} rad/s"), move |kit| two_gears(kit, speed)),
            Trial::new(format!("a rack, {speed} rad/s"), move |kit| rack(kit, speed)),
            worm.without_control(),
        ]
    });
    trials.collect()
}

/// Both ends of points of an outline.
fn pulled(points: &[Vec2], half_width: f32) -> Vec<Vec3> {
    let ends = |point: &Vec2| [-1.0, 1.0].map(|side| point.extend(side * half_width));
    points.iter().flat_map(ends).collect()
}

/// The teeth, and the disc that they stand on.
pub(super) fn gear(gear: Gear) -> Form {
    let teeth = gear.outlines();
    let feet = teeth.iter().flat_map(|tooth| [tooth[0], tooth[tooth.len() - 1]]);
    let disc = pulled(&feet.collect::<Vec<Vec2>>(), gear.half_width);
    let teeth = teeth.iter().map(|tooth| pulled(tooth, gear.half_width));
    Form::parts(gear.mesh(), teeth.chain([disc]))
}

/// A driver, which turns about an axis, and a wheel or rack.
struct Machine<'a> {
    kit: &'a Kit,
    world: World,
    /// The speed of the driver.
    speed: f32,
    /// Radians of the driver for one radian of the wheel.
    ratio: f32,
    steps: usize,
}

impl<'a> Machine<'a> {
    fn new(kit: &'a Kit, speed: f32) -> Self {
        Self { kit, world: kit.world(), speed, ratio: 1.0, steps: STEPS }
    }

    /// Adds a part that a joint holds where it is.
    fn part(
        &mut self,
        form: &Form,
        body: RigidBodyBuilder,
        joint: impl Into<GenericJoint>,
    ) -> RigidBodyHandle {
        let collider = self.kit.collider(form).friction(FRICTION);
        let body = self.world.add(body.can_sleep(false), &collider);
        self.world.hang(body, joint);
        body
    }

    fn driver(&mut self, form: &Form, body: RigidBodyBuilder, axis: Vec3) -> Turn {
        let joint = RevoluteJointBuilder::new(axis).motor_velocity(self.speed, 1e4);
        let body = self.part(form, body, joint);
        Turn::new(&self.world, body, axis)
    }

    /// Adds a wheel about the z axis, which turns the other way.
    fn wheel(&mut self, form: &Form, body: RigidBodyBuilder) -> Turn {
        let joint = RevoluteJointBuilder::new(Vec3::Z);
        let body = self.part(form, body.angular_damping(LOAD), joint);
        Turn::new(&self.world, body, -Vec3::Z)
    }

    /// Runs the machine; `driven` returns the way of the wheel.
    fn run(mut self, mut turn: Turn, mut driven: impl FnMut(&World) -> f32) -> Figures {
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
        let figures = Figures::default().within("driver's speed", reached, [0.99, 1.01]);
        figures.at_most("driven away by", away, f64::from(backlash))
    }
}

fn two_gears(kit: &Kit, speed: f32) -> Figures {
    let mut machine = Machine::new(kit, speed);
    let driver = machine.driver(&gear(GEAR), RigidBodyBuilder::dynamic(), Vec3::Z);
    // A gap of the second is where a tooth of the first is.
    let wheel = RigidBodyBuilder::dynamic()
        .translation(2.0 * GEAR.pitch_radius() * Vec3::X)
        .rotation(Vec3::Z * PI / GEAR.teeth as f32);
    let mut wheel = machine.wheel(&gear(GEAR), wheel);
    machine.run(driver, |world| wheel.see(world))
}

/// Until the gear has come to the end of the rack.
fn rack(kit: &Kit, speed: f32) -> Figures {
    const RACK: Rack = Rack { gear: GEAR, teeth: 50, depth: 0.3 };
    let mut machine = Machine::new(kit, speed);
    machine.steps = machine.steps.min((10.0 / speed * 60.0) as usize);
    let driver = machine.driver(&gear(GEAR), RigidBodyBuilder::dynamic(), Vec3::Z);
    let teeth = (0..RACK.teeth).map(|tooth| RACK.tooth(tooth));
    let feet = [RACK.tooth(0)[0], RACK.tooth(RACK.teeth - 1)[3]];
    let back = feet.map(|foot| foot + RACK.depth * Vec2::X);
    let bar = pulled(&[feet, back].concat(), GEAR.half_width);
    let form =
        Form::parts(RACK.mesh(), teeth.map(|tooth| pulled(&tooth, GEAR.half_width)).chain([bar]));
    // Whole teeth below the middle.
    let start = -16.0 * PI * GEAR.module;
    let body = RigidBodyBuilder::dynamic().translation(start * Vec3::Y).linear_damping(LOAD);
    let rack = machine.part(&form, body, PrismaticJointBuilder::new(Vec3::Y));
    machine.run(driver, |world| (world.bodies[rack].translation().y - start) / GEAR.pitch_radius())
}

fn worm(kit: &Kit, speed: f32) -> Figures {
    let mut machine = Machine::new(kit, speed);
    machine.ratio = GEAR.teeth as f32;
    // Its lead angle is 4.8 degrees: contact clustering takes normals within five for one.
    machine.world.integration_parameters.contact_clustering = false;
    // The wheel is at the side at which the thread has three quarters of a turn behind it. There a
    // gap is where the first tooth is.
    let line = WORM.root + 1.25 * GEAR.module;
    let place = Vec3::new(GEAR.pitch_radius() + line, -2.75 * WORM.pitch, 0.0);
    let body = RigidBodyBuilder::dynamic().translation(place);
    let driver = machine.driver(&Form::mesh(WORM.bolt()), body, Vec3::Y);
    let mut wheel = machine.wheel(&Form::mesh(WORM_WHEEL.mesh()), RigidBodyBuilder::dynamic());
    machine.run(driver, |world| wheel.see(world))
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
    pub fn new(world: &World, body: RigidBodyHandle, axis: Vec3) -> Self {
        Self { body, axis, last: *world.bodies[body].rotation(), angle: 0.0 }
    }

    /// Adds the turn since the last call, which must be less than half a turn. Returns all turns.
    pub fn see(&mut self, world: &World) -> f32 {
        let now = *world.bodies[self.body].rotation();
        self.angle += (now * self.last.inverse()).to_scaled_axis().dot(self.axis);
        self.last = now;
        self.angle
    }
}
