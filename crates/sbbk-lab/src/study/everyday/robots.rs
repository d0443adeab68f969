//! Robots from a URDF file, loaded by Rapier's own loader.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::fmt::Display;
use std::path::Path;
use std::time::Duration;

use glamx::{Pose3, Quat, Vec3};
use rapier3d::dynamics::{ImpulseJointHandle, JointAxis};
use rapier3d::geometry::TriMeshFlags;
use rapier3d::math::Real;
use rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d::pipeline::PhysicsWorld;
use rapier3d_urdf::{UrdfLoaderOptions, UrdfRobot};

use super::DEFORMABLE;
use super::ground::{Ground, above};
use super::measure::{Driven, Everyday};
use crate::report::Row;
use crate::study::StudyError;

/// A walker of four legs, nine meshes of 320 to 384 triangles, a metre long.
const WALKER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/walker/walker.urdf");
const COUNT: usize = 10;
/// Distance of two robots, in their lengths.
const SPACING: f32 = 2.0;
/// Height of the lowest point over the terrain at the start, in units.
const HEIGHT: f32 = 0.1;
/// Motors of the joints: stiffness in 1/s², damping in 1/s, strides in Hz.
const STIFFNESS: Real = 2000.0;
const DAMPING: Real = 90.0;
const STRIDES: f32 = 1.2;

/// Error for a URDF file.
fn unusable(path: &Path, cause: impl Display) -> StudyError {
    StudyError::Robot { path: path.to_owned(), cause: cause.to_string() }
}

/// Ten robots on a terrain, with the loader's flags for their meshes and without. Walkers walk; the
/// robots of a file hang in their joints.
///
/// Errors: the file cannot be loaded, or its robot has no shapes.
pub(super) fn robots<'a>(
    ground: &'a Ground,
    file: Option<&Path>,
    steps: usize,
) -> Result<Vec<Everyday<'a>>, StudyError> {
    let walks = file.is_none();
    let file = file.unwrap_or(Path::new(WALKER));
    let defaults = UrdfLoaderOptions::default().trimesh_flags;
    let mut scenes = Vec::new();
    for (name, flags) in [("the loader's flags", defaults), ("no flags", TriMeshFlags::empty())] {
        let bounds = bounds(&load(file, flags, Pose3::IDENTITY)?, file)?;
        let load = |index| load(file, flags, start(ground, bounds, index));
        let robots = (0..COUNT).map(load).collect::<Result<Vec<UrdfRobot>, _>>()?;
        let row = Row::new(DEFORMABLE, "")
            .key("scene", format!("{COUNT} robots from URDF, {name}"))
            .key("triangles", ground.triangle_count);
        let build = move || {
            let mut world = ground.world();
            let legs = robots.iter().flat_map(|robot| insert(&mut world, robot.clone()));
            let legs: Vec<Leg> = legs.collect();
            Driven::by(world, move |world, step| {
                if walks {
                    legs.iter().for_each(|leg| leg.swing(world, step));
                }
                Duration::ZERO
            })
        };
        scenes.push(Everyday::new(row, steps, build));
    }
    Ok(scenes)
}

/// Box around the shapes of a robot.
///
/// Errors: the robot has no shapes.
pub(super) fn bounds(robot: &UrdfRobot, file: &Path) -> Result<Aabb, StudyError> {
    let links = robot.links.iter().map(|link| (link.body.position(), &link.colliders));
    let boxes = links.flat_map(|(body, colliders)| {
        colliders.iter().map(move |part| {
            let part = &part.collider;
            part.shape().compute_aabb(&(body * part.position()))
        })
    });
    boxes
        .reduce(|one, two| one.merged(&two))
        .ok_or_else(|| unusable(file, "no link has a shape that can collide"))
}

/// Start of a robot. In the file z is up.
fn start(ground: &Ground, bounds: Aabb, index: usize) -> Pose3 {
    let Vec3 { x: length, y: width, .. } = bounds.extents();
    let [x, z] =
        [index % 5, index / 5].map(|place| SPACING * length.max(width) * (place as f32 - 2.0));
    let height = HEIGHT - bounds.mins.z;
    Pose3::from_parts(above(ground.size, [x, z], height), Quat::from_rotation_x(-FRAC_PI_2))
}

/// Loads a robot with meshes of its own.
pub(super) fn load(
    file: &Path,
    trimesh_flags: TriMeshFlags,
    shift: Pose3,
) -> Result<UrdfRobot, StudyError> {
    let options = UrdfLoaderOptions { trimesh_flags, shift, ..UrdfLoaderOptions::default() };
    let (robot, _) =
        UrdfRobot::from_file(file, options, None).map_err(|cause| unusable(file, cause))?;
    Ok(robot)
}

/// Joints of a leg, and its phase in a stride.
pub(super) struct Leg {
    joints: [ImpulseJointHandle; 2],
    phase: f32,
}

pub(super) fn insert(world: &mut PhysicsWorld, robot: UrdfRobot) -> Vec<Leg> {
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
