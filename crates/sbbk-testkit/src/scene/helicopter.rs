//! The paper's first experiment (section 4.1, figure 5): a ball falls on a helicopter's rotor.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::pipeline::PhysicsWorld;

use super::{Scene, SceneWorld, collider};
use crate::mesh;

/// A mesh ball falls, by gravity alone, on the rotor of a fixed helicopter, bounces and rolls off.
#[derive(Clone, Copy, Debug)]
pub struct HelicopterBallDrop;

/// Radius of the ball, in units.
const RADIUS: f32 = 0.25;
/// Subdivision of the mesh ball: 8 * 12 * 12 = 1152 triangles.
const DETAIL: u32 = 12;
/// Centre of the ball at the start: half a unit above a blade, near the hub.
const START: Vec3 = Vec3::new(-1.0416353, 2.77, 0.0023176167);

impl Scene for HelicopterBallDrop {
    fn name(&self) -> String {
        let ball = 8 * DETAIL * DETAIL;
        let helicopter = mesh::helicopter().triangle_count();
        format!("ball of {ball} triangles, helicopter of {helicopter} triangles")
    }

    fn build(&self) -> SceneWorld {
        let mut world = PhysicsWorld::new();
        world.insert(RigidBodyBuilder::fixed(), collider(&mesh::helicopter()));
        let ball = collider(&mesh::ball(RADIUS, DETAIL));
        let body = RigidBodyBuilder::dynamic().translation(START);
        let (body, _) = world.insert(body, ball.restitution(0.4));
        SceneWorld { world, watched: vec![body] }
    }
}
