//! Terrains, and bodies on them.

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{ColliderBuilder, SharedShape, TriMeshFlags};
use rapier3d::math::Real;
use rapier3d::pipeline::PhysicsWorld;

use crate::mesh::{self, Mesh};
use crate::scene::{random, shape};

/// A terrain of hills. All worlds of a scene share its mesh.
#[derive(Clone)]
pub(super) struct Ground {
    pub shape: SharedShape,
    /// Length of a side, in units.
    pub size: f32,
    pub triangle_count: u32,
}

/// Distance between bodies at the start, in units. Lower: bodies of some orientations touch.
const SPACING: f32 = 1.6;

impl Ground {
    /// A terrain with so many `cells` of length `cell` along a side.
    pub fn new(cells: u32, cell: f32, flags: TriMeshFlags) -> Self {
        let size = cell * cells as f32;
        let shape = shape(&mesh::hills(size, cells), flags);
        Self { shape, size, triangle_count: 2 * cells * cells }
    }

    /// A world with the terrain alone.
    pub fn world(&self) -> PhysicsWorld {
        let mut world = PhysicsWorld::new();
        let collider = ColliderBuilder::new(self.shape.clone()).density(0.0);
        world.insert(RigidBodyBuilder::fixed(), collider);
        world
    }

    /// Number of bodies that stand side by side on the terrain, at most `count`.
    pub fn room(&self, count: usize) -> usize {
        let side = ((self.size - 3.0) / SPACING).max(1.0) as usize;
        count.min(side * side)
    }

    /// Poses of bodies in a square grid, turned at random, `height` units above the terrain.
    pub fn poses(&self, count: usize, height: f32, random: &mut Rand32) -> Vec<Pose3> {
        let side = (count as f64).sqrt().ceil() as usize;
        let place = |index: usize| SPACING * (index as f32 - 0.5 * (side as f32 - 1.0));
        let pose = |index: usize| {
            let [x, z] = [index % side, index / side].map(place);
            Pose3::from_parts(above(self.size, [x, z], height), random::rotation(random))
        };
        (0..count).map(pose).collect()
    }

    /// Drops bodies of these shapes, in turn, with random velocities.
    pub fn scatter(&self, world: &mut PhysicsWorld, shapes: &[SharedShape], count: usize) {
        let mut random = Rand32::new(7);
        for (pose, shape) in
            self.poses(count, 1.0, &mut random).into_iter().zip(shapes.iter().cycle())
        {
            let (way, turn) = (random::direction(&mut random), random::direction(&mut random));
            let body = RigidBodyBuilder::dynamic().pose(pose);
            let body = body.linvel(3.0 * way.with_y(0.0)).angvel(5.0 * turn);
            world.insert(body, ColliderBuilder::new(shape.clone()));
        }
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
    let all = crate::study::convex::kinds::kinds(length);
    let of = |name: &'static str| {
        let shapes = all.iter().filter(|kind| kind.name == name);
        (name, shapes.map(|kind| kind.shape.clone()).collect())
    };
    let mut kinds: Vec<(_, Vec<SharedShape>)> = NAMES.map(of).into();
    let mixture = kinds.iter().flat_map(|kind| kind.1.clone()).collect();
    kinds.push(("mixture", mixture));
    kinds
}
