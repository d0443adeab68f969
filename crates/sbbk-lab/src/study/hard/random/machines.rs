//! Chains, gears, screws and grippers.

use rapier3d::dynamics::RevoluteJointBuilder;

use super::prelude::*;
use crate::mesh::{Gear, Thread};
use crate::study::hard::machines::{Turn, gear};
use crate::study::hard::resting::ring;

/// Rings that hang in each other, with a weight at the end.
pub(super) fn chains(draw: &mut Draw, kit: &Kit) -> Figures {
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

/// A gear that drives another one.
pub(super) fn gears(draw: &mut Draw, kit: &Kit) -> Figures {
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
    let figures = run_gears(&mut stage, speed, gears);
    let lifted = (0..2).map(|k| stage.moved(k).length());
    figures.at_most("lifted", largest(lifted), 0.01)
}

/// The driver, and a wheel that has a gap where a tooth of the driver is.
fn mesh_up(draw: &mut Draw, gears: [Gear; 2]) -> [Body; 2] {
    let [driver, wheel] = gears.map(|of| draw.sometimes_flawed("gear", Part::new(gear(of))));
    let way = gears[0].pitch_radius() + gears[1].pitch_radius();
    let teeth = gears[1].teeth;
    let turn = if teeth.is_multiple_of(2) { PI / teeth as f32 } else { 0.0 };
    let place = Pose3::from_parts(way * Vec3::X, Quat::from_rotation_z(turn));
    let mut wheel = Body::moving(wheel, place).density(draw.log(0.1, 10.0));
    wheel.builder.angular_damping = 0.5;
    [Body::moving(driver, Pose3::IDENTITY), wheel]
}

/// Runs the gears for 2.5 seconds, and compares their turns. At first the motor may speed up.
fn run_gears(stage: &mut Stage, speed: f32, gears: [Gear; 2]) -> Figures {
    let axes = [(0, Vec3::Z), (1, -Vec3::Z)];
    let mut turns = axes.map(|(body, axis)| Turn::new(&stage.world, stage.handles[body], axis));
    let (mut away, mut before) = (0.0_f32, 0.0);
    let [speed_up, steps] = [0.5, 2.5].map(|seconds| stage.draw.steps(seconds));
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

/// A nut that runs down a bolt by its weight, or is locked by friction.
pub(super) fn screws(draw: &mut Draw, kit: &Kit) -> Figures {
    draw.dt = draw.dt.clamp(1.0 / 120.0, 1.0 / 60.0);
    let [bolt, nut] = threads(draw);
    let meshes = [("bolt", bolt.bolt()), ("nut", nut.nut(0.6))];
    let parts = meshes.map(|(name, mesh)| draw.part(name, mesh.clone(), Part::clean(mesh, None)));
    let radius = 0.5 * (nut.root + bolt.root + bolt.height);
    let lead = bolt.pitch / TAU;
    let lean = (bolt.flank * bolt.pitch / bolt.height).atan();
    let slope = (lead / radius).atan();
    let is_locked = draw.chance(0.3);
    let share = if is_locked { draw.within(1.3, 2.0) } else { draw.within(0.0, 0.6) };
    let friction = share * slope.tan() * lean.cos();
    let slips = slope - (friction / lean.cos()).atan();
    let mass = &parts[1].mass;
    let axes = mass.principal_inertia_local_frame * Vec3::Y;
    let gyration = (axes * axes).dot(mass.principal_inertia()) / mass.mass();
    // By the unrolled thread.
    let pull = draw.gravity / (1.0 + gyration / (lead * radius * slips.tan()));
    let pull = if is_locked { 0.0 } else { pull };
    let start = Pose3::translation(0.0, bolt.pitch * (bolt.turns - nut.turns) as f32, 0.0);
    let [fixed, moving] = parts;
    let bodies = [Body::fixed(fixed, Pose3::IDENTITY), Body::moving(moving, start)];
    let bodies = bodies.map(|body| body.friction(friction));
    let mut stage = Stage::new(draw, kit, &bodies);
    // Threads are small beside the bolt.
    stage.world.integration_parameters.length_unit *= bolt.pitch;
    // Lead angles are of a few degrees: contact clustering takes such normals for one.
    stage.world.integration_parameters.contact_clustering = false;
    run_nut(&mut stage, bolt.pitch, pull)
}

/// The threads of a bolt, and of a nut with a tenth of a pitch of play, and so much less deep.
fn threads(draw: &mut Draw) -> [Thread; 2] {
    let pitch = draw.within(0.12, 0.3);
    let (height, flank) = (draw.within(0.4, 0.55) * pitch, draw.within(0.1, 0.15));
    // Facets take a tenth of the play at most. Larger ones could lock a nut.
    let least = PI * (0.45 / (0.02 * pitch)).sqrt();
    let segments = least.ceil() as u32 + draw.count(1, 8);
    let bolt = Thread { root: 0.4, height, pitch, flank, thicker: 0.0, turns: 4, segments };
    [bolt, Thread { root: bolt.root + 0.1 * pitch, thicker: 0.05, turns: 1, ..bolt }]
}

/// Runs the nut over 1.8 pitches, or for 2.5 seconds. It should run down with the acceleration
/// `pull`, in sizes/s². A pull of 0 locks it.
fn run_nut(stage: &mut Stage, pitch: f32, pull: f32) -> Figures {
    let draw = stage.draw;
    let seconds = (2.0 * 1.8 * pitch / pull.max(1e-6)).sqrt().min(2.5);
    let mut turn = Turn::new(&stage.world, stage.handles[1], Vec3::Y);
    // It first falls by the play.
    let settled = draw.steps(3.0 * (0.2 * pitch / draw.gravity).sqrt()) + 1;
    let steps = draw.steps(seconds).max(settled);
    let mut before = [0.0; 2];
    for step in 1..=steps {
        stage.world.step();
        turn.see(&stage.world);
        if step == settled {
            before = [turn.angle, stage.place(1).y];
        }
    }
    let down = (before[1] - stage.place(1).y) / pitch;
    if pull == 0.0 {
        return Figures::default().within("pitches down, locked", down, [-0.05, 0.05]);
    }
    let angle = (turn.angle - before[0]).abs();
    let [first, last] = [settled, steps].map(|step| (step as f32 * draw.dt).powi(2));
    let ideal = f64::from(0.5 * pull * TAU / pitch * (last - first));
    let figures = Figures::default().within("turn", angle, [0.45 * ideal, 1.1 * ideal + 0.2]);
    figures.at_most("off its thread", f64::from((angle / TAU - down).abs()), 0.15)
}

/// Two fingers that squeeze a part and hold it.
pub(super) fn grippers(draw: &mut Draw, kit: &Kit) -> Figures {
    let halves = Vec3::from_array([0.25, 0.3, 0.3].map(|low| draw.within(low, 0.5)));
    let part = gripped(draw, halves);
    draw.gravity = draw.log(10.0, 150.0);
    draw.dt = draw.dt.min(1.0 / 60.0);
    // Force of a finger, in weights of the part.
    let press = draw.log(3.0, 30.0);
    let held = Body::moving(part.clone(), Pose3::IDENTITY).friction(1.0);
    let bodies = [finger(draw, &part, -1.0), finger(draw, &part, 1.0), held];
    let mut stage = Stage::new(draw, kit, &bodies);
    let gravity = std::mem::take(&mut stage.world.gravity);
    close(&mut stage, press * gravity.length());
    stage.world.gravity = gravity;
    // The whole gripper may drift.
    let place = |stage: &Stage| stage.place(2) - 0.5 * (stage.place(0) + stage.place(1));
    let (start, rotation) = (place(&stage), stage.pose(2).rotation);
    stage.world.run(draw.steps(2.0));
    let turned = rotation.angle_between(stage.pose(2).rotation);
    let figures = Figures::default().at_most("moved", start.distance(place(&stage)), 0.2);
    figures.at_most("turned", turned, 0.3).note("deepest", stage.deepest(0))
}

/// A box, a ball or an upright cylinder.
fn gripped(draw: &mut Draw, halves: Vec3) -> Part {
    match draw.pick(&["brick", "ball", "cylinder"]) {
        "brick" => draw.brick(halves),
        "ball" => draw.ball(),
        _ => {
            let Vec3 { x, y, .. } = halves;
            let profile = [[0.0, -y], [x, -y], [x, y], [0.0, y]].map(Vec2::from_array);
            let cylinder = mesh::revolved(&profile, draw.count(16, 48));
            let hull = SharedShape::convex_hull(&cylinder.vertices);
            draw.sometimes_flawed("cylinder", Part::clean(cylinder, hull))
        }
    }
}

/// A finger beside the part, which moves along `x` only and has between 0.3 and 3 times the mass of
/// the part.
fn finger(draw: &mut Draw, part: &Part, side: f32) -> Body {
    let halves = Vec3::new(0.15, draw.within(0.15, 0.5), draw.within(0.15, 0.5));
    let brick = draw.brick(halves);
    let place = side * (part.sound.bounds().maxs.x + halves.x + 0.002);
    let density = draw.log(0.3, 3.0) * part.mass.mass() / brick.mass.mass();
    let finger = Body::moving(brick, Pose3::translation(place, 0.0, 0.0));
    let mut finger = finger.friction(1.0).density(density);
    let builder = finger.builder.enabled_translations(true, false, false);
    finger.builder = builder.lock_rotations().linear_damping(20.0);
    finger
}

/// Presses the fingers against the part for a second. The force grows at first, up to `press` times
/// the mass of the part.
fn close(stage: &mut Stage, press: f32) {
    let [one, other, part] = [0, 1, 2].map(|k| stage.handles[k]);
    let steps = stage.draw.steps(1.0);
    let force = press * stage.world.bodies[part].mass();
    for step in 0..steps {
        let share = (2.0 * step as f32 / steps as f32).min(1.0);
        for (finger, way) in [(one, Vec3::X), (other, -Vec3::X)] {
            let finger = &mut stage.world.bodies[finger];
            finger.reset_forces(true);
            finger.add_force(share * force * way, true);
        }
        stage.world.step();
    }
}
