//! The paper's experiments: a ball on a helicopter's rotor, and many monkey heads dropped at once.

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::ColliderBuilder;

use super::random::rotation;
use super::{Scene, SceneWorld, collider};
use crate::mesh::{self, Mesh};

/// The first experiment (section 4.1, figure 5). A mesh ball falls, by gravity alone, on the rotor
/// of a fixed helicopter, bounces and rolls off.
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
        let ball = collider(&mesh::ball(RADIUS, DETAIL)).restitution(0.4);
        let ground = (RigidBodyBuilder::fixed(), collider(&mesh::helicopter()));
        SceneWorld::on(ground, [(RigidBodyBuilder::dynamic().translation(START), ball)])
    }
}

/// The second experiment (section 4.2, figure 8). Heads are released at once from a loose grid
/// above a floor, so that they fall and collide with it and with each other.
///
/// The grid has five layers, each about square. Its cells are just larger than the head's sphere,
/// so that no two heads touch at the start. Orientations are random. The lowest layer is half a
/// cell above the floor, a fixed cuboid wide enough for the pile to spread. With the default head
/// the pile is in full contact after about 90 steps (1.5 seconds).
#[derive(Clone, Debug)]
pub struct MonkeyPile {
    /// Number of heads; the paper has 2000.
    pub heads: usize,
    /// The head, shared by all: 2 units across.
    pub mesh: Mesh,
    /// Seed of the orientations.
    pub seed: u64,
    /// Rapier's contact recycling: pairs that moved little are not asked again (its default).
    pub contact_recycling: bool,
}

/// Longest side of a head, in units.
const HEAD_SIZE: f32 = 2.0;
/// Side of a grid cell in head diameters. Below 1 heads may touch at the start; raised, they fall
/// longer before they meet.
const SPACING: f32 = 1.02;
/// Number of layers. More layers give a deeper pile, which takes longer to settle.
const LAYERS: usize = 5;

impl MonkeyPile {
    pub fn with_heads(heads: usize) -> Self {
        Self::of(heads, mesh::monkey_head())
    }

    /// `heads` heads of another kind, centred and scaled to the size of the monkey.
    pub fn of(heads: usize, mesh: Mesh) -> Self {
        Self { heads, mesh: mesh.centred().scaled_to(HEAD_SIZE), seed: 1, contact_recycling: true }
    }

    /// The starting poses of the heads.
    pub fn poses(&self) -> Vec<Pose3> {
        let mut random = Rand32::new(self.seed);
        let cell = self.cell();
        let columns = self.columns();
        let layer_size = columns * columns;
        let centre = 0.5 * (columns as f32 - 1.0);
        (0..self.heads)
            .map(|index| {
                let [x, z] = [index % columns, index / columns % columns];
                let coordinates = Vec3::new(
                    x as f32 - centre,
                    (index / layer_size) as f32 + 1.0,
                    z as f32 - centre,
                );
                Pose3::from_parts(cell * coordinates, rotation(&mut random))
            })
            .collect()
    }

    /// Side of a grid cell, in units.
    fn cell(&self) -> f32 {
        let farthest = (self.mesh.vertices.iter()).map(|vertex| vertex.length_squared());
        SPACING * 2.0 * farthest.fold(0.0, f32::max).sqrt()
    }

    /// Number of grid columns along each side.
    fn columns(&self) -> usize {
        let layer = self.heads.div_ceil(LAYERS);
        (layer as f64).sqrt().ceil().max(1.0) as usize
    }
}

impl Scene for MonkeyPile {
    fn name(&self) -> String {
        let triangle_count = self.mesh.triangle_count();
        format!("{} heads of {triangle_count} triangles", self.heads)
    }

    fn build(&self) -> SceneWorld {
        let cell = self.cell();
        // Leaves as much room beside the grid as it is wide or high.
        let side = 2.0 * cell * self.columns().max(LAYERS) as f32;
        let floor = RigidBodyBuilder::fixed().translation(Vec3::Y * -cell);
        let head = collider(&self.mesh);
        let placed = |pose| (RigidBodyBuilder::dynamic().pose(pose), head.clone());
        let heads = self.poses().into_iter().map(placed);
        let mut built = SceneWorld::on((floor, ColliderBuilder::cuboid(side, cell, side)), heads);
        built.world.integration_parameters.contact_recycling = self.contact_recycling;
        built
    }
}
