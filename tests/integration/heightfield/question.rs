use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{Shape, TriMesh};

use super::terrain::Terrain;
use crate::support::{Dispatcher, Manifold, Pair, Query};

/// What is asked: the contacts of a terrain and a mesh.
#[derive(Clone, Copy)]
pub(super) struct Question<'a> {
    pub terrain: &'a Terrain,
    pub mesh: &'a TriMesh,
    /// The pose of the mesh in the frame of the terrain.
    pub pose: Pose,
    pub prediction: Real,
    pub is_mesh_first: bool,
}

impl<'a> Question<'a> {
    pub fn new(terrain: &'a Terrain, mesh: &'a TriMesh, pose: Pose) -> Self {
        Self { terrain, mesh, pose, prediction: 0.02, is_mesh_first: false }
    }

    pub fn pos12(&self) -> Pose {
        if self.is_mesh_first { self.pose.inverse() } else { self.pose }
    }

    /// The same of the terrain as a mesh.
    pub fn of_meshes(&self) -> Query<'a> {
        let meshes = [&self.terrain.mesh, self.mesh];
        let meshes = if self.is_mesh_first { [meshes[1], meshes[0]] } else { meshes };
        Query { meshes, pos12: self.pos12(), prediction: self.prediction }
    }

    pub fn ask<'p, M, C>(
        &self,
        dispatcher: &impl Dispatcher<M, C>,
        pair: &'p mut Pair<M, C>,
    ) -> &'p mut Pair<M, C> {
        let shapes = [&self.terrain.field as &dyn Shape, self.mesh];
        pair.ask_of(dispatcher, shapes, self.pose, self.is_mesh_first, self.prediction)
    }

    pub fn fresh(&self, dispatcher: &SbbkDispatcher) -> Vec<Manifold> {
        std::mem::take(&mut self.ask(dispatcher, &mut Pair::default()).manifolds)
    }

    /// With the numbers of the terrain as a mesh.
    pub fn renumbered(&self, manifolds: &[Manifold]) -> Vec<Manifold> {
        let index = |id: &mut u32| {
            *id = self.terrain.ids.binary_search(id).expect("a triangle of the field") as u32;
        };
        let mut manifolds = manifolds.to_vec();
        for manifold in &mut manifolds {
            index(if self.is_mesh_first {
                &mut manifold.subshape2
            } else {
                &mut manifold.subshape1
            });
        }
        manifolds
    }
}
