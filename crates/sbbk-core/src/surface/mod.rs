//! Adjacency of the triangles of a mesh, and the kind of surface that they form.
//!
//! A triangle alone cannot tell on which side the body is. It cannot tell either if a point on its
//! border is a corner of the body, or lies within a flat face. A [`Surface`] stores the neighbours
//! across each edge, of welded vertices, and derives from rays if the triangles bound a solid.

mod cones;
mod crowd;
mod ends;
mod facets;
mod kinds;
mod memo;
mod one_ring;
mod rays;
mod sides;
mod slopes;
mod spread;
pub mod strays;
mod triangle;
mod twins;

pub use cones::MinimumCones;
pub use facets::Facets;
pub use kinds::{SurfaceKind, is_surely_open, kind};
pub use memo::PlaceMemo;
pub use one_ring::Around;
pub use rays::{RayTriangles, ends_within};
pub use sides::{Side, side, winding_sign};
pub use spread::minimum_cones;
pub use triangle::{area_vector, longest_side};
pub use twins::{Place, hangs, is_flat, place, sides};

use glamx::Vec3;

use twins::Adjacency;

/// Greatest number of triangles of a mesh whose kind follows from its edges if these are all
/// paired. Rays also take its closed components as they are. Larger meshes take rays that need no
/// paired edges.
pub const PAIRED: usize = 1 << 17;

/// Greatest number of triangles of a small component. Higher: searches for components take longer.
/// Lower: each triangle of a larger component takes two rays.
pub const SMALL_COMPONENT: usize = 32;

/// The adjacency of the triangles of a mesh, and the kind of surface.
///
/// Takes 6 bytes a triangle, 12 for a mesh of more than 21,845 triangles.
#[derive(Clone, Debug)]
pub struct Surface {
    adjacency: Adjacency,
    kind: SurfaceKind,
}

impl Surface {
    /// Analyses a mesh, whose triangles `rays` finds along rays. Vertices at one place count as one
    /// vertex. Takes about 35 ns a triangle, and 32 rays; a mesh with unpaired edges takes 32 to
    /// 4096 rays, and more at walls.
    ///
    /// # Panics
    /// If a triangle has an index beyond the vertices.
    pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]], rays: &impl RayTriangles) -> Self {
        let adjacency = twins::find(vertices, triangles);
        let (components, memo) = (adjacency.components.as_ref(), &PlaceMemo::default());
        let mesh = sides::RayMesh::new(rays, components, memo, sides::WallLimit::MESH);
        let kind = kinds::of_samples(&mesh);
        Self { adjacency, kind }
    }

    /// True if other triangles have the contacts of a triangle. An earlier one may have the same
    /// corners, in either winding. A triangle without an area leaves its contacts to those at its
    /// sides. A point has none.
    #[inline]
    pub fn is_double(&self, triangle: u32) -> bool {
        self.adjacency.doubles.contains(triangle)
    }

    /// True if there is a [double](Self::is_double).
    pub fn has_doubles(&self) -> bool {
        !self.adjacency.doubles.is_empty()
    }

    /// True if no triangle has a double or is wound against a neighbour.
    pub fn is_oriented(&self) -> bool {
        !self.has_doubles() && !self.adjacency.is_turned
    }

    /// The half-edge that runs back in the neighbour, if there is exactly one.
    #[inline]
    pub fn twin(&self, half_edge: u32) -> Option<u32> {
        self.adjacency.twins.get(half_edge)
    }

    /// The first triangle at a hub, a vertex of more than a thousand. Takes the corners of a
    /// triangle there. Boxes at a hub overlap, so rays from each triangle would take quadratic
    /// time.
    pub fn first_at_hub(&self, corners: [Vec3; 3]) -> Option<u32> {
        let hubs = &self.adjacency.hubs;
        if hubs.is_empty() {
            return None;
        }
        let hubs = corners.into_iter().filter_map(|corner| hubs.get(&twins::place(corner)));
        hubs.max_by_key(|(count, _)| count).map(|(_, first)| *first)
    }

    /// True if the components of the mesh are [small](SMALL_COMPONENT) on average.
    pub fn has_small_components(&self) -> bool {
        self.adjacency.has_small_components
    }

    /// The kind of surface.
    pub fn kind(&self) -> SurfaceKind {
        self.kind
    }

    /// Memory of this value in bytes, without the mesh.
    pub fn bytes(&self) -> usize {
        let Adjacency { twins, hubs, components, doubles, .. } = &self.adjacency;
        size_of::<Self>()
            + twins.bytes()
            + components.as_ref().map_or(0, |components| components.open.bytes())
            + doubles.bytes()
            + size_of::<(Place, (u32, u32))>() * hubs.capacity()
    }
}
