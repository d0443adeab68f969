//! The mesh container and the edits that scenes need.

use std::collections::HashMap;

use glamx::{Pose3, Vec3};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshBuilderError, TriMeshFlags};

/// A named indexed triangle mesh, in its own frame.
///
/// The fields are public: a mesh is data, not an invariant. Meshes made by this module have
/// indices in range and finite coordinates.
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

    /// One mesh of all parts, each a component of its own: nothing is welded.
    pub fn merged(name: impl Into<String>, parts: &[Self]) -> Self {
        let mut whole = Self::new(name, Vec::new(), Vec::new());
        for part in parts {
            let offset = whole.vertices.len() as u32;
            whole.vertices.extend_from_slice(&part.vertices);
            whole.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
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

    /// The corners of one triangle.
    ///
    /// # Panics
    ///
    /// If `triangle_index` is out of range.
    pub fn corners(&self, triangle_index: usize) -> [Vec3; 3] {
        self.triangles[triangle_index].map(|i| self.vertices[i as usize])
    }

    /// Box around all vertices; [`Aabb::new_invalid`] when there are none.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::new_invalid();
        self.vertices.iter().for_each(|&vertex| bounds.take_point(vertex));
        bounds
    }

    /// Signed volume, in cubed units: positive when a closed surface faces outwards. Of an open
    /// surface, the volume between it and the origin.
    pub fn volume(&self) -> f64 {
        let six_fold: f64 = (0..self.triangle_count())
            .map(|index| {
                let [a, b, c] = self.corners(index).map(Vec3::as_dvec3);
                a.dot(b.cross(c))
            })
            .sum();
        six_fold / 6.0
    }

    /// Every vertex mapped by `map`. Triangles stay as they are: a mirroring map turns the
    /// surface inside out.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        self.vertices.iter_mut().for_each(|vertex| *vertex = map(*vertex));
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
        let centre = self.bounds().center();
        self.mapped(|v| v - centre)
    }

    /// The same triangles over distinct positions in order of first use, without unused ones.
    /// Positions are equal when all coordinates are (`-0` is `0`). Triangles that become
    /// degenerate stay.
    pub fn welded(&self) -> Self {
        // Adding zero turns -0 into 0, and the bits of equal positions are then equal.
        let key = |position: Vec3| (position + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut vertices = Vec::new();
        let mut index_of = HashMap::with_capacity(self.vertices.len());
        let mut weld = |index: u32| {
            let position = self.vertices[index as usize];
            *index_of.entry(key(position)).or_insert_with(|| {
                vertices.push(position);
                vertices.len() as u32 - 1
            })
        };
        let triangles = self.triangles.iter().map(|t| t.map(&mut weld)).collect();
        Self::new(self.name.clone(), vertices, triangles)
    }

    /// The mesh as Parry's shape, built as stock Rapier builds it.
    ///
    /// Errors: the mesh has no triangles, or `flags` ask for a topology that it does not have.
    pub fn trimesh(&self, flags: TriMeshFlags) -> Result<TriMesh, TriMeshBuilderError> {
        TriMesh::with_flags(self.vertices.clone(), self.triangles.clone(), flags)
    }

    /// [`Self::trimesh`] without flags, shared: what a plain `ColliderBuilder::trimesh` holds.
    ///
    /// Errors: the mesh has no triangles.
    pub fn shared_shape(&self) -> Result<SharedShape, TriMeshBuilderError> {
        Ok(SharedShape::new(self.trimesh(TriMeshFlags::empty())?))
    }
}
