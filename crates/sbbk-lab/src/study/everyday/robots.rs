//! Robots from a URDF file, loaded by Rapier's own loader, and what advice is about: a mesh or a
//! robot.

use crate::prelude::*;
use std::f32::consts::{FRAC_PI_2, TAU};

use rapier_integration::{SbbkDispatcher, SurfaceKind};
use rapier3d::dynamics::{ImpulseJointHandle, JointAxis, RigidBodyType};
use rapier3d::geometry::TriMesh;
use rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d::parry::query::Ray;
use rapier3d_urdf::{UrdfLoaderOptions, UrdfRobot};

use super::DEFORMABLE;
use super::measure::{Driven, Everyday};
use super::scenes::{Ground, above, named};
use crate::mesh_file;

/// A walker of four legs, nine meshes of 320 to 384 triangles, a metre long.
const WALKER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/walker/walker.urdf");
const COUNT: usize = 10;
/// Motors of the joints: stiffness in 1/s², damping in 1/s, strides in Hz.
const STIFFNESS: Real = 2000.0;
const DAMPING: Real = 90.0;
const STRIDES: f32 = 1.2;

/// Turns z of the file upwards.
fn upright() -> Quat {
    Quat::from_rotation_x(-FRAC_PI_2)
}

/// Ten robots that walk on a terrain, with the loader's flags for their meshes and without.
///
/// # Panics
///
/// If the file of this crate is missing.
pub(super) fn robots(ground: &Ground, steps: usize) -> Vec<Everyday<'_>> {
    let defaults = UrdfLoaderOptions::default().trimesh_flags;
    let flags = [("the loader's flags", defaults), ("no flags", TriMeshFlags::empty())];
    let scene = |(name, flags): (&str, TriMeshFlags)| {
        let load = |shift| load(Path::new(WALKER), flags, shift).expect("the file of this crate");
        let bounds = around(&parts(&load(Pose3::IDENTITY)), &Pose3::IDENTITY).expect("has shapes");
        let robots: Vec<UrdfRobot> =
            (0..COUNT).map(|index| load(start(ground, bounds, index))).collect();
        let name = format!("{COUNT} robots from URDF, {name}");
        named(DEFORMABLE, name, ground.triangle_count, steps, move || {
            let mut world = ground.world();
            let legs = robots.iter().flat_map(|robot| insert(&mut world, robot.clone()));
            let legs: Vec<Leg> = legs.collect();
            Driven::by(world, move |world, step| {
                legs.iter().for_each(|leg| leg.swing(world, step));
            })
        })
    };
    flags.map(scene).into()
}

/// Poses and shapes of a robot at rest.
fn parts(robot: &UrdfRobot) -> Vec<(Pose3, SharedShape)> {
    let links = robot.links.iter().map(|link| (link.body.position(), &link.colliders));
    let parts = links.flat_map(|(body, colliders)| {
        let parts = colliders.iter().map(|part| &part.collider);
        parts.map(move |part| (body * part.position(), part.shared_shape().clone()))
    });
    parts.collect()
}

/// Box around shapes at a pose.
fn around(parts: &[(Pose3, SharedShape)], pose: &Pose3) -> Option<Aabb> {
    let boxes = parts.iter().map(|(part, shape)| shape.compute_aabb(&(*pose * *part)));
    boxes.reduce(|one, two| one.merged(&two))
}

/// Start of a robot, two lengths from the next one, and its lowest point 0.1 over the terrain.
fn start(ground: &Ground, bounds: Aabb, index: usize) -> Pose3 {
    let Vec3 { x: length, y: width, .. } = bounds.extents();
    let [x, z] = [index % 5, index / 5].map(|place| 2.0 * length.max(width) * (place as f32 - 2.0));
    Pose3::from_parts(above(ground.size, [x, z], 0.1 - bounds.mins.z), upright())
}

/// Loads a robot with meshes of its own.
fn load(file: &Path, trimesh_flags: TriMeshFlags, shift: Pose3) -> io::Result<UrdfRobot> {
    let options = UrdfLoaderOptions { trimesh_flags, shift, ..UrdfLoaderOptions::default() };
    let loaded = UrdfRobot::from_file(file, options, None);
    loaded.map(|(robot, _)| robot).map_err(|cause| file_error("load the robot", file, cause))
}

/// Joints of a leg, and its phase in a stride.
struct Leg {
    joints: [ImpulseJointHandle; 2],
    phase: f32,
}

