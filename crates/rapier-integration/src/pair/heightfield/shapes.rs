use std::cell::RefCell;

use parry3d::query::details::NormalConstraints;
use parry3d::shape::{TriMesh, Triangle, TrianglePseudoNormals};

use super::field::Field;
use crate::mesh::PreparedMesh;
use crate::pair::candidates::OrderKey;
use crate::pair::exact::Constraints;
use crate::pair::manifolds::TriangleShapes;

/// A mesh and a height field, as two shapes made of triangles.
pub(super) struct MeshAndField<'a> {
    mesh: &'a TriMesh,
    prepared: &'a PreparedMesh,
    field: Field<'a>,
    /// Whether the mesh is shape 1.
    is_mesh_first: bool,
    /// The cone of the triangle of the field that was asked for last. Its contacts follow each other, and Parry makes it from the
    /// normals of four triangles.
    cone: RefCell<(u32, Option<TrianglePseudoNormals>)>,
}

impl<'a> MeshAndField<'a> {
    pub(super) fn new(
        (mesh, prepared): (&'a TriMesh, &'a PreparedMesh),
        field: Field<'a>,
        is_mesh_first: bool,
    ) -> Self {
        Self { mesh, prepared, field, is_mesh_first, cone: RefCell::new((u32::MAX, None)) }
    }

    /// Mesh and field in the order of the shapes, or the reverse of that.
    pub(super) fn ordered<T>(&self, [mesh, field]: [T; 2]) -> [T; 2] {
        if self.is_mesh_first { [mesh, field] } else { [field, mesh] }
    }
}

impl TriangleShapes for MeshAndField<'_> {
    fn key(&self, triangles: [u32; 2]) -> OrderKey {
        let [mesh, field] = self.ordered(triangles);
        OrderKey::of_ranks([self.field.rank(field), self.prepared.rank(mesh)])
    }

    #[inline(always)]
    fn triangles(&self, triangles: [u32; 2]) -> Option<[Triangle; 2]> {
        let [mesh, field] = self.ordered(triangles);
        Some(self.ordered([self.mesh.triangle(mesh), self.field.triangle(field)?]))
    }

    fn with_constraints(&self, triangles: [u32; 2], use_them: impl FnOnce(Constraints<'_>)) {
        let [mesh, field] = self.ordered(triangles);
        let mut fresh = None;
        let of_mesh = self.prepared.normal_constraints(self.mesh, mesh, &mut fresh);
        let cone = &mut *self.cone.borrow_mut();
        if cone.0 != field {
            *cone = (field, self.field.0.triangle_normal_constraints(field));
        }
        let cones = [of_mesh, cone.1.as_ref()];
        use_them(self.ordered(cones).map(|cone| cone.map(|cone| cone as &dyn NormalConstraints)));
    }
}
