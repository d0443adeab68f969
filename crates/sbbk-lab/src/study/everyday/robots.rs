//! Robots from a URDF file, loaded by Rapier's own loader.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::path::Path;
use std::time::Duration;

use glamx::{Pose3, Quat};
use rapier3d::dynamics::{ImpulseJointHandle, JointAxis};
use rapier3d::geometry::TriMeshFlags;
use rapier3d::math::Real;
use rapier3d::pipeline::PhysicsWorld;
use rapier3d_urdf::{UrdfLoaderOptions, UrdfRobot};

use super::DEFORMABLE;
use super::ground::{Ground, above};
use super::measure::{Driven, Everyday};
use crate::report::Row;

/// A walker of four legs, nine meshes of 320 to 384 triangles, a metre long.
const WALKER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/walker/walker.urdf");
const COUNT: usize = 10;
/// Units between robots.
const SPACING: f32 = 2.2;
/// Height of the torso over the terrain at the start, in units: the feet hang just above it.
const HEIGHT: f32 = 1.2;
/// Of the motors in the joints, in 1/s² and 1/s, and how often a leg swings, in Hz.
const STIFFNESS: Real = 2000.0;
const DAMPING: Real = 90.0;
const STRIDES: f32 = 1.2;

/// Ten walkers on a terrain, with the loader's flags for their meshes and with none.
pub(super) fn robots(ground: &Ground, steps: usize) -> [Everyday<'_>; 2] {
    let defaults = UrdfLoaderOptions::default().trimesh_flags;
    [("the loader's flags", defaults), ("no flags", TriMeshFlags::empty())].map(|(name, flags)| {
        let robots: Vec<UrdfRobot> = (0..COUNT).map(|index| load(ground, flags, index)).collect();
        let row = Row::new(DEFORMABLE, "")
            .key("scene", format!("{COUNT} robots from URDF, {name}"))
            .key("triangles", ground.triangle_count);
        let build = move || {
            let mut world = ground.world();
            let legs = robots.iter().flat_map(|robot| insert(&mut world, robot.clone()));
            let legs: Vec<Leg> = legs.collect();
            Ok(Driven::by(world, move |world, step| {
                legs.iter().for_each(|leg| leg.swing(world, step));
                Duration::ZERO
            }))
        };
        Everyday::new(row, steps, build)
    })
}

/// Each robot has its own meshes, as if each were loaded by itself.
fn load(ground: &Ground, trimesh_flags: TriMeshFlags, index: usize) -> UrdfRobot {
    let [x, z] = [index % 5, index / 5].map(|place| SPACING * (place as f32 - 2.0));
    // In the file z is up.
    let shift =
        Pose3::from_parts(above(ground.size, [x, z], HEIGHT), Quat::from_rotation_x(-FRAC_PI_2));
    let options = UrdfLoaderOptions { trimesh_flags, shift, ..UrdfLoaderOptions::default() };
    let (robot, _) = UrdfRobot::from_file(Path::new(WALKER), options, None)
        .expect("the file is part of this crate");
    assert!(robot.links.iter().all(|link| !link.colliders.is_empty()), "a mesh is missing");
    robot
}

/// The joints of a leg, and when in a stride it swings.
struct Leg {
    joints: [ImpulseJointHandle; 2],
    phase: f32,
}

fn insert(world: &mut PhysicsWorld, robot: UrdfRobot) -> Vec<Leg> {
    let joints = robot
        .insert_using_impulse_joints(
            &mut world.bodies,
            &mut world.colliders,
            &mut world.impulse_joints,
        )
        .joints;
    // In the file: hip and knee of the left and of the right leg, in front and then behind.
    let legs = joints.chunks_exact(2).zip([0.0, 0.5, 0.5, 0.0]);
    legs.map(|(leg, phase)| Leg { joints: [leg[0].joint, leg[1].joint], phase }).collect()
}

impl Leg {
    fn swing(&self, world: &mut PhysicsWorld, step: usize) {
        let time = world.integration_parameters.dt * step as f32;
        let angle = TAU * (STRIDES * time + self.phase);
        let targets = [0.4 + 0.4 * angle.sin(), -0.8 + 0.4 * angle.cos()];
        for (joint, target) in self.joints.into_iter().zip(targets) {
            if let Some(joint) = world.impulse_joints.get_mut(joint, true) {
                joint.data.set_motor_position(JointAxis::AngX, target, STIFFNESS, DAMPING);
            }
        }
    }
}
