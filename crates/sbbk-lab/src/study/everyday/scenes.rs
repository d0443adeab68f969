//! Terrains, and the worlds on them.

use crate::prelude::*;
use std::collections::VecDeque;

use rapier3d::control::KinematicCharacterController;
use rapier3d::pipeline::{ActiveEvents, QueryFilter};

use super::measure::{Driven, Everyday};
use super::{BODIES, DEFORMABLE, FINE, FIXED, PILE, SENSORS, SINGLE};

/// A terrain of hills. All worlds of a scene share its mesh.
#[derive(Clone)]
pub(super) struct Ground {
    pub shape: SharedShape,
    flags: TriMeshFlags,
    /// Length of a cell and of a side, in units.
    cell: f32,
    pub size: f32,
    pub triangle_count: u32,
}

/// Distance between bodies at the start, in units. Lower: bodies of some orientations touch.
const SPACING: f32 = 1.6;

impl Ground {
    /// A terrain with so many `cells` of length `cell` along a side.
    pub fn new(cells: u32, cell: f32, flags: TriMeshFlags) -> Self {
        let size = cell * cells as f32;
        let shape = mesh::hills(size, cells).shape_with(flags);
        Self { shape, flags, cell, size, triangle_count: 2 * cells * cells }
    }

    /// A world with the terrain alone.
    pub fn world(&self) -> PhysicsWorld {
        let mut world = PhysicsWorld::new();
        let collider = ColliderBuilder::new(self.shape.clone()).density(0.0);
        world.insert(RigidBodyBuilder::fixed(), collider);
        world
    }

    /// Poses of bodies in a square grid, turned at random, `height` units above the terrain.
    fn poses(&self, count: usize, height: f32, random: &mut Rand32) -> Vec<Pose3> {
        let side = (count as f64).sqrt().ceil() as usize;
        let place = |index: usize| SPACING * (index as f32 - 0.5 * (side as f32 - 1.0));
        let pose = |index: usize| {
            let [x, z] = [index % side, index / side].map(place);
            Pose3::from_parts(above(self.size, [x, z], height), random::rotation(random))
        };
        (0..count).map(pose).collect()
    }

    /// A world with bodies of these shapes, in turn, that fall with random velocities.
    fn scattered(&self, shapes: &[SharedShape], count: usize) -> Driven {
        let (mut world, mut random) = (self.world(), Rand32::new(7));
        let poses = self.poses(count, 1.0, &mut random);
        for (pose, shape) in poses.into_iter().zip(shapes.iter().cycle()) {
            let (way, turn) = (random::direction(&mut random), random::direction(&mut random));
            let body = RigidBodyBuilder::dynamic().pose(pose);
            let body = body.linvel(3.0 * way.with_y(0.0)).angvel(5.0 * turn);
            world.insert(body, ColliderBuilder::new(shape.clone()));
        }
        Driven::alone(world)
    }
}

/// A point above a terrain of this size.
pub(super) fn above(size: f32, [x, z]: [f32; 2], height: f32) -> Vec3 {
    Vec3::new(x, mesh::hill_height(size, x, z) + height, z)
}

/// The head of 968 triangles, 1.2 units across.
pub(super) fn head() -> Mesh {
    mesh::monkey_head().centred().scaled_to(1.2)
}

/// Moves a body to a place, at rest.
pub(super) fn put(world: &mut PhysicsWorld, body: RigidBodyHandle, place: Vec3) {
    let body = &mut world.bodies[body];
    body.set_translation(place, true);
    body.set_linvel(Vec3::ZERO, true);
}

/// Convex shapes of this length by name; the last entry has all of them.
pub(super) fn kinds(length: Real) -> Vec<(&'static str, Vec<SharedShape>)> {
    const NAMES: [&str; 6] = ["ball", "capsule", "cuboid", "cylinder", "cone", "convex polyhedron"];
    let all = crate::study::kinds::kinds(length);
    let of = |name: &'static str| {
        let shapes = all.iter().filter(|kind| kind.name == name);
        (name, shapes.map(|kind| kind.shape.clone()).collect())
    };
    let mut kinds: Vec<(_, Vec<SharedShape>)> = NAMES.map(of).into();
    let mixture = kinds.iter().flat_map(|kind| kind.1.clone()).collect();
    kinds.push(("mixture", mixture));
    kinds
}

