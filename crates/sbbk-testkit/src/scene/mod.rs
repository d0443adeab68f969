//! Scenes as data: examples, tests and benchmarks build the same worlds.
//!
//! Units are metres, kilograms and seconds; `y` is up; gravity, time step and all other parameters
//! are Rapier's defaults unless a scene says otherwise. Worlds have stock Rapier's dispatcher.
//!
//! ```
//! use sbbk_testkit::scene::{MonkeyPile, Scene};
//!
//! let mut pile = MonkeyPile::with_heads(8).build();
//! pile.world.step();
//! assert_eq!(pile.watched.len(), 8);
//! ```

mod paper;
pub mod random;
mod resting;

use glamx::Pose3;
use rapier3d::dynamics::{MassProperties, RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::pipeline::PhysicsWorld;

use crate::mesh::Mesh;

pub use paper::{HelicopterBallDrop, MonkeyPile};
pub use resting::{BoxStack, HeadOnSlope};

/// Data from which the same world can be built again and again.
pub trait Scene {
    /// Name in tables, numbers included: "200 heads of 968 triangles".
    fn name(&self) -> String;

    /// Builds the world before its first step.
    fn build(&self) -> SceneWorld;
}

/// A world and its moving bodies.
pub struct SceneWorld {
    pub world: PhysicsWorld,
    /// The moving bodies, in the order in which the scene lists them.
    pub watched: Vec<RigidBodyHandle>,
}

/// A body and its collider.
pub type Placed = (RigidBodyBuilder, ColliderBuilder);

impl SceneWorld {
    /// Adds moving bodies to a world.
    pub fn new(mut world: PhysicsWorld, bodies: impl IntoIterator<Item = Placed>) -> Self {
        let insert = |(body, collider)| world.insert(body, collider).0;
        let watched = bodies.into_iter().map(insert).collect();
        Self { world, watched }
    }

    /// Makes a world of a fixed ground and moving bodies.
    fn on(ground: Placed, bodies: impl IntoIterator<Item = Placed>) -> Self {
        let mut world = PhysicsWorld::new();
        world.insert(ground.0, ground.1);
        Self::new(world, bodies)
    }

    pub fn step(&mut self, count: usize) {
        (0..count).for_each(|_| self.world.step());
    }

    /// Number of bodies that are not asleep.
    pub fn awake(&self) -> usize {
        self.watched.iter().filter(|&&body| !self.world.bodies[body].is_sleeping()).count()
    }

    pub fn poses(&self) -> Vec<Pose3> {
        self.watched.iter().map(|&body| *self.world.bodies[body].position()).collect()
    }
}

/// A collider of a mesh, whose clones share its shape. The enclosed volume gives
/// the mass, or the bounding box if the mesh is open or inside out.
pub fn collider(mesh: &Mesh) -> ColliderBuilder {
    /// A thin bowl encloses about 5 % of its bounding box; a sheet, 0.
    const LEAST_SOLIDITY: f64 = 0.01;
    let (shape, bounds) = (mesh.shape(), mesh.bounds());
    let mass = if mesh.volume() > LEAST_SOLIDITY * f64::from(bounds.volume()) {
        shape.mass_properties(1.0)
    } else {
        let cuboid = MassProperties::from_cuboid(1.0, bounds.half_extents());
        MassProperties { local_com: bounds.center(), ..cuboid }
    };
    ColliderBuilder::new(shape).mass_properties(mass)
}
