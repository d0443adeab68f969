//! The mesh container and the affine edits that scenes need.

use glamx::{Pose3, Vec3};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshBuilderError, TriMeshFlags};

/// A named indexed triangle mesh, in its own frame.
///
/// The fields are public: a mesh is data, not an invariant. What holds of meshes made by this
/// module is that indices are in range and coordinates finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// What reports and error messages call it.
    pub name: String,
    /// Positions, in scene units.
    pub vertices: Vec<Vec3>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A mesh from its parts, taken as they are.
    pub fn new(name: impl Into<String>, vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        Self { name: name.into(), vertices, triangles }
    }

    /// One mesh holding all parts, each as a component of its own: nothing is welded.
    pub fn merged<'a>(name: impl Into<String>, parts: impl IntoIterator<Item = &'a Mesh>) -> Self {
        let mut whole = Self::new(name, Vec::new(), Vec::new());
        for part in parts {
            let offset = whole.vertices.len() as u32;
            whole.vertices.extend_from_slice(&part.vertices);
            let shifted = part.triangles.iter().map(|t| t.map(|i| i + offset));
            whole.triangles.extend(shifted);
        }
        whole
    }

    /// The same mesh under another name.
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Number of triangles, degenerate ones included.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of stored positions, whether or not a triangle uses them.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// The corners of one triangle. Panics when `triangle_index` is out of range.
    pub fn corners(&self, triangle_index: usize) -> [Vec3; 3] {
        self.triangles[triangle_index].map(|i| self.vertices[i as usize])
    }

    /// Box around all vertices; [`Aabb::new_invalid`] when there are none.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::new_invalid();
        for vertex in &self.vertices {
            bounds.take_point(*vertex);
        }
        bounds
    }

    /// Every vertex mapped by `map`; triangles are kept as they are, so a mirroring map turns
    /// the surface inside out.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        for vertex in &mut self.vertices {
            *vertex = map(*vertex);
        }
        self
    }

    /// Turned inside out: all triangles run the other way round.
    pub fn flipped(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        self
    }

    /// Moved rigidly.
    pub fn posed(self, pose: &Pose3) -> Self {
        self.mapped(|v| pose.transform_point(v))
    }

    /// Scaled uniformly about the origin.
    pub fn scaled(self, factor: f32) -> Self {
        self.mapped(|v| v * factor)
    }

    /// Scaled uniformly about the origin so that the longest side of [`Self::bounds`] is `size`.
    /// A mesh without extent is returned unchanged.
    pub fn scaled_to(self, size: f32) -> Self {
        let longest = self.bounds().extents().max_element();
        if longest > 0.0 { self.scaled(size / longest) } else { self }
    }

    /// Moved so that the centre of [`Self::bounds`] is the origin.
    pub fn centred(self) -> Self {
        if self.vertices.is_empty() {
            return self;
        }
        let centre = self.bounds().center();
        self.mapped(|v| v - centre)
    }

    /// The mesh as Parry's shape, built as stock Rapier builds it.
    ///
    /// Errors: the mesh has no triangles, or `flags` ask for a topology that it does not have.
    pub fn trimesh(&self, flags: TriMeshFlags) -> Result<TriMesh, TriMeshBuilderError> {
        TriMesh::with_flags(self.vertices.clone(), self.triangles.clone(), flags)
    }

    /// [`Self::trimesh`] without flags, shared: the shape that a plain
    /// `ColliderBuilder::trimesh` would hold.
    ///
    /// Errors: the mesh has no triangles.
    pub fn shared_shape(&self) -> Result<SharedShape, TriMeshBuilderError> {
        Ok(SharedShape::new(self.trimesh(TriMeshFlags::empty())?))
    }
}