/// Bodies of each kind side by side on one terrain, at most `count`.
pub(super) fn bodies(ground: &Ground, count: usize, steps: usize) -> Vec<Everyday<'_>> {
    let side = ((ground.size - 3.0) / SPACING).max(1.0) as usize;
    let count = count.min(side * side);
    let scene = |(name, shapes): (&str, Vec<SharedShape>)| {
        let row = Row::new(BODIES, "")
            .key("triangles", ground.triangle_count)
            .key("side", ground.cell)
            .key("edges", if ground.flags == FIXED { "fixed" } else { "plain" })
            .key("shape", name)
            .with("bodies", count);
        Everyday::new(row, steps, move || ground.scattered(&shapes, count))
    };
    kinds(1.0).into_iter().map(scene).collect()
}

/// Boxes of 12 triangles that slide down a half-space.
pub(super) fn on_half_space(count: usize, steps: usize) -> Everyday<'static> {
    named(SINGLE, format!("{count} mesh boxes on a half-space"), 12, steps, move || {
        let mut world = PhysicsWorld::new();
        let slope = SharedShape::halfspace(Vec3::new(0.1, 1.0, 0.0).normalize());
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(slope).friction(0.0));
        let cuboid = mesh::cuboid(Vec3::new(0.5, 0.4, 0.6), 1);
        let side = (count as f64).sqrt().ceil() as usize;
        for index in 0..count {
            let [x, z] = [index % side, index / side].map(|place| 2.0 * place as f32);
            let body = RigidBodyBuilder::dynamic().translation(Vec3::new(x, 0.41 - 0.1 * x, z));
            world.insert(body, collider(&cuboid).friction(0.0));
        }
        Driven::alone(world)
    })
}

/// A ball and two meshes of about the same size.
fn wanderers() -> [(&'static str, SharedShape); 3] {
    let mesh_ball = mesh::ball(0.5, 8).shape();
    [("ball", SharedShape::ball(0.5)), ("mesh ball", mesh_ball), ("head", head().shape())]
}

/// A ball and meshes, one in each world, that bounce on a terrain, higher than its rim.
pub(super) fn bouncing(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    /// Factor of gravity, and speed upwards after a landing, in units a second.
    const GRAVITY: f32 = 4.0;
    const SPEED: f32 = 24.0;
    let scene = |(name, shape): (&str, SharedShape)| {
        named(SINGLE, format!("a {name} bounces"), ground.triangle_count, steps, move || {
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
            })
        })
    };
    wanderers().map(scene).into()
}

/// A ball and meshes that are carried over a terrain from one side to the other, in contact.
pub(super) fn crossing(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let scene = |(name, shape): (&str, SharedShape)| {
        named(SINGLE, format!("a {name} crosses once"), ground.triangle_count, steps, move || {
            let mut world = ground.world();
            let collider = ColliderBuilder::new(shape.clone());
            let (body, _) = world.insert(RigidBodyBuilder::dynamic(), collider);
            let size = ground.size;
            Driven::by(world, move |world, step| {
                let x = (size - 8.0) * (step as f32 / steps as f32 - 0.5);
                put(world, body, above(size, [x, 0.3 * x], 0.45));
            })
        })
    };
    wanderers().map(scene).into()
}

