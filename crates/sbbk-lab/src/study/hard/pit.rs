//! Heads that come to rest in a pit, of several sizes.

use glamx::{Pose3, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::depth::{Depths, touching_pairs};
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};
use super::tray::tray;
use crate::mesh;
use crate::scene::random;

/// Heads along each side of the cube in which they start.
const SIDE: usize = 4;
const STEPS: usize = 480;
/// Half the pit's diagonal, its depth, and the thickness of its walls, in heads.
const HALF: f32 = 3.6;
const DEPTH: f32 = 3.0;
const WALL: f32 = 0.5;

pub(super) fn trials() -> Vec<Trial> {
    let trial = |size: f32| {
        let name = format!("64 heads of {size} in a pit");
        Trial::new(name, move |kit| run(kit, size)).without_control().seeded()
    };
    [0.02, 1.0, 50.0].map(trial).into()
}

/// All lengths, gravity and `length_unit` are in heads.
fn run(kit: &Kit, size: f32) -> Figures {
    let mut world = kit.world();
    world.integration_parameters.length_unit = size;
    world.gravity *= size;
    world.fix(Vec3::ZERO, kit.collider(&Form::mesh(tray(HALF, DEPTH, WALL).scaled(size))));
    let head = mesh::monkey_head().centred().scaled_to(size);
    let collider = kit.collider(&Form::mesh(head.clone()));
    let mut random = kit.random();
    for index in 0..SIDE * SIDE * SIDE {
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step % SIDE) as f32);
        let place = 1.15 * Vec3::new(x - 1.5, y + 0.7, z - 1.5);
        // Sides of the pit are between the axes.
        let place = Pose3::rotation(Vec3::Y * std::f32::consts::FRAC_PI_4) * place;
        let pose = Pose3::from_parts(size * place, random::rotation(&mut random));
        world.add(RigidBodyBuilder::dynamic().pose(pose), &collider);
    }
    let watched = world.watch(STEPS, STEPS, |_, _| ());
    let awake = world.watched.iter().filter(|&&body| !world.bodies[body].is_sleeping()).count();
    let depths = touching_pairs(&world, &Depths::new(&head), 150);
    let ends = world.places();
    let kept = ends.iter().filter(|end| end.y > 0.0).count();
    let per_size = f64::from(size);
    Figures::default()
        .at_most("speed", f64::from(world.top_speed()) / per_size, 0.05)
        .at_most("deepest", depths.max / per_size, 0.025)
        .at_most("energy gained", watched.gain, 0.001)
        .none("lost", ends.len() - kept)
        .note("awake", awake as f64)
        .note("highest", f64::from(largest(ends.iter().map(|end| end.y))) / per_size)
}