fn insert(world: &mut PhysicsWorld, robot: UrdfRobot) -> Vec<Leg> {
    let PhysicsWorld { bodies, colliders, impulse_joints, .. } = world;
    let joints = robot.insert_using_impulse_joints(bodies, colliders, impulse_joints).joints;
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

type Insert = dyn Fn(&mut PhysicsWorld, Pose3);

/// A mesh or a robot: shapes around the origin, and a function that inserts a body of them.
pub struct Subject {
    pub(super) name: String,
    pub(super) is_robot: bool,
    /// Poses at rest, and shapes.
    parts: Vec<(Pose3, SharedShape)>,
    /// Inserts a dynamic body.
    pub(super) insert: Box<Insert>,
}

impl Subject {
    /// Loads a mesh, or the robot of a URDF file.
    ///
    /// Errors: the file cannot be loaded, or its robot has no shapes.
    pub fn load(file: &Path) -> io::Result<Self> {
        match file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf")) {
            true => Self::robot(file),
            false => Ok(Self::mesh(&mesh_file::load(file)?)),
        }
    }

    /// Moves a mesh to the origin.
    pub fn mesh(mesh: &Mesh) -> Self {
        let collider = collider(&mesh.clone().centred());
        let parts = vec![(Pose3::IDENTITY, collider.shape.clone())];
        let insert = move |world: &mut PhysicsWorld, pose| {
            world.insert(RigidBodyBuilder::dynamic().pose(pose), collider.clone());
        };
        Self { name: mesh.name.clone(), is_robot: false, parts, insert: Box::new(insert) }
    }

    /// Loads a robot without flags of meshes, upright, with all links free.
    fn robot(file: &Path) -> io::Result<Self> {
        let mut robot = load(file, TriMeshFlags::empty(), Pose3::from_rotation(upright()))?;
        let bounds = around(&parts(&robot), &Pose3::IDENTITY).ok_or_else(|| {
            file_error("load the robot", file, "no link has a shape that can collide")
        })?;
        robot.append_transform(&Pose3::from_translation(-bounds.center()));
        for link in &mut robot.links {
            link.body.set_body_type(RigidBodyType::Dynamic, false);
        }
        let parts = parts(&robot);
        let insert = move |world: &mut PhysicsWorld, pose| {
            let mut robot = robot.clone();
            robot.append_transform(&pose);
            insert(world, robot);
        };
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, is_robot: true, parts, insert: Box::new(insert) })
    }

    /// Colliders of one rigid body.
    pub(super) fn colliders(&self) -> impl Iterator<Item = ColliderBuilder> {
        self.parts.iter().map(|(pose, shape)| ColliderBuilder::new(shape.clone()).position(*pose))
    }

    /// Shapes of the meshes with more triangles than this.
    pub(super) fn larger_than(&self, triangles: usize) -> Vec<SharedShape> {
        let shapes = self.parts.iter().map(|(_, shape)| shape);
        let is_large = |mesh: &TriMesh| mesh.indices().len() > triangles;
        shapes.filter(|shape| shape.as_trimesh().is_some_and(is_large)).cloned().collect()
    }

    /// Box around the subject at a pose.
    pub(super) fn bounds(&self, pose: &Pose3) -> Aabb {
        around(&self.parts, pose).unwrap_or(Aabb::new_invalid())
    }

    /// Distance along a ray to the subject.
    pub(super) fn cast(&self, ray: &Ray, most: Real) -> Option<Real> {
        let hit = |(pose, shape): &(Pose3, SharedShape)| shape.cast_ray(pose, ray, most, false);
        self.parts.iter().filter_map(hit).reduce(Real::min)
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.meshes().map(|mesh| mesh.indices().len()).sum()
    }

    /// Surface kind; of several meshes inside-out, sheet, solid, in this order.
    pub(super) fn kind(&self) -> SurfaceKind {
        let dispatcher = SbbkDispatcher::default();
        let kind =
            |mesh| dispatcher.prepare(mesh).map_or(SurfaceKind::Sheet, |it| it.surface_kind());
        let kinds = self.meshes().map(kind);
        let kinds: Vec<SurfaceKind> = kinds.collect();
        let found = [SurfaceKind::InsideOut, SurfaceKind::Sheet];
        found.into_iter().find(|kind| kinds.contains(kind)).unwrap_or(SurfaceKind::Solid)
    }

    fn meshes(&self) -> impl Iterator<Item = &TriMesh> {
        self.parts.iter().filter_map(|(_, shape)| shape.as_trimesh())
    }
}
