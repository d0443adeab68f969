//! The mesh container and the edits that scenes need.

use std::collections::HashMap;

use glamx::{Pose3, Vec3};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};

/// A named indexed triangle mesh in its own frame.
///
/// Meshes made by this module have indices in range and finite coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Name in reports and error messages.
    pub name: String,
    /// Positions, in scene units.
    pub vertices: Vec<Vec3>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    pub fn new(name: impl Into<String>, vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        Self { name: name.into(), vertices, triangles }
    }

    /// Makes one mesh of all parts, without welding.
    pub fn merged(name: impl Into<String>, parts: &[Self]) -> Self {
        let mut whole = Self::new(name, Vec::new(), Vec::new());
        for part in parts {
            let offset = whole.vertices.len() as u32;
            whole.vertices.extend_from_slice(&part.vertices);
            whole.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + offset)));
        }
        whole
    }

    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Number of triangles, degenerate ones included.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Corners of one triangle.
    ///
    /// # Panics
    ///
    /// If `triangle_index` is out of range.
    pub fn corners(&self, triangle_index: usize) -> [Vec3; 3] {
        self.triangles[triangle_index].map(|i| self.vertices[i as usize])
    }

    /// Box around all vertices; [`Aabb::new_invalid`] without vertices.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::new_invalid();
        self.vertices.iter().for_each(|&vertex| bounds.take_point(vertex));
        bounds
    }

    /// Signed volume: positive if a closed surface faces outwards. For an open surface, the volume
    /// between the surface and the origin.
    pub fn volume(&self) -> f64 {
        let six_fold = (0..self.triangle_count()).map(|index| {
            let [a, b, c] = self.corners(index).map(Vec3::as_dvec3);
            a.dot(b.cross(c))
        });
        six_fold.sum::<f64>() / 6.0
    }

    /// Maps every vertex. A mirroring map turns the surface inside out.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        self.vertices.iter_mut().for_each(|vertex| *vertex = map(*vertex));
        self
    }

    /// Keeps the triangles whose corners pass a test.
    pub fn keeping(mut self, is_kept: impl Fn([Vec3; 3]) -> bool) -> Self {
        let vertices = &self.vertices;
        self.triangles.retain(|triangle| is_kept(triangle.map(|index| vertices[index as usize])));
        self
    }

    pub fn posed(self, pose: &Pose3) -> Self {
        self.mapped(|v| pose.transform_point(v))
    }

    /// Scales the mesh about the origin.
    pub fn scaled(self, factor: f32) -> Self {
        self.mapped(|v| v * factor)
    }

    /// Scales the mesh about the origin so that the longest side of [`Self::bounds`] is `size`.
    /// Returns a mesh without extent unchanged.
    pub fn scaled_to(self, size: f32) -> Self {
        let longest = self.bounds().extents().max_element();
        if longest > 0.0 { self.scaled(size / longest) } else { self }
    }

    /// Moves the centre of [`Self::bounds`] to the origin.
    pub fn centred(self) -> Self {
        let centre = self.bounds().center();
        self.mapped(|v| v - centre)
    }

    /// Joins equal positions (`-0` is `0`) in order of first use and drops unused ones. Triangles
    /// that become degenerate stay.
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

    /// Builds Parry's shape as stock Rapier builds it.
    ///
    /// # Panics
    ///
    /// If the mesh has no triangles, or if `flags` ask for a topology that the mesh does not have.
    pub fn trimesh(&self, flags: TriMeshFlags) -> TriMesh {
        let mesh = TriMesh::with_flags(self.vertices.clone(), self.triangles.clone(), flags);
        mesh.unwrap_or_else(|cause| panic!("the mesh `{}`: {cause}", self.name))
    }

    /// Builds the shape that a plain `ColliderBuilder::trimesh` holds.
    ///
    /// # Panics
    ///
    /// If the mesh has no triangles.
    pub fn shape(&self) -> SharedShape {
        self.shape_with(TriMeshFlags::empty())
    }

    /// Like [`Self::shape`], with flags.
    pub fn shape_with(&self, flags: TriMeshFlags) -> SharedShape {
        SharedShape::new(self.trimesh(flags))
    }
}
