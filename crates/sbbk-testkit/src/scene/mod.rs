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

mod helicopter;
mod pile;
pub mod random;
mod resting;
mod solid;

use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::pipeline::PhysicsWorld;

pub use helicopter::HelicopterBallDrop;
pub use pile::MonkeyPile;
pub use resting::{BoxStack, HeadOnSlope};
pub use solid::Solid;

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
