//! What lies around a triangle of a mesh, and whether the mesh has an inside.
//!
//! A triangle alone cannot tell on which side of it the body is, nor whether a point on its border
//! is a corner of the body or in the midst of a flat face. A [`Surface`] can: it knows the
//! neighbours across each edge, of welded vertices, and from all triangles together whether they
//! bound a solid.
//!
//! ```
//! use glamx::{DVec3, Vec3};
//! use sbbk_core::contact::Feature;
//! use sbbk_core::surface::{Surface, SurfaceKind};
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let surface = Surface::new(&vertices, &triangles);
//! assert_eq!(surface.kind(), SurfaceKind::Solid);
//!
//! let around = surface.around(&vertices, &triangles);
//! // Down from the origin nothing of the solid is nearer to what is there.
//! assert!(around.is_front(0, Feature::Vertex(0), -DVec3::ONE, None));
//! // Along this one the next vertex on the x axis is nearer.
//! let along_x = DVec3::new(1.0, -1.0, -1.0);
//! assert!(!around.is_front(0, Feature::Vertex(0), along_x, None));
//! assert!(around.is_behind(0, Feature::Vertex(0), DVec3::ONE));
//! ```

mod around;
mod kind;
mod twins;

pub use around::{Around, Facets, MeshFacets, Twins};
pub use kind::SurfaceKind;

use glamx::Vec3;

use crate::collections::Numbers;

/// The neighbours of each triangle of a mesh, and what the mesh bounds.
///
/// Takes 6 bytes a triangle, 12 of a mesh of more than 21,845.
#[derive(Clone, Debug)]
pub struct Surface {
    twins: Numbers,
    kind: SurfaceKind,
}

impl Surface {
    /// Vertices at one place are one vertex. Takes about 35 ns a triangle.
    ///
    /// # Panics
    /// If a triangle has an index beyond the vertices.
    pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let (twins, uneven) = twins::find(vertices, triangles);
        let kind = kind::of(vertices, triangles, &uneven);
        Self { twins, kind }
    }

    /// What the mesh bounds.
    pub fn kind(&self) -> SurfaceKind {
        self.kind
    }

    /// With the mesh that it is of.
    pub fn around<'a>(
        &'a self,
        vertices: &'a [Vec3],
        triangles: &'a [[u32; 3]],
    ) -> Around<MeshFacets<'a>> {
        let facets = MeshFacets { twins: self, vertices, triangles };
        Around { facets, is_solid: self.kind == SurfaceKind::Solid }
    }

    /// Memory, with this value but without the mesh itself.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.twins.bytes()
    }
}
