//! Which meshes, how often.

use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use sbbk_core::tree::{BuildOptions, Tree};

use super::super::StudyError;
use super::super::contacts::{Contest, Place, places};
use crate::mesh::{self, Mesh};
use crate::scene::SceneError;

/// Longest side of the meshes, and the prediction distance, in units: Rapier's default, and meshes of the size that it is
/// made for.
pub(super) const SIZE: f32 = 2.0;
/// See [`SIZE`].
pub(super) const PREDICTION: f32 = 0.02;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct FrontPlan {
    /// The meshes, each against itself.
    pub meshes: Vec<Mesh>,
    /// Approaches of a mesh to itself, each with five places, from nearly apart to deep inside.
    pub approach_count: usize,
    /// How often everything is timed.
    pub repeats: usize,
}

/// A mesh that can be asked.
pub(super) struct Posed {
    pub name: String,
    pub triangle_count: usize,
    pub shape: SharedShape,
    pub tree: Tree,
    pub places: Vec<Place>,
}

impl FrontPlan {
    /// Five meshes of 288 to 12,168 triangles, ten places each; about two minutes on two cores.
    pub fn standard() -> Self {
        let meshes = vec![
            mesh::monkey_head_with(6),
            mesh::monkey_head_with(11),
            mesh::helicopter(),
            mesh::torus(0.7, 0.3, 72, 35),
            mesh::monkey_head_with(39),
        ];
        Self { meshes, approach_count: 2, repeats: 7 }
    }

    /// Three of these meshes, one approach each, a few repeats: for trying, not for quoting.
    pub fn quick() -> Self {
        let mut standard = Self::standard();
        standard.meshes.truncate(3);
        Self { approach_count: 1, repeats: 3, ..standard }
    }

    pub(super) fn posed(&self) -> Result<Vec<Posed>, StudyError> {
        self.meshes.iter().map(|mesh| self.pose(mesh)).collect()
    }

    fn pose(&self, mesh: &Mesh) -> Result<Posed, StudyError> {
        let scaled = mesh.clone().centred().scaled_to(SIZE);
        let name = || mesh.name.clone();
        let shape = scaled.shared_shape();
        let shape = shape.map_err(|cause| SceneError { mesh: name(), cause })?;
        let tree = Tree::build(&scaled.vertices, &scaled.triangles, &BuildOptions::default());
        let tree = tree.map_err(|cause| StudyError::Tree { mesh: name(), cause })?;
        let contest = Contest::new([&shape].into_iter());
        let approach = |seed| places(&contest, &shape, (SIZE, PREDICTION), &mut Rand32::new(seed));
        let places = (0..self.approach_count as u64).flat_map(approach).collect();
        Ok(Posed { name: name(), triangle_count: mesh.triangle_count(), shape, tree, places })
    }
}
