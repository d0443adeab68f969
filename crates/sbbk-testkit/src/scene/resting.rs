//! Meshes that should come to rest.

use glamx::{Pose3, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::math::{Real, Vector};

use super::{Scene, SceneWorld, collider};
use crate::mesh;

/// A tower of ten unit cubes on a fixed box 10 units wide. Each is a mesh of 12 triangles. The
/// cubes are a millimetre apart at the start, and the tower should stand.
#[derive(Clone, Copy, Debug)]
pub struct BoxStack;

/// Number of cubes.
const BOXES: usize = 10;

impl Scene for BoxStack {
    fn name(&self) -> String {
        format!("stack of {BOXES} box meshes")
    }

    fn build(&self) -> SceneWorld {
        const GAP: Real = 0.001;
        let floor = collider(&mesh::cuboid(Vec3::new(5.0, 0.5, 5.0), 1));
        let cube = collider(&mesh::cuboid(Vec3::splat(0.5), 1));
        let cubes = (0..BOXES).map(|index| {
            let height = 0.5 + GAP + index as Real * (1.0 + GAP);
            (RigidBodyBuilder::dynamic().translation(Vector::Y * height), cube.clone())
        });
        SceneWorld::on((RigidBodyBuilder::fixed().translation(Vector::Y * -0.5), floor), cubes)
    }
}

/// A monkey head set down on a fixed mesh floor, 20 units wide and of 800 triangles, that is
/// inclined about the `z` axis. With Rapier's friction the head should rest below 26 degrees. Above
/// it should slide, unless it rolls.
#[derive(Clone, Debug)]
pub struct HeadOnSlope {
    /// Inclination, in radians.
    pub angle: Real,
}

impl Scene for HeadOnSlope {
    fn name(&self) -> String {
        format!("monkey head on a slope of {:.0} degrees", self.angle.to_degrees())
    }

    fn build(&self) -> SceneWorld {
        let incline = Pose3::rotation(Vector::Z * self.angle);
        let floor = (RigidBodyBuilder::fixed().pose(incline), collider(&mesh::floor(20.0, 20)));
        let head = mesh::monkey_head().centred().scaled_to(2.0);
        // Upright in the frame of the slope, a hundredth of a unit above it.
        let pose = incline * Pose3::translation(0.0, 0.01 - head.bounds().mins.y, 0.0);
        SceneWorld::on(floor, [(RigidBodyBuilder::dynamic().pose(pose), collider(&head))])
    }
}
