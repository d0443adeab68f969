//! What "the same mesh" means.
//!
//! A dispatcher sees a `&TriMesh` and nothing else: no handle, no generation. Its address proves
//! nothing, since freed memory is used again and `SharedShape::make_mut` edits in place (unless the
//! shape is held here: [`registry`](super::registry)). So there are two notions:
//!
//! * [`ContentHash`], 128 bits over all that a [`PreparedMesh`](super::PreparedMesh) is made of:
//!   vertices, triangles, and whether it deforms. Meshes with equal hashes share one prepared mesh,
//!   wherever they are: clones, copies restored from a snapshot, the same file loaded twice. The hash reads the whole
//!   mesh (about 4 µs for 1000 triangles), so it is asked for only where a tree is built, once by each
//!   pair of two meshes about those that are small, and about a large one where one with as many
//!   triangles is there.
//! * [`MeshToken`], constant time, made at every query: addresses and sizes of the buffers, the
//!   flags, the root box of Parry's own hierarchy, and a few sampled vertices and triangles. If it
//!   changed, a pair forgets the mesh and its tree; whether vertices are finite is remembered by it
//!   too ([`soundness`](super::soundness)).
//!
//! Between two queries of one pair a mesh may change unseen by the token only if its buffers stay
//! in place, the root box stays equal and no sample moves: an edit of single vertices by
//! `TriMesh::update_vertices`. Rapier drops the pair's workspace when a shape was edited
//! (`ColliderChanges::SHAPE`, set by `shape_mut` and `set_shape`), and with it the token; other
//! hosts must do the same, as Parry asks for its own workspaces too.
//!
//! A mesh that is meant to deform (`TriMeshFlags::DEFORMABLE`) may change at any time: a pair keeps
//! nothing of it. Queries without manifolds have no workspace that a host could drop: they compare
//! all of a mesh with a [`ContentCopy`].

use std::hash::Hasher;

use parry3d::math::Vector;
use parry3d::shape::{TriMesh, TriMeshFlags};
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

/// Names a mesh by its content.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ContentHash(u128);

impl ContentHash {
    pub(crate) fn of(mesh: &TriMesh) -> Self {
        let mut hasher = Xxh3::new();
        add_topology(mesh, &mut hasher);
        hasher.update(bytemuck::cast_slice(mesh.vertices()));
        Self(hasher.digest128())
    }
}

/// Adds the triangles, and whether they deform.
fn add_topology(mesh: &TriMesh, hasher: &mut Xxh3) {
    hasher.write_usize(mesh.vertices().len());
    hasher.write_usize(mesh.indices().len());
    hasher.write_u16((mesh.flags() & TriMeshFlags::DEFORMABLE).bits());
    hasher.update(bytemuck::cast_slice(mesh.indices()));
}

/// Vertices and triangles of a mesh, to be compared with those of another. For 10,000 vertices and
/// 20,000 triangles that takes less than half as long as a hash of the vertices alone (xxh3, built
/// for SSE2).
pub(super) struct ContentCopy {
    vertices: Box<[Vector]>,
    triangles: Box<[[u32; 3]]>,
}

impl ContentCopy {
    pub(super) fn of(mesh: &TriMesh) -> Self {
        Self { vertices: mesh.vertices().into(), triangles: mesh.indices().into() }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.vertices) + size_of_val(&*self.triangles)
    }

    /// Whether both are the same, bit for bit.
    pub(super) fn is_of(&self, mesh: &TriMesh) -> bool {
        let bytes = |vertices| -> &[u8] { bytemuck::cast_slice::<Vector, u8>(vertices) };
        bytes(&self.vertices) == bytes(mesh.vertices()) && *self.triangles == *mesh.indices()
    }

    /// Whether a triangle has the same corners, bit for bit.
    pub(super) fn has_triangle_of(&self, mesh: &TriMesh, triangle: u32) -> bool {
        let corners = |vertices: &[Vector], triangles: &[[u32; 3]]| {
            let [a, b, c] = *triangles.get(triangle as usize)?;
            let corner =
                |index: u32| Some(vertices.get(index as usize)?.to_array().map(f32::to_bits));
            Some([corner(a)?, corner(b)?, corner(c)?])
        };
        let kept = corners(&self.vertices, &self.triangles);
        kept.is_some() && kept == corners(mesh.vertices(), mesh.indices())
    }
}

