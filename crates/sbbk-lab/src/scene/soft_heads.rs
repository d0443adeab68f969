//! Soft monkey heads on a rigid helicopter: the deformable models that the paper names first among the advantages of
//! its hierarchy.

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::dynamics::{RigidBodyBuilder, SoftBodyBuilder, SoftBodyMaterial, SpringCoefficients};
use rapier3d::parry::shape::TriMeshBuilderError;
use rapier3d::pipeline::PhysicsWorld;

use super::random::rotation;
use super::{Scene, SceneError, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

/// Heads of soft skin, as Rapier's own soft bodies, fall on a fixed helicopter in a row along it.
#[derive(Clone, Debug)]
pub struct SoftHeads {
    /// How many.
    pub heads: usize,
    /// The head, about the origin.
    pub head: Mesh,
    /// The helicopter, `y` up.
    pub helicopter: Mesh,
    /// Seed of the heads' rotations.
    pub seed: u64,
    /// How fast a head springs back to its shape, in Hz; less is softer.
    pub stiffness: f32,
}

/// Size of a head across, in units: some span a rotor blade, none fits a cabin window.
const HEAD_SIZE: f32 = 0.7;
/// Rapier's default for soft bodies, in Hz. Lower: heads that deform more.
const STIFFNESS: f32 = 10.0;
/// Gap between the helicopter's top and the heads, in units.
const DROP_HEIGHT: f32 = 0.05;

impl SoftHeads {
    /// This many monkeys.
    pub fn with_heads(heads: usize) -> Self {
        let head = mesh::monkey_head().centred().scaled_to(HEAD_SIZE);
        Self { heads, head, helicopter: mesh::helicopter(), seed: 7, stiffness: STIFFNESS }
    }

    /// The starting poses, in a row along the longest side of the helicopter.
    fn poses(&self) -> Vec<Pose3> {
        let mut random = Rand32::new(self.seed);
        let bounds = self.helicopter.bounds();
        let (centre, extents) = (bounds.center(), bounds.extents());
        let along = if extents.x > extents.z { Vec3::X } else { Vec3::Z };
        let (spacing, height) = (1.2 * HEAD_SIZE, bounds.maxs.y + HEAD_SIZE + DROP_HEIGHT);
        (0..self.heads)
            .map(|index| {
                let place = (index as f32 - 0.5 * (self.heads as f32 - 1.0)) * spacing;
                let over = centre.with_y(height) + along * place;
                Pose3::from_parts(over, rotation(&mut random))
            })
            .collect()
    }
}

impl Scene for SoftHeads {
    fn name(&self) -> String {
        let [head, helicopter] = [&self.head, &self.helicopter].map(Mesh::triangle_count);
        format!("{} soft heads of {head} triangles, helicopter of {helicopter}", self.heads)
    }

    fn build(&self) -> Result<SceneWorld, SceneError> {
        let mut world = PhysicsWorld::new();
        let helicopter = Solid::new(&self.helicopter)?;
        world.insert(RigidBodyBuilder::fixed(), helicopter.collider());
        let softness = SpringCoefficients::new(self.stiffness, 1.0);
        let material = SoftBodyMaterial {
            bend_softness: softness,
            shape_matching_softness: softness,
            ..SoftBodyMaterial::default()
        };
        let mut watched = Vec::new();
        for pose in self.poses() {
            let head = self.head.clone().posed(&pose);
            let soft = SoftBodyBuilder::trimesh(head.vertices, head.triangles);
            let soft = soft.ok_or_else(|| SceneError {
                mesh: self.head.name.clone(),
                cause: TriMeshBuilderError::EmptyIndices,
            })?;
            let body = world.insert_soft_body(soft.material(material));
            watched.push(world.soft_bodies[body].root_body());
        }
        Ok(SceneWorld { world, watched })
    }
}
