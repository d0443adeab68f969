//! Towers of cubes.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};

/// Cubes of a tower, and steps.
const CUBES: usize = 10;
const STEPS: usize = 600;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for cells in [1, 10] {
        for (gap, place) in [(0.0, "touching"), (0.01, "1 cm apart")] {
            let name = format!("stack of cubes of {} triangles, {place}", 12 * cells * cells);
            trials.push(Trial::new(name, move |kit| run(kit, cells, gap)));
        }
    }
    trials
}

fn run(kit: &Kit, cells: u32, gap: f32) -> Figures {
    let mut world = kit.world();
    let floor = kit.collider(&Form::cuboid(Vec3::new(5.0, 0.5, 5.0), cells));
    world.fix(-0.5 * Vec3::Y, floor);
    let cube = kit.collider(&Form::cuboid(Vec3::splat(0.5), cells));
    let start = |index: usize| Vec3::Y * (0.5 + gap + index as f32 * (1.0 + gap));
    for index in 0..CUBES {
        world.add(RigidBodyBuilder::dynamic().translation(start(index)), &cube);
    }
    world.run(STEPS);
    let ends = world.places();
    let drift = largest(ends.iter().map(|end| end.with_y(0.0).length()));
    let fallen = (0..CUBES).filter(|&index| (ends[index].y - 0.5 - index as f32).abs() > 0.1);
    Figures::default().at_most("drift", drift, 0.03).none("fallen", fallen.count())
}
