//! A head on an inclined mesh floor.

use glamx::Pose3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::math::{Real, Vector};
use rapier3d::pipeline::PhysicsWorld;

use super::{Scene, SceneError, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

/// A head set down on a fixed mesh floor, 20 units wide and of 800 triangles, that is inclined
/// about the `z` axis. Rapier's default friction coefficient is 0.5 for each body, so that the
/// head should rest below an angle of 26 degrees and slide above it, unless it rolls.
#[derive(Clone, Debug)]
pub struct HeadOnSlope {
    /// The head.
    pub mesh: Mesh,
    /// Inclination, in radians.
    pub angle: Real,
}

impl Default for HeadOnSlope {
    /// The monkey head, 2 units across, on a slope of 10 degrees.
    fn default() -> Self {
        Self { mesh: mesh::monkey_head().centred().scaled_to(2.0), angle: Real::to_radians(10.0) }
    }
}

impl Scene for HeadOnSlope {
    fn name(&self) -> String {
        let degrees = self.angle.to_degrees();
        format!("{} on a slope of {degrees:.0} degrees", self.mesh.name)
    }

    fn build(&self) -> Result<SceneWorld, SceneError> {
        let mut world = PhysicsWorld::new();
        let incline = Pose3::rotation(Vector::Z * self.angle);
        let floor = Solid::new(&mesh::floor(20.0, 20))?;
        world.insert(RigidBodyBuilder::fixed().pose(incline), floor.collider());
        // Upright in the frame of the slope, a hundredth of a unit above it.
        let height = 0.01 - self.mesh.bounds().mins.y;
        let pose = incline * Pose3::translation(0.0, height, 0.0);
        let body = RigidBodyBuilder::dynamic().pose(pose);
        let (body, _) = world.insert(body, Solid::new(&self.mesh)?.collider());
        Ok(SceneWorld { world, watched: vec![body] })
    }
}
