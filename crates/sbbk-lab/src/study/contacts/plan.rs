//! Which meshes, at which sizes, how often.

use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use rayon::prelude::*;

use super::super::{Progress, StudyError};
use super::approach::{PLACE_COUNT, places};
use super::case::{ContactCase, PosedCase};
use super::contest::Contest;
use crate::mesh::{self, Mesh};
use crate::scene::SceneError;

/// A mesh and how often it is approached in each case.
#[derive(Clone, Debug)]
pub struct ApproachedMesh {
    /// The mesh; sizes are made by scaling it.
    pub mesh: Mesh,
    /// Approaches, of five poses each.
    pub approach_count: usize,
}

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ContactsPlan {
    /// The meshes, in the order of the tables.
    pub meshes: Vec<ApproachedMesh>,
    /// Longest sides, in units.
    pub sizes: Vec<Real>,
    /// Prediction distances, in units.
    pub predictions: Vec<Real>,
    /// How often the queries of each case are timed; once where there are very many contacts.
    pub case_repeats: usize,
    /// How often those of the speed tables are, at least; small meshes, whose queries are short,
    /// up to [`SHORT_REPEATS`] times.
    pub speed_repeats: usize,
}

/// Repeats of short measurements.
pub const SHORT_REPEATS: usize = 25;
/// Triangles in all repeats together.
const REPEATED_TRIANGLES: usize = 25_000;

impl ContactsPlan {
    /// Six meshes of 288 to 70,688 triangles, three sizes, three prediction distances, 1125 poses;
    /// within three minutes on two cores.
    pub fn standard() -> Self {
        // Pieces of a mesh with many triangles are many poses in themselves.
        let approach_counts = [8, 6, 4, 4, 2, 1];
        let meshes = meshes().into_iter().zip(approach_counts);
        Self {
            meshes: meshes
                .map(|(mesh, approach_count)| ApproachedMesh { mesh, approach_count })
                .collect(),
            sizes: vec![0.1, 2.0, 40.0],
            predictions: vec![0.001, 0.002, 0.02],
            case_repeats: 3,
            speed_repeats: 5,
        }
    }

    /// The same cases of the four smaller meshes, one approach each, within half a minute: for
    /// trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        let small = standard.meshes.into_iter().take(4);
        Self {
            meshes: small.map(|mesh| ApproachedMesh { approach_count: 1, ..mesh }).collect(),
            case_repeats: 1,
            speed_repeats: 3,
            ..standard
        }
    }

    /// Every mesh at every size with every prediction distance, in this order.
    pub fn cases(&self) -> Vec<ContactCase> {
        let meshes = self.meshes.iter().map(|approached| &approached.mesh);
        let sized = meshes.flat_map(|mesh| self.sizes.iter().map(move |&size| (mesh, size)));
        let cases = sized.flat_map(|(mesh, size)| {
            self.predictions.iter().map(move |&prediction| ContactCase {
                mesh: mesh.name.clone(),
                triangle_count: mesh.triangle_count(),
                size,
                prediction,
            })
        });
        cases.collect()
    }

    /// Number of poses over all cases.
    pub fn pose_count(&self) -> usize {
        let approaches: usize = self.meshes.iter().map(|mesh| mesh.approach_count).sum();
        approaches * PLACE_COUNT * self.sizes.len() * self.predictions.len()
    }

    /// How often the queries of a mesh of the speed tables are timed.
    pub(super) fn repeats(&self, triangle_count: usize) -> usize {
        let affordable = REPEATED_TRIANGLES / triangle_count.max(1);
        affordable.min(SHORT_REPEATS).max(self.speed_repeats)
    }

    /// The shapes of the cases, those of one mesh and size shared.
    pub(super) fn shapes(&self) -> Result<Vec<SharedShape>, StudyError> {
        let mut shapes = Vec::new();
        for ApproachedMesh { mesh, .. } in &self.meshes {
            for &size in &self.sizes {
                let shape = mesh.clone().centred().scaled_to(size).shared_shape();
                let named = |cause| SceneError { mesh: mesh.name.clone(), cause };
                let shape = shape.map_err(named)?;
                shapes.extend(self.predictions.iter().map(|_| shape.clone()));
            }
        }
        Ok(shapes)
    }

    /// Finds the poses of all cases. Each approach has a seed of its own, so that the poses do not
    /// depend on the order in which the cores find them.
    pub(super) fn posed(
        &self,
        shapes: &[SharedShape],
        contest: &Contest,
        progress: &Progress,
    ) -> Vec<PosedCase> {
        let cases = self.cases();
        let cases_of_mesh = self.sizes.len() * self.predictions.len();
        progress.phase("poses", cases.len());
        let posed = cases.into_par_iter().zip(shapes).enumerate().with_max_len(1);
        posed
            .map(|(index, (case, shape))| {
                let approach_count = self.meshes[index / cases_of_mesh].approach_count;
                let approaches = (0..approach_count).flat_map(|approach| {
                    let seed = (index << 16 | approach) as u64;
                    let lengths = (case.size, case.prediction);
                    places(contest, shape, lengths, &mut Rand32::new(seed))
                });
                let places = approaches.collect();
                progress.step();
                PosedCase { case, shape: shape.clone(), places }
            })
            .collect()
    }
}

/// 288, 968, 2596, 5040, 20,000 and 70,688 triangles.
fn meshes() -> [Mesh; 6] {
    [
        mesh::monkey_head_with(6),
        mesh::monkey_head_with(11),
        mesh::helicopter(),
        mesh::torus(0.7, 0.3, 72, 35),
        mesh::monkey_head_with(50),
        mesh::monkey_head_with(94),
    ]
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    /// Would catch a grid with a hole, and a plan that promises more than it asks.
    #[test]
    fn the_standard_plan_is_a_full_grid_of_a_thousand_poses() {
        let plan = ContactsPlan::standard();
        let cases = plan.cases();
        assert_eq!(cases.len(), 54);
        let kinds = cases
            .iter()
            .map(|case| (case.triangle_count, case.size.to_bits(), case.prediction.to_bits()));
        assert_eq!(kinds.collect::<HashSet<_>>().len(), 54);
        let counts = plan.meshes.iter().map(|mesh| mesh.mesh.triangle_count());
        assert_eq!(counts.collect::<Vec<_>>(), [288, 968, 2596, 5040, 20_000, 70_688]);
        assert_eq!(plan.pose_count(), 1125);
        assert!(plan.meshes.iter().all(|mesh| mesh.approach_count * PLACE_COUNT >= 3));
        let quick = ContactsPlan::quick();
        assert_eq!(quick.cases().len(), 36);
        assert!(quick.pose_count() < 200);
    }
}
