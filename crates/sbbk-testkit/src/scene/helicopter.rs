//! The paper's first experiment (section 4.1, figure 5): a ball falls on a helicopter's rotor.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::pipeline::PhysicsWorld;

use super::{Scene, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

/// A mesh ball falls, by gravity alone, on the rotor of a fixed helicopter, bounces and rolls off.
///
/// The rotor is the top tenth of the helicopter. The ball starts above the blade whose tip is
/// farthest from the hub, a little way out from the hub.
#[derive(Clone, Copy, Debug)]
pub struct HelicopterBallDrop;

/// Distance between the ball and the top of the helicopter at the start, in units.
const DROP_HEIGHT: f32 = 0.5;
/// Subdivision of the mesh ball: 8 * 12 * 12 = 1152 triangles.
const BALL_DETAIL: u32 = 12;
/// Share of the helicopter's height, from the top, that is taken for the rotor.
const ROTOR_SHARE: f32 = 0.1;
/// Start of the ball over the blade, as a share of the way from hub to tip.
const BLADE_SHARE: f32 = 0.3;

impl HelicopterBallDrop {
    /// Radius of the ball, in units.
    pub const BALL_RADIUS: f32 = 0.25;

    /// Centre of the ball at the start.
    fn start(helicopter: &Mesh) -> Vec3 {
        let bounds = helicopter.bounds();
        let floor_of_rotor = bounds.maxs.y - ROTOR_SHARE * bounds.extents().y;
        let rotor = || helicopter.vertices.iter().filter(|v| v.y >= floor_of_rotor);
        let hub = rotor().sum::<Vec3>() / rotor().count().max(1) as f32;
        let reach = |vertex: &Vec3| (*vertex - hub).with_y(0.0).length_squared();
        let farthest = rotor().copied().max_by(|v, w| reach(v).total_cmp(&reach(w)));
        let over = hub.lerp(farthest.unwrap_or(hub), BLADE_SHARE);
        over.with_y(bounds.maxs.y + DROP_HEIGHT + Self::BALL_RADIUS)
    }
}

impl Scene for HelicopterBallDrop {
    fn name(&self) -> String {
        let ball = 8 * BALL_DETAIL * BALL_DETAIL;
        let helicopter = mesh::helicopter().triangle_count();
        format!("ball of {ball} triangles, helicopter of {helicopter} triangles")
    }

    fn build(&self) -> SceneWorld {
        let mut world = PhysicsWorld::new();
        let helicopter = mesh::helicopter();
        world.insert(RigidBodyBuilder::fixed(), Solid::new(&helicopter).collider());
        let collider = Solid::new(&mesh::ball(Self::BALL_RADIUS, BALL_DETAIL)).collider();
        let body = RigidBodyBuilder::dynamic().translation(Self::start(&helicopter));
        let (body, _) = world.insert(body, collider.restitution(0.4));
        SceneWorld { world, watched: vec![body] }
    }
}
