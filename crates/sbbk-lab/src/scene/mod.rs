//! Scenes as data: examples, tests and benchmarks build the same worlds.
//!
//! Units are metres, kilograms and seconds; `y` is up; gravity, time step and all other parameters
//! are Rapier's defaults unless a scene says otherwise. Worlds come with stock Rapier's
//! dispatcher; [`Backend::install`](crate::backend::Backend::install) exchanges it.
//!
//! ```
//! use sbbk_lab::scene::{MonkeyPile, Scene};
//!
//! let mut pile = MonkeyPile::with_heads(8).build()?;
//! pile.world.step();
//! assert_eq!(pile.watched.len(), 8);
//! # Ok::<(), sbbk_lab::scene::SceneError>(())
//! ```

mod heads_on_terrain;
mod helicopter;
mod pile;
pub mod random;
mod resting;
mod soft_heads;
mod solid;

use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::{SharedShape, TriMeshFlags};
use rapier3d::parry::shape::TriMeshBuilderError;
use rapier3d::pipeline::PhysicsWorld;
use thiserror::Error;

use crate::mesh::Mesh;

pub use heads_on_terrain::{Ground, HeadsOnTerrain};
pub use helicopter::{BallKind, HelicopterBallDrop};
pub use pile::MonkeyPile;
pub use resting::{BoxStack, HeadOnSlope};
pub use soft_heads::SoftHeads;
pub use solid::Solid;

/// A scene: data from which the same world can be built again and again.
pub trait Scene {
    /// What tables call it, numbers included: "200 heads of 968 triangles".
    fn name(&self) -> String;

    /// The world before its first step.
    ///
    /// Errors: a mesh of the scene has no triangles.
    fn build(&self) -> Result<SceneWorld, SceneError>;
}

/// A scene could not be built.
#[derive(Debug, Error)]
#[error("the mesh `{mesh}` cannot collide: {cause}; give it at least one triangle")]
pub struct SceneError {
    /// Name of the mesh.
    pub mesh: String,
    /// What Parry says about it.
    #[source]
    pub cause: TriMeshBuilderError,
}

/// Parry's shape of a mesh.
///
/// Errors: the mesh has no triangles.
pub fn shape(mesh: &Mesh, flags: TriMeshFlags) -> Result<SharedShape, SceneError> {
    let shape = mesh.trimesh(flags);
    let shape = shape.map_err(|cause| SceneError { mesh: mesh.name.clone(), cause })?;
    Ok(SharedShape::new(shape))
}

/// A world and the bodies that its scene is about.
pub struct SceneWorld {
    /// The world.
    pub world: PhysicsWorld,
    /// The moving bodies, in the order in which the scene lists them.
    pub watched: Vec<RigidBodyHandle>,
}