/// Small meshes, no two alike, that fall on a terrain and are removed: `count` in all.
pub(super) fn rolling_population(ground: &Ground, count: usize) -> Everyday<'_> {
    const AT_ONCE: usize = 150;
    const EACH_STEP: usize = 5;
    let name = format!("{count} small meshes come and go, {AT_ONCE} at once");
    named(SINGLE, name, ground.triangle_count, count / EACH_STEP, move || {
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
                let body = RigidBodyBuilder::dynamic().translation(start);
                bodies.push_back(world.insert(body, collider(&small)).0);
                if bodies.len() > AT_ONCE {
                    bodies.pop_front().map(|oldest| world.remove_body(oldest));
                }
            }
        })
    })
}

/// Balls and heads on a terrain; all meshes have all flags, `DEFORMABLE` among them.
pub(super) fn all_flags(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let head = head().shape_with(TriMeshFlags::all());
    let scenes = [("50 balls", SharedShape::ball(0.5), 50), ("20 heads", head, 20)];
    let scene = |(name, shape, count)| {
        let build = move || ground.scattered(std::slice::from_ref(&shape), count);
        named(DEFORMABLE, name, ground.triangle_count, steps, build)
    };
    scenes.map(scene).into()
}

/// Twenty heads as sensors in slow flight at several heights, and ten characters that walk.
pub(super) fn sensors(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let head = head().shape();
    let sensors = |(place, height): (&str, f32)| {
        let sensor = ColliderBuilder::new(head.clone()).sensor(true);
        let sensor = sensor.active_events(ActiveEvents::COLLISION_EVENTS);
        named(SENSORS, format!("20 sensors {place} it"), ground.triangle_count, steps, move || {
            let mut world = ground.world();
            let poses = ground.poses(20, height, &mut Rand32::new(3));
            let bodies = poses.iter().map(|&pose| {
                let body = RigidBodyBuilder::dynamic().pose(pose).gravity_scale(0.0);
                world.insert(body.additional_mass(1.0), sensor.clone()).0
            });
            let bodies: Vec<RigidBodyHandle> = bodies.collect();
            let size = ground.size;
            Driven::by(world, move |world, step| {
                for (&body, start) in bodies.iter().zip(&poses) {
                    let Vec3 { x, z, .. } = start.translation;
                    put(world, body, above(size, [x + 0.02 * step as f32, z], height));
                }
            })
        })
    };
    let walk =
        named(SENSORS, "10 characters walk", ground.triangle_count, steps, || characters(ground));
    let places = [("in", 0.3), ("near", 0.8), ("above", 2.0)];
    places.map(sensors).into_iter().chain([walk]).collect()
}

/// Capsules moved by Rapier's character controller, which uses casts and contacts.
fn characters(ground: &Ground) -> Driven {
    let mut world = ground.world();
    let shape = SharedShape::capsule_y(0.4, 0.3);
    let poses = ground.poses(10, 0.9, &mut Rand32::new(4)).into_iter();
    let walkers = poses.map(|pose| {
        let body = RigidBodyBuilder::kinematic_position_based().translation(pose.translation);
        world.insert(body, ColliderBuilder::new(shape.clone())).0
    });
    let walkers: Vec<_> = walkers.collect();
    let controller = KinematicCharacterController::default();
    let mut random = Rand32::new(6);
    let ways = walkers.iter().map(|_| 3.0 * random::direction(&mut random).with_y(-0.3));
    let ways: Vec<Vec3> = ways.collect();
    let drive = move |world: &mut PhysicsWorld, _| {
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
    };
    Driven { world, drive: Box::new(drive) }
}

/// The paper's second scene.
pub(super) fn pile(heads: usize, steps: usize) -> Everyday<'static> {
    let pile = MonkeyPile::with_heads(heads);
    let row = Row::new(PILE, "").key("scene", pile.name());
    Everyday::new(row, steps, move || Driven::alone(pile.build().world))
}

/// Thirty tori in a pile, with so many segments around the tube and three times as many along it.
pub(super) fn tori(tube: u32, steps: usize) -> Everyday<'static> {
    let pile = MonkeyPile::of(30, mesh::torus(1.0, 0.4, 3 * tube, tube));
    let triangles = pile.mesh.triangle_count();
    let build = move || Driven::alone(pile.build().world);
    named(FINE, "30 tori in a pile", triangles, steps, build)
}

