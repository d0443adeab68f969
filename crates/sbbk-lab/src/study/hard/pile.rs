//! Heads that fall on a floor and come to rest on each other.

use std::time::Instant;

use glamx::{Pose3, Vec3};
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::depth::{Depths, PairDepths, touching_pairs};
use super::figures::{Figures, Gain, energy, largest, places};
use super::kit::{Form, Kit, World};
use super::report::STEP_TIME;
use crate::metrics::{Summary, solver_points};
use crate::scene::{MonkeyPile, SceneError};

/// Steps until the heads are judged by their depth, and until they are judged by their height.
const DEEP_AT: usize = 120;
const HIGH_AT: usize = 180;
/// Times and contacts are those of the steps after this one.
const FULL_AT: usize = 60;
/// Pairs whose depth is judged.
const PAIRS: usize = 150;
/// Half extents of the floor.
pub(super) const FLOOR: Vec3 = Vec3::new(100.0, 1.0, 100.0);

pub(super) fn trials(heads: &[usize]) -> Vec<Trial> {
    let trial = |&heads: &usize| {
        let name = format!("pile of {heads} heads");
        Trial::new(name, move |kit| run(kit, heads)).without_control().seeded()
    };
    heads.iter().map(trial).collect()
}

/// A floor, whose top is at height 0, and above it bodies that do not sleep.
pub(super) fn build(
    kit: &Kit,
    floor: Vec3,
    poses: impl IntoIterator<Item = Pose3>,
    collider: &ColliderBuilder,
) -> (World, Vec<RigidBodyHandle>) {
    let mut world = kit.world();
    let Vec3 { x, y, z } = floor;
    world.insert(
        RigidBodyBuilder::fixed().translation(-y * Vec3::Y),
        ColliderBuilder::cuboid(x, y, z),
    );
    let bodies = poses.into_iter().map(|pose| {
        world.insert(RigidBodyBuilder::dynamic().pose(pose).can_sleep(false), collider.clone()).0
    });
    let bodies = bodies.collect();
    (world, bodies)
}

fn run(kit: &Kit, heads: usize) -> Result<Figures, SceneError> {
    let pile = MonkeyPile { seed: kit.seed, ..MonkeyPile::with_heads(heads) };
    let collider = kit.collider(&Form::mesh(pile.mesh.clone()))?;
    let (mut world, bodies) = build(kit, FLOOR, pile.poses(), &collider);
    let start = energy(&world, &bodies);
    let (mut gain, mut deep) = (Gain::default(), PairDepths::default());
    let (mut times, mut points) = (Vec::new(), 0.0);
    for step in 1..=HIGH_AT {
        let clock = Instant::now();
        world.step();
        let time = 1e3 * clock.elapsed().as_secs_f64();
        gain.see(energy(&world, &bodies));
        if step > FULL_AT {
            times.push(time);
            points += solver_points(&world) as f64 / (HIGH_AT - FULL_AT) as f64;
        }
        if step == DEEP_AT {
            deep = touching_pairs(&world, &Depths::new(&pile.mesh)?, PAIRS);
        }
    }
    let heights = places(&world, &bodies).into_iter().map(|place| place.y);
    let mean_height = heights.clone().sum::<f32>() / bodies.len() as f32;
    Ok(Figures::default()
        .within("mean height", mean_height, 0.9, 1.4)
        .at_most("highest", largest(heights), 4.5)
        .at_most("deepest", deep.max, 0.05)
        .at_most("mean depth", deep.mean, 0.001)
        .at_most("energy gained", gain.most / start, 0.001)
        .at_most("points a step", points, 4000.0 / 200.0 * heads as f64)
        .note(STEP_TIME, Summary::of(times).map_or(f64::NAN, |times| times.median)))
}
