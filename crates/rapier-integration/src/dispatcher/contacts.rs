//! Contacts: finds the kind of pair that two shapes are.

use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
    Unsupported,
};
use parry3d::shape::{Shape, ShapeType};
use sbbk_core::traverse::DescentCounts;

use super::SbbkDispatcher;
use crate::TriangleContacts;
use crate::mesh::{MeshView, TwoMeshes, is_near};
use crate::pair::{
    ConvexPair, Field, MeshPair, MeshPlace, PairPose, Parts, ShapeView, update_manifolds,
};
use crate::stats::QueryOutcome;

/// Two shapes by the kind of pair that they are.
enum Kind<'a> {
    /// Shapes without contacts that need no workspace.
    Apart,
    Triangles([ShapeView<'a>; 2]),
    Convex(MeshView<'a>, Parts<'a>, MeshPlace),
}

impl SbbkDispatcher {
    /// Updates the manifolds of a pair of shapes, and counts the work. Returns `None` if Parry must
    /// answer.
    fn answer<M, C>(
        &self,
        pos12: &Pose,
        shapes: [&dyn Shape; 2],
        prediction: Real,
        counts: &mut DescentCounts,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Option<QueryOutcome>
    where
        M: Default + 'static,
        C: Default + Copy + 'static,
    {
        let Self { config, store, .. } = self;
        // A new pair that is apart needs no workspace. A pair with manifolds must keep one: Rapier
        // takes a missing one for a new pair, and keeps pointers to manifolds that are gone.
        let is_new = workspace.is_none() && manifolds.is_empty();
        let kind = self.kind_of(pos12, shapes, prediction, is_new)?;
        let pose = || PairPose::new(pos12, prediction);
        Some(match kind {
            Kind::Apart => QueryOutcome::Apart,
            Kind::Triangles(shapes) => {
                let pair = MeshPair { pose: &pose(), shapes, config };
                update_manifolds(&pair, store, counts, manifolds, workspace)
            }
            Kind::Convex(mesh, parts, mesh_place) => {
                let pair = ConvexPair { pose: &pose(), mesh, parts, mesh_place, config };
                update_manifolds(&pair, store, counts, manifolds, workspace)
            }
        })
    }

    /// Returns the kind of pair that two shapes are; `None` if Parry must answer.
    fn kind_of<'a>(
        &'a self,
        pos12: &Pose,
        [g1, g2]: [&'a dyn Shape; 2],
        prediction: Real,
        is_new: bool,
    ) -> Option<Kind<'a>> {
        let kinds = &self.config.kinds;
        let (mesh, other, mesh_place) = match (g1.as_trimesh(), g2.as_trimesh()) {
            (Some(mesh1), Some(mesh2)) => {
                let meshes = kinds.meshes.then_some([mesh1, mesh2])?;
                let are_apart = || {
                    let two = TwoMeshes::new(meshes, pos12);
                    let may_be_inside = || self.config.wants_surfaces() && two.may_be_inside();
                    two.are_apart(prediction) && !may_be_inside()
                };
                if is_new && are_apart() {
                    return Some(Kind::Apart);
                }
                let shapes = [self.view(mesh1)?, self.view(mesh2)?];
                return Some(Kind::Triangles(shapes.map(ShapeView::Mesh)));
            }
            (Some(mesh), None) => (mesh, g2, MeshPlace::First),
            (None, Some(mesh)) => (mesh, g1, MeshPlace::Second),
            (None, None) => return None,
        };
        if kinds.height_fields
            && other.shape_type() == ShapeType::HeightField
            && let Some(field) = other.as_heightfield()
        {
            let (mesh, field) = (self.view(mesh)?, Field(field));
            if is_new && !field.is_near(&mesh, &mesh_place.mesh_in_shape(pos12), prediction) {
                return Some(Kind::Apart);
            }
            let shapes = [ShapeView::Mesh(mesh), ShapeView::Field(field)];
            return Some(Kind::Triangles(mesh_place.swap(shapes)));
        }
        let parts = Parts::of(other).filter(|parts| match parts {
            Parts::One(_) => kinds.convex_shapes,
            Parts::Many(..) => kinds.composites,
        })?;
        let is_near = || is_near(mesh, other, &mesh_place.shape_in_mesh(pos12), prediction);
        if is_new && !self.config.leave_solids() && !is_near() {
            return Some(Kind::Apart);
        }
        if !parts.are_supported(other) {
            return None;
        }
        Some(Kind::Convex(self.view(mesh)?, parts, mesh_place))
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
        let (shapes, mut counts) = ([g1, g2], DescentCounts::default());
        let answer = self.answer(pos12, shapes, prediction, &mut counts, manifolds, workspace);
        let Some(outcome) = answer else {
            return DefaultQueryDispatcher
                .contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        };
        if self.config.count_queries {
            self.store.counters.add(outcome, counts);
        }
        Ok(())
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
