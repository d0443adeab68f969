//! Small things on a tray, with Rapier's prediction distance, which is as large as they are.

use glamx::{Pose3, Vec2, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::figures::Figures;
use super::kit::{Form, Kit};
use super::report::STEP_TIME;
use crate::mesh::{self, Mesh};
use crate::scene::random;

/// Things along each side of the grid in which they start, and the layers of it.
const SIDE: usize = 5;
const LAYERS: usize = 4;
const STEPS: usize = 240;
/// Step after which times and contacts are measured.
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

/// A square tray with walls all round; half its diagonal inside, and the height of its rim over the
/// bottom.
pub(super) fn tray(half: f32, rim: f32, wall: f32) -> Mesh {
    let outside = half + wall;
    let profile =
        [[0.0, -wall], [outside, -wall], [outside, rim], [half, rim], [half, 0.0], [0.0; 2]];
    mesh::revolved(&profile.map(Vec2::from_array), 4).named("tray")
}

fn run(kit: &Kit) -> Figures {
    let mut world = kit.world();
    world.fix(Vec3::ZERO, kit.collider(&Form::mesh(tray(HALF, RIM, WALL))));
    let kinds = [
        mesh::ball(0.5, 8),
        mesh::torus(0.35, 0.15, 24, 12),
        mesh::monkey_head_with(8),
        mesh::cuboid(Vec3::new(0.5, 0.3, 0.2), 6),
    ];
    let mut random = kit.random();
    for index in 0..SIDE * SIDE * LAYERS {
        let size = LEAST + (MOST - LEAST) * random.rand_float();
        let kind = kinds[index % kinds.len()].clone().centred().scaled_to(size);
        let collider: ColliderBuilder = kit.collider(&Form::mesh(kind));
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step) as f32);
        let middle = 0.5 * (SIDE - 1) as f32;
        let place = Vec3::new(x % SIDE as f32 - middle, y + 0.6, z % SIDE as f32 - middle);
        let pose = Pose3::from_parts(0.1 * place, random::rotation(&mut random));
        world.add(RigidBodyBuilder::dynamic().pose(pose), &collider);
    }
    let watched = world.watch(STEPS, FULL_AT, |_, _| ());
    let fell = world.places().iter().filter(|place| place.y < -WALL).count();
    Figures::default()
        .none("fell", fell)
        .at_most("speed", world.top_speed(), 0.5)
        .at_most("energy gained", watched.gain, 0.001)
        .note("points a step", watched.points)
        .note(STEP_TIME, watched.step_time)
}
