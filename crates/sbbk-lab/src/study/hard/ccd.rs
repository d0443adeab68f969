//! Thin and fast bodies.

use std::f32::consts::{FRAC_PI_3, TAU};

use glamx::{Pose3, Quat, Vec2, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::SharedShape;
use rapier3d::parry::query;

use super::Trial;
use super::depth::Depths;
use super::figures::Figures;
use super::kit::{Form, Kit};
use crate::mesh::{self, Mesh};
use crate::scene::random;
use crate::study::shape;

/// Thickness of plates that are a unit wide.
const THICKNESS: f32 = 0.03;
const PHASES: usize = 8;
/// Time of one step, in seconds.
const STEP: f32 = 1.0 / 60.0;

/// Target of the plates.
#[derive(Clone, Copy)]
enum Target {
    Floor,
    Slab,
    Spike,
    Edge,
}

pub(super) fn trials() -> Vec<Trial> {
    let targets = [
        (Target::Floor, "a floor"),
        (Target::Slab, "a slab"),
        (Target::Spike, "a spike"),
        (Target::Edge, "an edge"),
    ];
    let mut trials: Vec<Trial> = Vec::new();
    for (target, name) in targets {
        let name = format!("8 plates at 30 m/s onto {name}");
        trials.push(Trial::new(name, move |kit| plates(kit, target)).without_control());
    }
    trials.push(Trial::new("8 pairs of boxes that meet at 120 units/s", boxes));
    for cell in [0.5, 5.0] {
        let name = format!("60 thin slabs dropped on a floor of triangles of {cell}");
        trials.push(Trial::new(name, move |kit| slabs(kit, cell)).without_control());
    }
    trials
}

impl Target {
    /// Its highest point is at the origin.
    fn mesh(self) -> Mesh {
        const DEPTH: f32 = 4.0;
        let half = DEPTH * (0.5 * FRAC_PI_3).tan();
        match self {
            Self::Floor => mesh::floor(10.0, 20),
            Self::Slab => mesh::slab(Vec3::new(5.0, 0.5, 5.0), [4, 1, 4])
                .mapped(|vertex| vertex - 0.5 * Vec3::Y),
            Self::Spike => {
                let profile = [Vec2::new(0.0, -DEPTH), Vec2::new(half, -DEPTH), Vec2::ZERO];
                mesh::revolved(&profile, 16)
            }
            Self::Edge => {
                let half_height = 0.5 * DEPTH;
                let outline = [
                    Vec2::new(0.0, half_height),
                    Vec2::new(-half, -half_height),
                    Vec2::new(half, -half_height),
                ];
                mesh::prism(&outline, 5.0).mapped(|vertex| vertex - half_height * Vec3::Y)
            }
        }
    }
}

/// Steps in which the middle of a plate may be in the target, before it has passed.
const STUCK: usize = 4;

/// Plates that fly down at several turns and places. A plate has passed if it ends below the target.
/// It has passed, too, if its middle is in the target, or a tip crosses both its faces, for longer
/// than an impact.
fn plates(kit: &Kit, target: Target) -> Figures {
    const SPEED: f32 = 30.0;
    let mesh = target.mesh();
    let fixed = kit.collider(&Form::mesh(mesh.clone()));
    let surface = shape(&mesh);
    let inside = Depths::new(&mesh);
    let half_extents = Vec3::new(0.5, 0.5 * THICKNESS, 0.5);
    let plate = kit.collider(&Form::cuboid(half_extents, 4));
    let face = SharedShape::cuboid(0.45, 0.01 * THICKNESS, 0.45);
    let is_pointed = matches!(target, Target::Spike | Target::Edge);
    let mut passed = 0;
    for index in 0..PHASES {
        let phase = index as f32 / PHASES as f32;
        let mut world = kit.world();
        world.fix(Vec3::ZERO, fixed.clone());
        let turn = Quat::from_rotation_y(phase * TAU) * Quat::from_rotation_x(0.6 * phase);
        let place = Vec3::new(0.1 * phase, 2.0 + phase * SPEED * STEP, 0.05);
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        let body = body.linvel(-SPEED * Vec3::Y).soft_ccd_prediction(0.6);
        let body = world.add(body, &plate);
        let mut stuck = 0;
        for _ in 0..60 {
            world.step();
            let pose = *world.bodies[body].position();
            let is_pierced = is_pointed
                && [-0.4, 0.4].into_iter().all(|side| {
                    let pose = pose * Pose3::translation(0.0, side * THICKNESS, 0.0);
                    let meets =
                        query::intersection_test(&pose, &*face, &Pose3::IDENTITY, &*surface);
                    meets.is_ok_and(|meets| meets.intersecting)
                });
            let is_inside = inside.of(pose.translation) > THICKNESS;
            stuck += usize::from(is_pierced || is_inside);
        }
        let end = world.bodies[body].translation();
        // Beside a spike or an edge it may well be below the top.
        let is_below = !is_pointed && end.y < -0.5 * THICKNESS;
        passed += usize::from(is_below || stuck > STUCK || !end.is_finite());
    }
    Figures::default().none("passed", passed)
}

/// Boxes that fly at each other without gravity, at several phases of a step.
fn boxes(kit: &Kit) -> Figures {
    const SPEED: f32 = 60.0;
    // Smaller cuboids of Rapier's own pass through each other.
    const HALF: f32 = 1.0;
    let collider = kit.collider(&Form::cuboid(Vec3::splat(HALF), 4));
    let mut passed = 0;
    for index in 0..PHASES {
        let mut world = kit.world();
        world.gravity = Vec3::ZERO;
        let distance = 4.0 + SPEED * STEP * index as f32 / PHASES as f32;
        let bodies = [-1.0, 1.0].map(|side| {
            let place = Vec3::new(side * distance, 0.0, 0.0);
            let body = RigidBodyBuilder::dynamic().translation(place);
            let body = body.linvel(-side * SPEED * Vec3::X).soft_ccd_prediction(2.5);
            world.add(body, &collider)
        });
        world.run(60);
        let [left, right] = bodies.map(|body| world.bodies[body].translation().x);
        let are_apart = right - left > 1.8 * HALF;
        passed += usize::from(!are_apart);
    }
    Figures::default().none("passed", passed)
}

/// Slabs that fall from a unit above, turned at random.
fn slabs(kit: &Kit, cell: f32) -> Figures {
    const SIZE: f32 = 10.0;
    let floor = kit.collider(&Form::mesh(mesh::floor(SIZE, (SIZE / cell) as u32)));
    let slab = kit.collider(&Form::cuboid(Vec3::new(0.5, 0.5 * THICKNESS, 0.5), 1));
    let mut random = kit.random();
    let mut passed = 0;
    for _ in 0..60 {
        let mut world = kit.world();
        world.fix(Vec3::ZERO, floor.clone());
        let pose = Pose3::from_parts(Vec3::new(0.1, 1.75, 0.2), random::rotation(&mut random));
        let body = world.add(RigidBodyBuilder::dynamic().pose(pose), &slab);
        world.run(150);
        let is_above = world.bodies[body].translation().y > 0.0;
        passed += usize::from(!is_above);
    }
    Figures::default().none("passed", passed)
}
