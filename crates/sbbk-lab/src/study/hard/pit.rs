//! Heads that come to rest in a pit, of several sizes.

use glamx::{Pose3, Vec2, Vec3};
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};

use super::Trial;
use super::depth::{Depths, touching_pairs};
use super::figures::{Figures, Gain, energy, largest, places, top_speed};
use super::kit::{Form, Kit};
use crate::mesh::{self, Mesh};
use crate::scene::{SceneError, random};

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

/// A square pit with walls all round.
fn pit() -> Mesh {
    let profile =
        [[0.0, -WALL], [HALF + WALL, -WALL], [HALF + WALL, DEPTH], [HALF, DEPTH], [HALF, 0.0]];
    let profile = profile.into_iter().chain([[0.0; 2]]).map(Vec2::from_array);
    mesh::revolved(&profile.collect::<Vec<Vec2>>(), 4).named("pit")
}

/// All lengths are in heads, of which Rapier is told, and so is gravity: a different size is a
/// different unit.
fn run(kit: &Kit, size: f32) -> Result<Figures, SceneError> {
    let mut world = kit.world();
    world.integration_parameters.length_unit = size;
    world.gravity *= size;
    world.insert(RigidBodyBuilder::fixed(), kit.collider(&Form::mesh(pit().scaled(size)))?);
    let head = mesh::monkey_head().centred().scaled_to(size);
    let collider = kit.collider(&Form::mesh(head.clone()))?;
    let mut random = kit.random();
    let bodies = (0..SIDE * SIDE * SIDE).map(|index| {
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step % SIDE) as f32);
        let place = 1.15 * Vec3::new(x - 1.5, y + 0.7, z - 1.5);
        // Sides of the pit are between the axes.
        let place = Pose3::rotation(Vec3::Y * std::f32::consts::FRAC_PI_4) * place;
        let pose = Pose3::from_parts(size * place, random::rotation(&mut random));
        world.insert(RigidBodyBuilder::dynamic().pose(pose), collider.clone()).0
    });
    let bodies: Vec<RigidBodyHandle> = bodies.collect();
    let start = energy(&world, &bodies);
    let mut gain = Gain::default();
    for _ in 0..STEPS {
        world.step();
        gain.see(energy(&world, &bodies));
    }
    let awake = bodies.iter().filter(|&&body| !world.bodies[body].is_sleeping()).count();
    let depths = touching_pairs(&world, &Depths::new(&head)?, 150);
    let ends = places(&world, &bodies);
    let kept = ends.iter().filter(|end| end.y > 0.0).count();
    let per_size = f64::from(size);
    Ok(Figures::default()
        .at_most("speed", f64::from(top_speed(&world, &bodies)) / per_size, 0.05)
        .at_most("deepest", depths.max / per_size, 0.025)
        .at_most("energy gained", gain.most / start, 0.001)
        .none("lost", ends.len() - kept)
        .note("awake", awake as f64)
        .note("highest", f64::from(largest(ends.iter().map(|end| end.y))) / per_size))
}
