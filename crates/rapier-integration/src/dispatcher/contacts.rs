//! Contacts: finds the kind of pair that two shapes are.

use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
    Unsupported,
};
use parry3d::shape::Shape;
use sbbk_core::traverse::DescentCounts;

use super::SbbkDispatcher;
use crate::mesh::{are_near, is_near, may_be_inside};
use crate::pair::{
    ConvexPair, FieldPair, MeshPair, MeshPlace, Pair, PairPose, Parts, QueryOutcome,
    update_manifolds,
};
use crate::{ContactDetail, ContactSet, SbbkConfig, TriangleContacts};

impl SbbkDispatcher {
    /// Updates the manifolds of a pair of shapes, if SBBK answers for it.
    fn answer<M, C>(
        &self,
        pos12: &Pose,
        [g1, g2]: [&dyn Shape; 2],
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> QueryOutcome
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let SbbkConfig { contact_set, solid_height_fields, detail, kinds, .. } = self.config;
        let has_surfaces = contact_set == ContactSet::Surfaces;
        let leave_solids = has_surfaces && self.config.convex_leave_solids;
        let has_patches = detail == ContactDetail::Patches;
        // A new pair that is apart needs no workspace. A pair with manifolds must keep one: Rapier
        // takes a missing one for a new pair, and keeps pointers to manifolds that are gone.
        let is_new = workspace.is_none() && manifolds.is_empty();
        let (mesh, other, mesh_place) = match (g1.as_trimesh(), g2.as_trimesh()) {
            (Some(mesh1), Some(mesh2)) => {
                let meshes = [mesh1, mesh2];
                if !kinds.meshes {
                    return QueryOutcome::Unsupported;
                }
                if is_new
                    && !are_near(meshes, pos12, prediction)
                    && !(has_surfaces && may_be_inside(meshes, pos12))
                {
                    return self.counted(QueryOutcome::Apart, DescentCounts::default());
                }
                let Some(meshes) = self.view(meshes) else {
                    return QueryOutcome::Unsupported;
                };
                let pose = &PairPose::new(pos12, prediction);
                let pair = MeshPair { pose, meshes, has_surfaces, has_patches };
                return self.ask(&pair, manifolds, workspace);
            }
            (Some(mesh), None) => (mesh, g2, MeshPlace::First),
            (None, Some(mesh)) => (mesh, g1, MeshPlace::Second),
            (None, None) => return QueryOutcome::Unsupported,
        };
        let is_answered = |parts: &Parts<'_>| match parts {
            Parts::One(_) => kinds.convex_shapes,
            Parts::Many(..) => kinds.composites,
        };
        let parts = Parts::of(other).filter(is_answered);
        let field = other.as_heightfield().filter(|_| kinds.height_fields);
        if parts.is_none() && field.is_none() {
            return QueryOutcome::Unsupported;
        }
        if is_new && parts.is_some() && !leave_solids {
            let in_mesh = mesh_place.shape_in_mesh(pos12);
            if !is_near(mesh, other, &in_mesh, prediction) {
                return self.counted(QueryOutcome::Apart, DescentCounts::default());
            }
        }
        let Some([mesh]) = self.view([mesh]) else {
            return QueryOutcome::Unsupported;
        };
        let pose = &PairPose::new(pos12, prediction);
        if let Some(parts) = parts {
            let pair = ConvexPair {
                pose,
                mesh,
                parts,
                mesh_place,
                has_surfaces,
                leave_solids,
                has_patches,
            };
            self.ask(&pair, manifolds, workspace)
        } else if let Some(field) = field {
            let has_ground = solid_height_fields;
            let pair =
                FieldPair { pose, mesh, field, mesh_place, has_surfaces, has_ground, has_patches };
            self.ask(&pair, manifolds, workspace)
        } else {
            QueryOutcome::Unsupported
        }
    }

    /// Counts an outcome, and the work that it took.
    fn counted(&self, answer: QueryOutcome, counts: DescentCounts) -> QueryOutcome {
        if self.config.count_queries {
            self.counters.add(answer, counts);
        }
        answer
    }

    /// Updates the manifolds of a pair and counts the query.
    fn ask<M, C>(
        &self,
        pair: &impl Pair,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> QueryOutcome
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let mut counts = DescentCounts::default();
        let answer = update_manifolds(pair, &self.store, &mut counts, manifolds, workspace);
        self.counted(answer, counts)
    }
}

impl<M, C> PersistentQueryDispatcher<M, C> for SbbkDispatcher
where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let answer = self.answer(pos12, [g1, g2], prediction, manifolds, workspace);
        if answer != QueryOutcome::Unsupported {
            return Ok(());
        }
        DefaultQueryDispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace)
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        if let (Some(triangle1), Some(triangle2)) = (g1.as_triangle(), g2.as_triangle()) {
            let constraints = [normal_constraints1, normal_constraints2];
            let triangles = [triangle1, triangle2];
            TriangleContacts::default().update(pos12, triangles, constraints, prediction, manifold);
            return Ok(());
        }
        DefaultQueryDispatcher.contact_manifold_convex_convex(
            pos12,
            g1,
            g2,
            normal_constraints1,
            normal_constraints2,
            prediction,
            manifold,
        )
    }
}
