//! The worlds.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::control::KinematicCharacterController;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{ColliderBuilder, SharedShape, TriMeshFlags};
use rapier3d::pipeline::{ActiveEvents, QueryFilter};

use super::ground::{Ground, above, head, kinds, put};
use super::measure::{Driven, Everyday};
use super::{BODIES, DEFORMABLE, GroundPlan, PILE, SENSORS, SINGLE};
use crate::mesh;
use crate::report::Row;
use crate::scene::{MonkeyPile, Scene, Solid, random, shape};

/// Bodies of each kind on one terrain.
pub(super) fn bodies<'a>(
    plan: GroundPlan,
    ground: &'a Ground,
    count: usize,
    steps: usize,
) -> Vec<Everyday<'a>> {
    let scene = |(name, shapes): (&str, Vec<SharedShape>)| {
        let count = ground.room(count);
        let row = Row::new(BODIES, "")
            .key("triangles", ground.triangle_count)
            .key("side", plan.cell.to_string())
            .key("edges", if plan.fixes_edges { "fixed" } else { "plain" })
            .key("shape", name)
            .with("bodies", count);
        let build = move || {
            let mut world = ground.world();
            ground.scatter(&mut world, &shapes, count);
            Driven::alone(world)
        };
        Everyday::new(row, steps, build)
    };
    kinds(1.0).into_iter().map(scene).collect()
}

/// A ball and meshes, one in each world, that bounce on a terrain, higher than its rim.
pub(super) fn bouncing(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    /// Factor of gravity, and speed upwards after a landing, in units a second.
    const GRAVITY: f32 = 4.0;
    const SPEED: f32 = 24.0;
    let scene = |(name, shape): (&str, SharedShape)| {
        named(SINGLE, &format!("a {name} bounces"), ground, steps, move || {
            let mut world = ground.world();
            let start = above(ground.size, [1.0, 1.0], 7.0);
            let body = RigidBodyBuilder::dynamic().translation(start).gravity_scale(GRAVITY);
            let collider = ColliderBuilder::new(shape.clone()).restitution(0.7);
            let (body, _) = world.insert(body, collider);
            Driven::by(world, move |world, _| {
                let body = &mut world.bodies[body];
                let up = body.linvel().y;
                let is_landing = up > 0.0 && body.translation().y < start.y - 5.0;
                body.set_linvel(Vec3::Y * if is_landing { SPEED } else { up }, true);
                Duration::ZERO
            })
        })
    };
    wanderers().map(scene).into()
}

/// A ball and meshes that are carried over a terrain from one side to the other, in contact.
pub(super) fn crossing(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let scene = |(name, shape): (&str, SharedShape)| {
        named(SINGLE, &format!("a {name} crosses once"), ground, steps, move || {
            let mut world = ground.world();
            let collider = ColliderBuilder::new(shape.clone());
            let (body, _) = world.insert(RigidBodyBuilder::dynamic(), collider);
            let size = ground.size;
            Driven::by(world, move |world, step| {
                let x = (size - 8.0) * (step as f32 / steps as f32 - 0.5);
                put(world, body, above(size, [x, 0.3 * x], 0.45));
                Duration::ZERO
            })
        })
    };
    wanderers().map(scene).into()
}

/// Small meshes, no two alike, that fall on a terrain and are removed: `count` in all.
pub(super) fn rolling_population(ground: &Ground, count: usize) -> Everyday<'_> {
    const AT_ONCE: usize = 150;
    const EACH_STEP: usize = 5;
    let steps = count / EACH_STEP;
    let name = format!("{count} small meshes come and go, {AT_ONCE} at once");
    named(SINGLE, &name, ground, steps, move || {
        let mut random = Rand32::new(5);
        let mut bodies: VecDeque<RigidBodyHandle> = VecDeque::new();
        let (size, mut made) = (ground.size, 0);
        Driven::by(ground.world(), move |world, step| {
            while made < EACH_STEP * (step + 1) {
                made += 1;
                let mut between = |low: f32, high: f32| low + (high - low) * random.rand_float();
                let stretch = Vec3::from_array([(); 3].map(|()| between(0.3, 0.6)));
                let start = above(size, [(); 2].map(|()| between(-8.0, 8.0)), 1.5);
                let small = mesh::ball(1.0, made as u32 % 5 + 2).mapped(|vertex| stretch * vertex);
                let solid = Solid::new(&small);
                let body = RigidBodyBuilder::dynamic().translation(start);
                bodies.push_back(world.insert(body, solid.collider()).0);
                if bodies.len() > AT_ONCE {
                    bodies.pop_front().map(|oldest| world.remove_body(oldest));
                }
            }
            Duration::ZERO
        })
    })
}

