//! A wall of bricks, and a house of cards.

use glamx::{Pose3, Quat, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};

const STEPS: usize = 480;

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for cells in [1, 4] {
        let triangles = 12 * cells * cells;
        let wall = move |kit: &Kit| run(kit, cells, &wall(), 0.5, 0.03);
        trials.push(Trial::new(format!("wall of bricks of {triangles} triangles"), wall));
        let house = move |kit: &Kit| run(kit, cells, &house(), 0.8, 0.1);
        trials.push(Trial::new(format!("house of cards of {triangles} triangles"), house));
    }
    trials
}

const BRICK: Vec3 = Vec3::new(0.5, 0.25, 0.25);
const ROWS: usize = 5;
const COLUMNS: usize = 6;
/// Between two bricks of a row.
const JOINT: f32 = 0.002;

/// Running bond, with half bricks at the ends of every second row; each touches those below.
fn wall() -> Vec<(Vec3, Pose3)> {
    let width = 2.0 * BRICK.x + JOINT;
    let mut bricks = Vec::new();
    for row in 0..ROWS {
        let half = BRICK * Vec3::new(0.5, 1.0, 1.0) - Vec3::X * 0.25 * JOINT;
        let shift = width * (0.5 - 0.5 * COLUMNS as f32);
        let y = BRICK.y * (2 * row + 1) as f32;
        let mut put = |size: Vec3, x: f32| {
            bricks.push((size, Pose3::translation(x * width + shift, y, 0.0)));
        };
        match row % 2 {
            0 => (0..COLUMNS).for_each(|column| put(BRICK, column as f32)),
            _ => {
                (1..COLUMNS).for_each(|column| put(BRICK, column as f32 - 0.5));
                [-0.25, COLUMNS as f32 - 0.75].into_iter().for_each(|x| put(half, x));
            }
        }
    }
    bricks
}

/// Upright.
const CARD: Vec3 = Vec3::new(0.01, 0.5, 0.4);
/// Lean of the cards, in radians.
const LEAN: f32 = 0.35;

/// Two pairs that lean against each other, a card across, and a pair on it.
fn house() -> Vec<(Vec3, Pose3)> {
    let (sin, cos) = LEAN.sin_cos();
    // From its middle to its highest point, and to the edge that leans on the other card.
    let up = CARD.x * sin + CARD.y * cos;
    let aside = CARD.x * cos + CARD.y * sin;
    let pair = |x: f32, floor: f32| {
        [-1.0, 1.0].map(|side| {
            let place = Vec3::new(x + side * aside, floor + up, 0.0);
            Pose3::from_parts(place, Quat::from_rotation_z(side * LEAN))
        })
    };
    let foot = 2.0 * CARD.y * sin + 0.01;
    let across = Pose3::from_parts(
        Vec3::Y * (2.0 * up + CARD.x),
        Quat::from_rotation_z(std::f32::consts::FRAC_PI_2),
    );
    let upper = pair(0.0, 2.0 * (up + CARD.x));
    let poses = [&pair(-foot, 0.0)[..], &pair(foot, 0.0), &[across], &upper].concat();
    poses.into_iter().map(|pose| (CARD, pose)).collect()
}

/// Boxes, each with half its sides.
fn run(kit: &Kit, cells: u32, boxes: &[(Vec3, Pose3)], friction: f32, limit: f64) -> Figures {
    let mut world = kit.world();
    let floor = kit.collider(&Form::cuboid(Vec3::new(6.0, 0.5, 6.0), cells));
    world.fix(-0.5 * Vec3::Y, floor.friction(friction));
    for &(half_extents, pose) in boxes {
        let collider = kit.collider(&Form::cuboid(half_extents, cells)).friction(friction);
        world.add(RigidBodyBuilder::dynamic().pose(pose), &collider);
    }
    world.run(STEPS);
    let drifts =
        boxes.iter().zip(world.places()).map(|((_, start), end)| start.translation.distance(end));
    Figures::default().at_most("drift", largest(drifts), limit)
}
