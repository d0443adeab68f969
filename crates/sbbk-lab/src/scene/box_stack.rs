//! A tower of boxes given as meshes.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::math::{Real, Vector};
use rapier3d::pipeline::PhysicsWorld;

use super::{Scene, SceneError, SceneWorld, Solid};
use crate::mesh;

/// Unit cubes, each a mesh of 12 triangles, one above the other on a fixed mesh of the same kind,
/// 10 units wide. The tower should stand.
#[derive(Clone, Debug)]
pub struct BoxStack {
    /// Number of boxes.
    pub boxes: usize,
    /// Vertical space between boxes at the start, in units.
    pub gap: Real,
}

impl Default for BoxStack {
    /// Ten boxes, a millimetre apart.
    fn default() -> Self {
        Self { boxes: 10, gap: 0.001 }
    }
}

impl Scene for BoxStack {
    fn name(&self) -> String {
        format!("stack of {} box meshes", self.boxes)
    }

    fn build(&self) -> Result<SceneWorld, SceneError> {
        let mut world = PhysicsWorld::new();
        let floor = Solid::new(&mesh::cuboid(Vec3::new(5.0, 0.5, 5.0), 1))?;
        let cube = Solid::new(&mesh::cuboid(Vec3::splat(0.5), 1))?;
        world.insert(RigidBodyBuilder::fixed().translation(Vector::Y * -0.5), floor.collider());
        let watched = (0..self.boxes).map(|index| {
            let height = 0.5 + self.gap + index as Real * (1.0 + self.gap);
            let body = RigidBodyBuilder::dynamic().translation(Vector::Y * height);
            world.insert(body, cube.collider()).0
        });
        let watched = watched.collect();
        Ok(SceneWorld { world, watched })
    }
}
