//! Cubes that fall slowly on sheets: one layer of triangles, which has no inside.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};
use crate::mesh::{self, Mesh};
use crate::scene::random;

/// Cubes along a side of the square in which they start, the distance between them, and the half
/// of their side.
const ROW: usize = 8;
const SPACING: f32 = 1.6;
const HALF: f32 = 0.3;
/// Side of a sheet, and cells along it.
const SIZE: f32 = 20.0;
const CELLS: u32 = 40;
/// Height of the fall, in units: cubes land at 2 units a second or less.
const DROP: f32 = 0.2;
const STEPS: usize = 240;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (is_bent, bent) in [(false, "flat"), (true, "bent")] {
        for (from_behind, side) in [(false, "front"), (true, "back")] {
            let name = format!("64 cubes on the {side} of a {bent} sheet");
            let run = move |kit: &Kit| run(kit, is_bent, from_behind);
            trials.push(Trial::new(name, run).without_control().seeded());
        }
    }
    trials
}

fn sheet(is_bent: bool, from_behind: bool) -> Mesh {
    let mut sheet = if is_bent { mesh::hills(SIZE, CELLS) } else { mesh::floor(SIZE, CELLS) };
    if from_behind {
        sheet.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    sheet
}

fn run(kit: &Kit, is_bent: bool, from_behind: bool) -> Figures {
    let height = |place: Vec3| {
        let height = mesh::hill_height(SIZE, place.x, place.z);
        if is_bent { height } else { 0.0 }
    };
    let mut world = kit.world();
    let sheet = kit.collider(&Form::mesh(sheet(is_bent, from_behind)));
    world.fix(Vec3::ZERO, sheet);
    let cube = kit.collider(&Form::cuboid(Vec3::splat(HALF), 2));
    let mut random = kit.random();
    for index in 0..ROW * ROW {
        let [x, z] = [index % ROW, index / ROW].map(|k| SPACING * (k as f32 - 3.5));
        let place = Vec3::new(x, 0.0, z);
        // A cube's corners are no farther from its middle than this.
        let up = height(place) + 1.75 * HALF + DROP;
        let turn = random::rotation(&mut random);
        let body = RigidBodyBuilder::dynamic().translation(place.with_y(up));
        world.add(body.rotation(turn.to_scaled_axis()), &cube);
    }
    world.run(STEPS);
    let below = world.places().into_iter().map(|place| height(place) - place.y);
    let kept = below.clone().filter(|&below| below <= 0.0).count();
    Figures::default().none("passed", ROW * ROW - kept).note("lowest", -largest(below))
}
