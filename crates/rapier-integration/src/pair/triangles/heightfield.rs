//! A mesh and a height field.
//!
//! Stock Parry takes the field for a convex shape here and finds no contacts at all. The descent
//! goes down the tree of the mesh and reads the cells under it ([`sbbk_core::field`]).
//!
//! Triangles of the field have the numbers that Parry gives them in contacts with convex shapes.
//! Manifolds are in the order in which Parry walks a field and a compound: cell by cell along z,
//! then x, the left triangle first; then by the place of the mesh's triangle in Parry's hierarchy.
//!
//! # Edits
//!
//! Only the candidates of a pair are kept. Rapier drops them when a shape was edited. Should a host
//! not do so, another field, another scale, another flag and a removed triangle are noticed; that a
//! triangle was added, or a cell divided along its other diagonal, only where the pair descends
//! next.

use std::cell::RefCell;
use std::sync::Arc;

use parry3d::math::Real;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{HeightField, TriMesh, Triangle, TrianglePseudoNormals};
use sbbk_core::contact::ManifoldPoints;
use sbbk_core::field::{FieldFrame, descend_field};
use sbbk_core::traverse::{Counters, Placement};
use sbbk_core::volumes::Aabb;

use super::exact::Constraints;
use super::field::{Field, FieldToken};
use super::query::{Hint, TriangleQuery, TriangleShapes};
use crate::ContactGenerator;
use crate::mesh::{Change, Held, KnownMesh, TreeCache, root_box};
use crate::pair::driver::{Moving, Pair, Scratch};
use crate::pair::order::OrderKey;
use crate::pair::pose::{MeshPlace, PairPose};

/// A mesh and a height field.
#[derive(Copy, Clone)]
pub(crate) struct FieldPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) mesh: &'a TriMesh,
    pub(crate) field: &'a HeightField,
    pub(crate) mesh_place: MeshPlace,
    pub(crate) contacts: ContactGenerator,
}

impl FieldPair<'_> {
    /// The mesh in the frame of the field.
    fn mesh_placement(&self) -> Placement {
        self.mesh_place.mesh_in_other(&self.pose.placement12)
    }
}

impl<'a> Pair for FieldPair<'a> {
    /// The mesh, and the field that the candidates are for.
    type Known = (KnownMesh, Option<FieldToken>);
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q, MeshAndField<'q>>
    where
        Self: 'q;

    fn is_unsupported(&self, cache: &TreeCache) -> bool {
        cache.is_unsupported(&[self.mesh])
    }

    fn needs_trees((mesh, _): &Self::Known) -> bool {
        mesh.is_unknown()
    }

    fn boxes_meet(&self, counters: &mut impl Counters) -> bool {
        let Some(root) = root_box(self.mesh) else {
            return true;
        };
        let field = Field(self.field);
        let frame = FieldFrame::new(&field, &self.mesh_placement(), self.pose.prediction);
        frame.meets(&Aabb { min: root.mins, max: root.maxs }, counters)
    }

    fn open<'q>(
        &'q self,
        cache: &Arc<TreeCache>,
        (known_mesh, known_field): &'q mut Self::Known,
    ) -> Option<(Change, Self::Query<'q>)> {
        let (mut change, tree) = cache.noting(self.mesh, known_mesh.update(self.mesh, cache))?;
        let field = FieldToken::of(self.field);
        if known_field.replace(field).is_some_and(|known| known != field) {
            change = Change::Replaced;
        }
        let shapes = MeshAndField {
            pair: self,
            prepared: tree,
            mesh_placement: self.mesh_placement(),
            field: Field(self.field),
            cone: RefCell::new((u32::MAX, None)),
        };
        let query = TriangleQuery {
            shapes,
            pose: self.pose,
            parrys_pose: self.pose.pos12,
            generator: self.contacts,
            points: ManifoldPoints::new(),
        };
        Some((change, query))
    }
}

/// A mesh with its tree, and a height field.
pub(crate) struct MeshAndField<'q> {
    pair: &'q FieldPair<'q>,
    prepared: Held<'q>,
    /// The mesh in the frame of the field.
    mesh_placement: Placement,
    field: Field<'q>,
    /// The cone of the triangle of the field that was asked for last. Its contacts follow each
    /// other, and Parry makes it from the normals of four triangles.
    cone: RefCell<(u32, Option<TrianglePseudoNormals>)>,
}

impl TriangleShapes for MeshAndField<'_> {
    fn moving(&self) -> Moving {
        Moving { ball: self.prepared.tree.bounding_ball(), placement: self.mesh_placement }
    }

    fn descend(
        &self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        mut found: impl FnMut([u32; 2]),
    ) {
        let prepared = &*self.prepared;
        let frame = FieldFrame::new(&self.field, &self.mesh_placement, margin);
        let stack = &mut scratch.field;
        descend_field(&prepared.tree, &frame, stack, counters, |triangle, of_mesh| {
            if !prepared.is_broken(of_mesh) {
                found(self.pair.mesh_place.swap([of_mesh, self.field.id(triangle)]));
            }
        });
    }

    fn key(&self, triangles: [u32; 2]) -> OrderKey {
        let [mesh, field] = self.pair.mesh_place.swap(triangles);
        OrderKey::new([self.field.rank(field), self.prepared.rank(mesh)])
    }

    #[inline(always)]
    fn triangles(&self, triangles: [u32; 2]) -> Option<[Triangle; 2]> {
        let place = self.pair.mesh_place;
        let [mesh, field] = place.swap(triangles);
        Some(place.swap([self.pair.mesh.triangle(mesh), self.field.triangle(field)?]))
    }

    fn with_constraints(&self, triangles: [u32; 2], then: impl FnOnce(Constraints<'_>)) {
        let place = self.pair.mesh_place;
        let [mesh, field] = place.swap(triangles);
        let mut fresh = None;
        let of_mesh = self.prepared.normal_constraints(self.pair.mesh, mesh, &mut fresh);
        let cone = &mut *self.cone.borrow_mut();
        if cone.0 != field {
            *cone = (field, self.field.0.triangle_normal_constraints(field));
        }
        let cones = [of_mesh, cone.1.as_ref()];
        then(place.swap(cones).map(|cone| cone.map(|cone| cone as &dyn NormalConstraints)));
    }
}
