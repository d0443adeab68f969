//! Soft monkey heads on a rigid helicopter: deformable models, which the paper names first among
//! the advantages of its hierarchy.

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::dynamics::{RigidBodyBuilder, SoftBodyBuilder, SoftBodyMaterial, SpringCoefficients};
use rapier3d::pipeline::PhysicsWorld;

use super::random::rotation;
use super::{Scene, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

/// Heads of soft skin, as Rapier's own soft bodies, fall on a fixed helicopter in a row along it.
#[derive(Clone, Debug)]
pub struct SoftHeads {
    /// How many.
    pub heads: usize,
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
        Self { heads, seed: 7, stiffness: STIFFNESS }
    }

    fn head() -> Mesh {
        mesh::monkey_head().centred().scaled_to(HEAD_SIZE)
    }

    /// The starting poses, in a row along the helicopter's `x` axis, which is its longest.
    fn poses(&self, helicopter: &Mesh) -> impl Iterator<Item = Pose3> {
        let mut random = Rand32::new(self.seed);
        let bounds = helicopter.bounds();
        let start = bounds.center().with_y(bounds.maxs.y + HEAD_SIZE + DROP_HEIGHT);
        let middle = 0.5 * (self.heads as f32 - 1.0);
        (0..self.heads).map(move |index| {
            let place = (index as f32 - middle) * (1.2 * HEAD_SIZE);
            Pose3::from_parts(start + Vec3::X * place, rotation(&mut random))
        })
    }
}

impl Scene for SoftHeads {
    fn name(&self) -> String {
        let [head, helicopter] = [Self::head(), mesh::helicopter()].map(|m| m.triangle_count());
        format!("{} soft heads of {head} triangles, helicopter of {helicopter}", self.heads)
    }

    fn build(&self) -> SceneWorld {
        let mut world = PhysicsWorld::new();
        let (head, helicopter) = (Self::head(), mesh::helicopter());
        world.insert(RigidBodyBuilder::fixed(), Solid::new(&helicopter).collider());
        let softness = SpringCoefficients::new(self.stiffness, 1.0);
        let material = SoftBodyMaterial {
            bend_softness: softness,
            shape_matching_softness: softness,
            ..SoftBodyMaterial::default()
        };
        let mut watched = Vec::new();
        for pose in self.poses(&helicopter) {
            let Mesh { vertices, triangles, .. } = head.clone().posed(&pose);
            let soft = SoftBodyBuilder::trimesh(vertices, triangles).expect("a head has triangles");
            let body = world.insert_soft_body(soft.material(material));
            watched.push(world.soft_bodies[body].root_body());
        }
        SceneWorld { world, watched }
    }
}
