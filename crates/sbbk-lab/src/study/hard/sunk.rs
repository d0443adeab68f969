//! Boxes that start in a slab, or in the ground.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};

/// The lowest points of boxes of a unit start so deep below the slab's upper side.
const DEPTHS: usize = 10;
const LEAST: f32 = 0.1;
const MOST: f32 = 1.2;
/// Greatest depth in the ground. Bodies wholly below it are left alone, as in a cave.
const MOST_IN_GROUND: f32 = 0.9;
const STEPS: usize = 180;
/// Difference of the ways up and down, in units, below which either is right.
const DOUBT: f32 = 0.25;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for cells in [1, 8] {
        let triangles = 12 * cells * cells;
        for thickness in [2.0, 0.8] {
            let name = format!("boxes in a slab of {thickness}, {triangles} triangles each");
            trials.push(Trial::new(name, move |kit| {
                let slab = Form::cuboid(Vec3::new(5.0, 0.5 * thickness, 5.0), cells);
                run(
                    kit,
                    kit.collider(&slab).translation(-0.5 * thickness * Vec3::Y),
                    thickness,
                    cells,
                )
            }));
        }
        let name = format!("boxes in a height field, {triangles} triangles each");
        let trial = Trial::new(name, move |kit| {
            let field = ColliderBuilder::new(kit.flat_field([10 * cells; 2], Vec3::splat(10.0)));
            run(kit, field, f32::INFINITY, cells)
        });
        trials.push(trial.without_control());
    }
    trials
}

/// With a ground, of so much thickness, whose upper side is at height 0.
fn run(kit: &Kit, ground: ColliderBuilder, thickness: f32, cells: u32) -> Figures {
    let cube = kit.collider(&Form::cuboid(Vec3::splat(0.5), cells));
    let most = if thickness.is_finite() { MOST } else { MOST_IN_GROUND };
    let (mut inside, mut wrong_side, mut fastest) = (0, 0, 0.0_f32);
    for index in 0..DEPTHS {
        let depth = LEAST + (most - LEAST) * index as f32 / (DEPTHS - 1) as f32;
        let mut world = kit.world();
        world.fix(Vec3::ZERO, ground.clone());
        let body = RigidBodyBuilder::dynamic().translation(Vec3::Y * (0.5 - depth));
        let body = world.add(body, &cube);
        // One that has left below may fall as fast as it likes.
        let (mut left_below, mut lowest_speed) = (false, 0.0);
        for _ in 0..STEPS {
            world.step();
            left_below |= world.bodies[body].translation().y < -thickness - 0.45;
            if !left_below {
                lowest_speed = largest([lowest_speed, world.top_speed()]);
            }
        }
        fastest = largest([fastest, lowest_speed]);
        let is_above = world.bodies[body].translation().y > 0.45;
        // Down it is the slab's thickness and the box, less the way up.
        let shorter_down = depth - (thickness + 1.0 - depth);
        inside += usize::from(!is_above && !left_below);
        wrong_side += usize::from(
            (is_above && shorter_down > DOUBT) || (left_below && shorter_down < -DOUBT),
        );
    }
    Figures::default()
        .none("stay", inside)
        .none("on the far side", wrong_side)
        .at_most("speed", fastest, 5.0)
}