/// Balls and heads on a terrain; all meshes have all flags, `DEFORMABLE` among them.
pub(super) fn all_flags(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let head = shape(&head(), TriMeshFlags::all());
    let scenes = [("50 balls", SharedShape::ball(0.5), 50), ("20 heads", head, 20)];
    let scene = |(name, shape, count)| {
        named(DEFORMABLE, name, ground, steps, move || {
            let mut world = ground.world();
            ground.scatter(&mut world, std::slice::from_ref(&shape), count);
            Driven::alone(world)
        })
    };
    scenes.map(scene).into()
}

/// Twenty heads as sensors in slow flight at several heights, and ten characters that walk.
pub(super) fn sensors(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    const SPEED: f32 = 0.02;
    let head = shape(&head(), TriMeshFlags::empty());
    let places = [("in", 0.3), ("near", 0.8), ("above", 2.0)];
    let mut scenes: Vec<Everyday<'_>> = Vec::new();
    for (place, height) in places {
        let head = head.clone();
        scenes.push(named(SENSORS, &format!("20 sensors {place} it"), ground, steps, move || {
            let mut world = ground.world();
            let poses = ground.poses(20, height, &mut Rand32::new(3));
            let sensor = ColliderBuilder::new(head.clone()).sensor(true);
            let sensor = sensor.active_events(ActiveEvents::COLLISION_EVENTS);
            let bodies = poses.iter().map(|&pose| {
                let body = RigidBodyBuilder::dynamic().pose(pose).gravity_scale(0.0);
                world.insert(body.additional_mass(1.0), sensor.clone()).0
            });
            let bodies: Vec<RigidBodyHandle> = bodies.collect();
            let size = ground.size;
            Driven::by(world, move |world, step| {
                for (&body, start) in bodies.iter().zip(&poses) {
                    let Vec3 { x, z, .. } = start.translation;
                    put(world, body, above(size, [x + SPEED * step as f32, z], height));
                }
                Duration::ZERO
            })
        }));
    }
    scenes.push(named(SENSORS, "10 characters walk", ground, steps, || characters(ground)));
    scenes
}

/// Capsules moved by Rapier's character controller, which uses casts and contacts.
fn characters(ground: &Ground) -> Driven {
    let mut world = ground.world();
    let shape = SharedShape::capsule_y(0.4, 0.3);
    let mut poses = ground.poses(10, 0.9, &mut Rand32::new(4));
    let walkers: Vec<_> = poses
        .iter_mut()
        .map(|pose| {
            *pose = Pose3::from_translation(pose.translation);
            let body = RigidBodyBuilder::kinematic_position_based().pose(*pose);
            world.insert(body, ColliderBuilder::new(shape.clone())).0
        })
        .collect();
    let controller = KinematicCharacterController::default();
    let ways: Vec<Vec3> = {
        let mut random = Rand32::new(6);
        walkers.iter().map(|_| 3.0 * random::direction(&mut random).with_y(-0.3)).collect()
    };
    Driven::by(world, move |world, _| {
        let time_step = world.integration_parameters.dt;
        let start = Instant::now();
        let moves = walkers.iter().zip(&ways).map(|(&walker, &way)| {
            let filter = QueryFilter::default().exclude_rigid_body(walker);
            let queries = world.query_pipeline_with_filter(filter);
            let pose = world.bodies[walker].position();
            let way = time_step * way;
            controller.move_shape(time_step, &queries, &*shape, pose, way, |_| ()).translation
        });
        let moves: Vec<Vec3> = moves.collect();
        let asked = start.elapsed();
        for (&walker, translation) in walkers.iter().zip(moves) {
            let walker = &mut world.bodies[walker];
            walker.set_next_kinematic_translation(walker.translation() + translation);
        }
        asked
    })
}

/// The paper's second scene.
pub(super) fn pile(heads: usize, steps: usize) -> Everyday<'static> {
    let pile = MonkeyPile::with_heads(heads);
    let row = Row::new(PILE, "").key("scene", pile.name());
    let build = move || Driven::alone(pile.build().world);
    Everyday::new(row, steps, build)
}

fn named<'a>(
    study: &'static str,
    name: &str,
    ground: &Ground,
    steps: usize,
    build: impl Fn() -> Driven + 'a,
) -> Everyday<'a> {
    let row = Row::new(study, "").key("scene", name).key("triangles", ground.triangle_count);
    Everyday::new(row, steps, build)
}

/// A ball and two meshes of about the same size.
fn wanderers() -> [(&'static str, SharedShape); 3] {
    let mesh = |mesh| shape(&mesh, TriMeshFlags::empty());
    [
        ("ball", SharedShape::ball(0.5)),
        ("mesh ball", mesh(mesh::ball(0.5, 8))),
        ("head", mesh(head())),
    ]
}
