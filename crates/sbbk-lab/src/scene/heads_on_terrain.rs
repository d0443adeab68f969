//! Heads that fall on a terrain.

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::{ColliderBuilder, HeightField, SharedShape};
use rapier3d::math::{Real, Vector};
use rapier3d::parry::shape::HeightFieldCellStatus;
use rapier3d::parry::utils::Array2;
use rapier3d::pipeline::PhysicsWorld;
use serde::Serialize;

use super::{Scene, SceneWorld, Solid};
use crate::mesh::{self, Mesh};

named! {
    /// What a terrain is made of. The surface is the same, triangle by triangle.
    #[derive(Serialize)]
    pub enum Ground {
        /// A height field. Under stock Rapier meshes fall through it.
        HeightField = "height field",
        /// A triangle mesh.
        Mesh = "mesh",
    }
}

/// Heads of two units in a square grid above rolling hills.
#[derive(Clone, Debug)]
pub struct HeadsOnTerrain {
    /// Heads along each side of the grid.
    pub side_count: usize,
    /// Cells along each side of the terrain, of half a unit.
    pub cells: u32,
    /// What they fall on.
    pub ground: Ground,
}

impl HeadsOnTerrain {
    /// The terrain as a mesh.
    pub fn terrain(cells: u32) -> Mesh {
        let size = 0.5 * cells as Real;
        mesh::terrain(size, cells, 0.02 * size.min(30.0))
    }

    /// The same triangles as a height field.
    pub fn field(cells: u32) -> HeightField {
        let mesh = Self::terrain(cells);
        let lines = cells as usize + 1;
        let heights = Array2::from_fn(lines, lines, |i, j| mesh.vertices[i * lines + j].y);
        let size = 0.5 * cells as Real;
        let mut field = HeightField::new(heights, Vector::new(size, 1.0, size));
        for status in field.cells_statuses_mut().data_mut() {
            *status = HeightFieldCellStatus::ZIGZAG_SUBDIVISION;
        }
        field
    }
}

impl Scene for HeadsOnTerrain {
    fn name(&self) -> String {
        let Self { side_count, cells, ground } = self;
        format!("{} heads on {cells} × {cells} cells ({ground})", side_count * side_count)
    }

    fn build(&self) -> SceneWorld {
        let mut world = PhysicsWorld::new();
        let terrain = match self.ground {
            Ground::HeightField => ColliderBuilder::new(SharedShape::new(Self::field(self.cells))),
            Ground::Mesh => Solid::new(&Self::terrain(self.cells)).collider(),
        };
        world.insert(RigidBodyBuilder::fixed(), terrain);
        let head = Solid::new(&mesh::monkey_head().centred().scaled_to(2.0));
        let Self { side_count, .. } = *self;
        let middle = 0.5 * (side_count as Real - 1.0);
        let watched = (0..side_count * side_count).map(|index| {
            let [x, z] =
                [index % side_count, index / side_count].map(|k| 2.5 * (k as Real - middle));
            let body = RigidBodyBuilder::dynamic().translation(Vec3::new(x, 2.0, z));
            world.insert(body.angular_damping(1.0), head.collider()).0
        });
        let watched = watched.collect();
        SceneWorld { world, watched }
    }
}