/// Tells in constant time that a mesh is most likely still the one it was.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MeshToken(pub(super) u64);

impl MeshToken {
    /// Vertices and triangles looked at, evenly spread.
    const SAMPLES: usize = 4;

    pub(crate) fn of(mesh: &TriMesh) -> Self {
        let (vertices, triangles) = (mesh.vertices(), mesh.indices());
        let root = mesh.bvh().root_aabb();
        let sample = |i: usize, count: usize| i * count / Self::SAMPLES;
        let mut words = [0u32; 6 + 6 + 6 * Self::SAMPLES];
        let addresses = [vertices.as_ptr() as u64, triangles.as_ptr() as u64];
        words[0..4].copy_from_slice(bytemuck::cast_slice(&addresses));
        words[4] = vertices.len() as u32 ^ (triangles.len() as u32).rotate_left(16);
        words[5] = u32::from(mesh.flags().bits());
        words[6..9].copy_from_slice(bytemuck::cast_slice(&[root.mins]));
        words[9..12].copy_from_slice(bytemuck::cast_slice(&[root.maxs]));
        for (i, words) in words[12..].chunks_exact_mut(6).enumerate() {
            if let Some(vertex) = vertices.get(sample(i, vertices.len())) {
                words[..3].copy_from_slice(bytemuck::cast_slice(std::slice::from_ref(vertex)));
            }
            if let Some(triangle) = triangles.get(sample(i, triangles.len())) {
                words[3..].copy_from_slice(triangle);
            }
        }
        Self(xxh3_64(bytemuck::cast_slice(&words)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles in a row, or with their places in another order.
    fn row(place: impl Fn(usize) -> usize, flags: TriMeshFlags) -> TriMesh {
        let corners = |i| {
            let x = place(i) as f32;
            [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]].map(Vector::from_array)
        };
        let triangles = (0..16).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        TriMesh::with_flags((0..16).flat_map(corners).collect(), triangles, flags).unwrap()
    }

    /// Would catch a part of what prepared meshes are made of that does not count.
    #[test]
    fn all_that_is_prepared_is_hashed() {
        let mesh = row(|i| i, TriMeshFlags::empty());
        let hash = ContentHash::of(&mesh);
        assert_eq!(ContentHash::of(&mesh.clone()), hash);
        assert_ne!(ContentHash::of(&row(|i| i, TriMeshFlags::DEFORMABLE)), hash, "flags");
        let mut triangles = mesh.indices().to_vec();
        triangles[7].swap(1, 2);
        let reversed = TriMesh::new(mesh.vertices().to_vec(), triangles).unwrap();
        assert_ne!(ContentHash::of(&reversed), hash, "triangles");
    }

    /// Would catch an edit in place that a pair does not see, and a mesh taken for its clone.
    #[test]
    fn edits_in_place_change_the_token() {
        let mut mesh = row(|i| i, TriMeshFlags::empty());
        let clone = mesh.clone();
        assert_ne!(MeshToken::of(&clone), MeshToken::of(&mesh));
        // Vertices that are no sample move the box, at either end; one that is moves within it.
        for (vertex, to) in [(1, [1.0, 0.0, -1.0]), (4, [2.0, 0.0, 1.0]), (24, [8.1, 0.1, 0.0])] {
            let before = MeshToken::of(&mesh);
            mesh.update_vertices(|vertices| vertices[vertex] = Vector::from_array(to));
            assert_ne!(MeshToken::of(&mesh), before, "vertex {vertex}");
        }
        let before = MeshToken::of(&mesh);
        mesh.set_flags(TriMeshFlags::DEFORMABLE).unwrap();
        assert_ne!(MeshToken::of(&mesh), before, "flags");
    }
}
