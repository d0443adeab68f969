//! The smallest scene: two meshes that meet.

use glamx::Pose3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::math::Vector;
use rapier3d::pipeline::PhysicsWorld;

use super::{Scene, SceneError, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

/// A fixed mesh at the origin and a moving one, without gravity: they approach at a given speed.
#[derive(Clone, Debug)]
pub struct TwoMeshes {
    /// The fixed mesh and the moving one.
    pub meshes: [Mesh; 2],
    /// Where the moving mesh starts.
    pub pose: Pose3,
    /// Its velocity, in units a second.
    pub velocity: Vector,
}

impl Default for TwoMeshes {
    /// Two monkey heads, 2 units across and face to face, half a unit apart at the most; one moves
    /// at 2 units a second towards the other, so that they meet within 30 steps.
    fn default() -> Self {
        let head = mesh::monkey_head().centred().scaled_to(2.0);
        let depth = head.bounds().extents().z;
        Self {
            pose: Pose3::translation(0.0, 0.0, depth + 0.25),
            velocity: -2.0 * Vector::Z,
            meshes: [head.clone(), head],
        }
    }
}

impl Scene for TwoMeshes {
    fn name(&self) -> String {
        let [fixed, moving] = &self.meshes;
        format!("{} meets {}", moving.name, fixed.name)
    }

    fn build(&self) -> Result<SceneWorld, SceneError> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        let [fixed, moving] = &self.meshes;
        world.insert(RigidBodyBuilder::fixed(), Solid::new(fixed)?.collider());
        let body = RigidBodyBuilder::dynamic().pose(self.pose).linvel(self.velocity);
        let (body, _) = world.insert(body, Solid::new(moving)?.collider());
        Ok(SceneWorld { world, watched: vec![body] })
    }
}
