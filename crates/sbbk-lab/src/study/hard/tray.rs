//! Small things on a tray, with Rapier's prediction distance, which is as large as they are.

use std::time::Instant;

use glamx::{Pose3, Vec2, Vec3};
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::figures::{Figures, Gain, energy, places, top_speed};
use super::kit::{Form, Kit};
use super::report::STEP_TIME;
use crate::mesh::{self, Mesh};
use crate::metrics::{Summary, solver_points};
use crate::scene::{SceneError, random};

/// Things along each side of the grid in which they start, and the layers of it.
const SIDE: usize = 5;
const LAYERS: usize = 4;
const STEPS: usize = 240;
/// Times and contacts are those of the steps after this one.
const FULL_AT: usize = 60;
/// Lengths from the least to the greatest.
const LEAST: f32 = 0.03;
const MOST: f32 = 0.08;
/// Half the tray's diagonal, the height of its rim, and its thickness.
const HALF: f32 = 0.45;
const RIM: f32 = 0.25;
const WALL: f32 = 0.02;

pub(super) fn trials() -> Vec<Trial> {
    vec![Trial::new("100 things of 3 to 8 cm on a tray", run).without_control().seeded()]
}

fn tray() -> Mesh {
    let profile =
        [[0.0, -WALL], [HALF + WALL, -WALL], [HALF + WALL, RIM], [HALF, RIM], [HALF, 0.0]];
    let profile = profile.into_iter().chain([[0.0; 2]]).map(Vec2::from_array);
    mesh::revolved(&profile.collect::<Vec<Vec2>>(), 4).named("tray")
}

fn run(kit: &Kit) -> Result<Figures, SceneError> {
    let mut world = kit.world();
    world.insert(RigidBodyBuilder::fixed(), kit.collider(&Form::mesh(tray()))?);
    let kinds = [
        mesh::ball(0.5, 8),
        mesh::torus(0.35, 0.15, 24, 12),
        mesh::monkey_head_with(8),
        mesh::cuboid(Vec3::new(0.5, 0.3, 0.2), 6),
    ];
    let mut random = kit.random();
    let mut bodies: Vec<RigidBodyHandle> = Vec::new();
    for index in 0..SIDE * SIDE * LAYERS {
        let size = LEAST + (MOST - LEAST) * random.rand_float();
        let kind = kinds[index % kinds.len()].clone().centred().scaled_to(size);
        let collider: ColliderBuilder = kit.collider(&Form::mesh(kind))?;
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step) as f32);
        let middle = 0.5 * (SIDE - 1) as f32;
        let place = Vec3::new(x % SIDE as f32 - middle, y + 0.6, z % SIDE as f32 - middle);
        let pose = Pose3::from_parts(0.1 * place, random::rotation(&mut random));
        bodies.push(world.insert(RigidBodyBuilder::dynamic().pose(pose), collider).0);
    }
    let start = energy(&world, &bodies);
    let (mut gain, mut times, mut points) = (Gain::default(), Vec::new(), 0.0);
    for step in 1..=STEPS {
        let clock = Instant::now();
        world.step();
        let time = 1e3 * clock.elapsed().as_secs_f64();
        gain.see(energy(&world, &bodies));
        if step > FULL_AT {
            times.push(time);
            points += solver_points(&world) as f64 / (STEPS - FULL_AT) as f64;
        }
    }
    let fell = places(&world, &bodies).iter().filter(|place| place.y < -WALL).count();
    Ok(Figures::default()
        .none("fell", fell)
        .at_most("speed", top_speed(&world, &bodies), 0.5)
        .at_most("energy gained", gain.most / start, 0.001)
        .note("points a step", points)
        .note(STEP_TIME, Summary::of(times).map_or(f64::NAN, |times| times.median)))
}
