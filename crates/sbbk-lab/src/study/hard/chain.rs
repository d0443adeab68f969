//! Rings that hang in each other, with a weight.

use std::f32::consts::{FRAC_PI_2, TAU};

use glamx::{Pose3, Quat, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::{Figures, Gain, largest};
use super::kit::{Form, Kit};
use crate::mesh;

/// Rings of the chain; one more is the weight.
const RINGS: usize = 10;
const RADIUS: f32 = 1.0;
const TUBE: f32 = 0.2;
const SEGMENTS: [u32; 2] = [24, 12];
/// Between the middles of two rings of a chain that is taut.
const PITCH: f32 = 2.0 * (RADIUS - TUBE);
/// Difference from the pitch at the start.
const SLACK: f32 = 0.02;
const STEPS: usize = 360;

pub(super) fn trials() -> Vec<Trial> {
    let trial = |load: f32| {
        let name = format!("chain under {load} times its weight");
        Trial::new(name, move |kit| run(kit, load))
    };
    [1.0, 5.0, 50.0].map(trial).into()
}

fn form() -> Form {
    let [ring_segments, tube_segments] = SEGMENTS;
    let part = |part: u32| {
        let ends = [part, part + 1].map(|k| TAU * k as f32 / ring_segments as f32);
        let points = ends.into_iter().flat_map(|angle| {
            (0..tube_segments).map(move |k| {
                let tube = TAU * k as f32 / tube_segments as f32;
                let distance = RADIUS + TUBE * tube.cos();
                Vec3::new(distance * angle.cos(), -TUBE * tube.sin(), distance * angle.sin())
            })
        });
        points.collect()
    };
    let torus = mesh::torus(RADIUS, TUBE, ring_segments, tube_segments);
    Form::parts(torus, (0..ring_segments).map(part))
}

fn run(kit: &Kit, load: f32) -> Figures {
    let mut world = kit.world();
    // With Rapier's defaults a chain of hulls parts as well.
    world.integration_parameters.length_unit = RADIUS / 4.0;
    world.integration_parameters.num_solver_iterations = 16;
    let collider = kit.collider(&form());
    for index in 0..=RINGS {
        let body = match index {
            0 => RigidBodyBuilder::fixed(),
            _ => RigidBodyBuilder::dynamic(),
        };
        // Every second ring is turned by a right angle, all of them upright.
        let upright = Quat::from_rotation_x(FRAC_PI_2);
        let turn = Quat::from_rotation_y(FRAC_PI_2 * (index % 2) as f32) * upright;
        let place = -Vec3::Y * index as f32 * (PITCH - SLACK);
        let density = if index == RINGS { load * RINGS as f32 } else { 1.0 };
        let body = body.pose(Pose3::from_parts(place, turn)).can_sleep(false);
        world.add(body, &collider.clone().density(density));
    }
    world.step();
    let mut gain = Gain::default();
    for _ in 1..STEPS {
        world.step();
        gain.see(world.energy());
    }
    let ends = world.places();
    let apart: Vec<f32> = ends.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let linked = apart.iter().filter(|&&apart| apart < PITCH + TUBE).count();
    let mass: f32 = world.watched[1..].iter().map(|&body| world.bodies[body].mass()).sum();
    // Unit of the gain: the energy that lifts all rings by one ring.
    let lift = mass * -world.gravity.y * PITCH;
    Figures::default()
        .none("parted", RINGS - linked)
        .at_most("energy gained", gain.most / f64::from(lift), 0.05)
        .note("longest link", largest(apart) / PITCH)
}
