//! A mesh or a robot that advice is about.

use std::f32::consts::FRAC_PI_2;
use std::path::Path;

use glamx::{Pose3, Quat};
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyType};
use rapier3d::geometry::{ColliderBuilder, SharedShape, TriMesh, TriMeshFlags};
use rapier3d::math::Real;
use rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d::parry::query::Ray;
use rapier3d::pipeline::PhysicsWorld;
use sbbk_core::surface::{Surface, SurfaceKind};

use super::robots;
use crate::mesh::Mesh;
use crate::scene::Solid;
use crate::study::StudyError;

/// Shapes around the origin, and a function that inserts a body of them.
pub(super) struct Subject {
    pub name: String,
    pub is_robot: bool,
    /// Poses at rest, and shapes.
    parts: Vec<(Pose3, SharedShape)>,
    insert: Box<Insert>,
}

type Insert = dyn Fn(&mut PhysicsWorld, Pose3);

impl Subject {
    /// Moves a mesh to the origin.
    pub fn mesh(mesh: &Mesh) -> Self {
        let solid = Solid::new(&mesh.clone().centred());
        let parts = vec![(Pose3::IDENTITY, solid.collider().shape)];
        let insert = move |world: &mut PhysicsWorld, pose| {
            world.insert(RigidBodyBuilder::dynamic().pose(pose), solid.collider());
        };
        Self { name: mesh.name.clone(), is_robot: false, parts, insert: Box::new(insert) }
    }

    /// Loads a robot without flags of meshes, upright, with all links free.
    ///
    /// Errors: the file cannot be loaded, or its robot has no shapes.
    pub fn robot(file: &Path) -> Result<Self, StudyError> {
        let upright = Pose3::from_rotation(Quat::from_rotation_x(-FRAC_PI_2));
        let mut robot = robots::load(file, TriMeshFlags::empty(), upright)?;
        let centre = robots::bounds(&robot, file)?.center();
        robot.append_transform(&Pose3::from_translation(-centre));
        let mut parts = Vec::new();
        for link in &mut robot.links {
            link.body.set_body_type(RigidBodyType::Dynamic, false);
            for part in link.colliders.iter().map(|part| &part.collider) {
                parts.push((link.body.position() * part.position(), part.shared_shape().clone()));
            }
        }
        let insert = move |world: &mut PhysicsWorld, pose| {
            let mut robot = robot.clone();
            robot.append_transform(&pose);
            robots::insert(world, robot);
        };
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, is_robot: true, parts, insert: Box::new(insert) })
    }

    /// Inserts a dynamic body.
    pub fn insert(&self, world: &mut PhysicsWorld, pose: Pose3) {
        (self.insert)(world, pose);
    }

    /// Colliders of one rigid body.
    pub fn colliders(&self) -> impl Iterator<Item = ColliderBuilder> {
        self.parts.iter().map(|(pose, shape)| ColliderBuilder::new(shape.clone()).position(*pose))
    }

    /// Shapes of the meshes with more triangles than this.
    pub fn larger_than(&self, triangles: usize) -> Vec<SharedShape> {
        let shapes = self.parts.iter().map(|(_, shape)| shape);
        let is_large = |mesh: &TriMesh| mesh.indices().len() > triangles;
        shapes.filter(|shape| shape.as_trimesh().is_some_and(is_large)).cloned().collect()
    }

    /// Box around the subject at a pose.
    pub fn bounds(&self, pose: &Pose3) -> Aabb {
        let boxes = self.parts.iter().map(|(part, shape)| shape.compute_aabb(&(*pose * *part)));
        boxes.reduce(|one, two| one.merged(&two)).unwrap_or(Aabb::new_invalid())
    }

    /// Distance along a ray to the subject.
    pub fn cast(&self, ray: &Ray, most: Real) -> Option<Real> {
        let hits =
            self.parts.iter().filter_map(|(pose, shape)| shape.cast_ray(pose, ray, most, false));
        hits.reduce(Real::min)
    }

    pub fn triangle_count(&self) -> usize {
        self.meshes().map(|mesh| mesh.indices().len()).sum()
    }

    /// Surface kind; of several meshes inside-out, sheet, solid, in this order.
    pub fn kind(&self) -> SurfaceKind {
        let kinds = self.meshes().map(|mesh| Surface::new(mesh.vertices(), mesh.indices()).kind());
        let kinds: Vec<SurfaceKind> = kinds.collect();
        let found = [SurfaceKind::InsideOut, SurfaceKind::Sheet];
        found.into_iter().find(|kind| kinds.contains(kind)).unwrap_or(SurfaceKind::Solid)
    }

    fn meshes(&self) -> impl Iterator<Item = &TriMesh> {
        self.parts.iter().filter_map(|(_, shape)| shape.as_trimesh())
    }
}
