//! What a scene is, and the world it builds.

use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::parry::shape::TriMeshBuilderError;
use rapier3d::pipeline::PhysicsWorld;
use thiserror::Error;

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

/// A world and the bodies that its scene is about.
pub struct SceneWorld {
    /// The world.
    pub world: PhysicsWorld,
    /// The moving bodies, in the order in which the scene lists them.
    pub watched: Vec<RigidBodyHandle>,
}
