//! Heads that fall on a floor and come to rest on each other.

use glamx::{Pose3, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::depth::{Depths, PairDepths, touching_pairs};
use super::figures::{Figures, largest};
use super::kit::{Form, Kit, World};
use super::report::STEP_TIME;
use crate::mesh::Mesh;
use crate::scene::MonkeyPile;

/// Steps until the heads are judged by their depth, and until they are judged by their height.
const DEEP_AT: usize = 120;
const HIGH_AT: usize = 180;
/// Step after which times and contacts are measured.
const FULL_AT: usize = 60;
/// Pairs whose depth is judged.
const PAIRS: usize = 150;
/// Half extents of the floor.
pub(super) const FLOOR: Vec3 = Vec3::new(100.0, 1.0, 100.0);

/// Limits of a mesh.
#[derive(Copy, Clone)]
struct Limits {
    /// The least and the greatest mean height.
    heights: [f64; 2],
    /// The most points that the solver gets of each body.
    points: f64,
}

impl Limits {
    const HEADS: Self = Self { heights: [0.9, 1.4], points: 20.0 };
    const NONE: Self = Self { heights: [0.0, f64::INFINITY], points: f64::INFINITY };
}

/// Piles of so many heads, or of another mesh.
pub(super) fn trials(heads: &[usize], mesh: Option<&Mesh>) -> Vec<Trial> {
    let trial = |&heads: &usize| {
        let (name, pile, limits) = match mesh {
            Some(mesh) => (&*mesh.name, MonkeyPile::of(heads, mesh.clone()), Limits::NONE),
            None => ("heads", MonkeyPile::with_heads(heads), Limits::HEADS),
        };
        let run = move |kit: &Kit| run(kit, &pile, limits);
        Trial::new(format!("pile of {heads} {name}"), run).without_control().seeded()
    };
    heads.iter().map(trial).collect()
}

/// A floor, whose top is at height 0, and above it bodies that do not sleep.
pub(super) fn build(
    kit: &Kit,
    floor: Vec3,
    poses: impl IntoIterator<Item = Pose3>,
    collider: &ColliderBuilder,
) -> World {
    let mut world = kit.world();
    let Vec3 { x, y, z } = floor;
    world.fix(-y * Vec3::Y, ColliderBuilder::cuboid(x, y, z));
    for pose in poses {
        world.add(RigidBodyBuilder::dynamic().pose(pose).can_sleep(false), collider);
    }
    world
}

fn run(kit: &Kit, pile: &MonkeyPile, limits: Limits) -> Figures {
    let Limits { heights: [lowest, highest], points } = limits;
    let (pile, heads) = (MonkeyPile { seed: kit.seed, ..pile.clone() }, pile.heads);
    let collider = kit.collider(&Form::mesh(pile.mesh.clone()));
    let mut world = build(kit, FLOOR, pile.poses(), &collider);
    let (depths, mut deep) = (Depths::new(&pile.mesh), PairDepths::default());
    let watched = world.watch(HIGH_AT, FULL_AT, |world, step| {
        if step == DEEP_AT {
            deep = touching_pairs(world, &depths, PAIRS);
        }
    });
    let heights = world.places().into_iter().map(|place| place.y);
    let mean_height = heights.clone().sum::<f32>() / heads as f32;
    Figures::default()
        .within("mean height", mean_height, lowest, highest)
        .at_most("highest", largest(heights), 4.5)
        .at_most("deepest", deep.max, 0.05)
        .at_most("mean depth", deep.mean, 0.001)
        .at_most("energy gained", watched.gain, 0.001)
        .at_most("points a step", watched.points, points * heads as f64)
        .note(STEP_TIME, watched.step_time)
}