/// Like [`tori`], with the convex parts into which Parry decomposes a torus.
pub(super) fn decomposed_tori(tube: u32, steps: usize) -> Everyday<'static> {
    let pile = MonkeyPile::of(30, mesh::torus(1.0, 0.4, 3 * tube, tube));
    let start = Instant::now();
    let parts = SharedShape::convex_decomposition(&pile.mesh.vertices, &pile.mesh.triangles);
    let load = start.elapsed().as_secs_f64();
    let count = parts.as_compound().map_or(1, |parts| parts.shapes().len());
    let (name, triangles) = ("30 tori of convex parts in a pile", pile.mesh.triangle_count());
    let mut scene = named(FINE, name, triangles, steps, move || {
        let mut world = pile.build().world;
        let meshes = world.colliders.iter_mut().map(|(_, collider)| collider);
        let meshes = meshes.filter(|collider| collider.shape().as_trimesh().is_some());
        meshes.for_each(|collider| collider.set_shape(parts.clone()));
        Driven::alone(world)
    });
    scene.row = scene.row.with("parts", count).with("load_seconds", load);
    scene
}

/// A torus that slides along another one, both with so many segments around the tube.
#[cfg(feature = "parallel")]
pub(super) fn two_tori(tube: u32, steps: usize) -> Everyday<'static> {
    let torus = mesh::torus(1.0, 0.4, 3 * tube, tube);
    let (triangles, torus) = (torus.triangle_count(), torus.shape());
    named(FINE, "a torus that slides along another", triangles, steps, move || {
        let mut world = PhysicsWorld::new();
        // The body moves less than what Rapier takes for rest.
        world.integration_parameters.contact_recycling = false;
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(torus.clone()));
        let place = |step: usize| Vec3::new(0.002 * step as f32, 0.79, 0.1);
        let turned = Pose3::from_parts(place(0), Quat::from_rotation_y(0.2));
        let body = RigidBodyBuilder::dynamic().pose(turned).lock_rotations();
        let (body, _) = world.insert(body, ColliderBuilder::new(torus.clone()));
        Driven::by(world, move |world, step| put(world, body, place(step)))
    })
}

/// Heads of 2 to 5 cm that fall into a bowl at Rapier's default length unit.
pub(super) fn parts(steps: usize) -> Everyday<'static> {
    const COUNT: usize = 12;
    let bowl = ColliderBuilder::new(mesh::vessel(0.15, 24, 0.3).shape());
    let head = mesh::monkey_head_with(6).centred();
    let triangles = head.triangle_count();
    let part = |i: usize| collider(&head.clone().scaled_to(0.02 + 0.01 * (i % 4) as f32));
    let parts: Vec<ColliderBuilder> = (0..COUNT).map(part).collect();
    let name = format!("{COUNT} heads of 2 to 5 cm in a bowl");
    named(FINE, name, triangles, steps, move || {
        let (mut world, mut random) = (PhysicsWorld::new(), Rand32::new(5));
        world.insert(RigidBodyBuilder::fixed(), bowl.clone());
        for (i, part) in parts.iter().enumerate() {
            let [x, y, z] = [i % 2, i / 4, i / 2 % 2].map(|place| 0.06 * place as f32);
            let place = Vec3::new(x - 0.03, y, z - 0.03);
            let pose = Pose3::from_parts(place, random::rotation(&mut random));
            world.insert(RigidBodyBuilder::dynamic().pose(pose), part.clone());
        }
        Driven::alone(world)
    })
}

/// A scene with a name, and with so many triangles of its terrain or of each body.
pub(super) fn named<'a>(
    study: &'static str,
    name: impl ToString,
    triangles: impl ToString,
    steps: usize,
    build: impl Fn() -> Driven + 'a,
) -> Everyday<'a> {
    let row = Row::new(study, "").key("scene", name).key("triangles", triangles);
    Everyday::new(row, steps, build)
}
