//! Four notions of "the same mesh".
//!
//! A dispatcher receives a `&TriMesh` without handle or version.
//!
//! * The address, for a [registered](super::store::Registered) mesh alone: memory is used again,
//!   and `SharedShape::make_mut` edits in place.
//! * [`ContentHash`]: 128 bits over vertices, triangles, and the deformable flag. Meshes with equal
//!   hashes share their data: clones, restored snapshots, the same file loaded twice. A hash takes
//!   4 µs for 1000 triangles, so each pair computes one hash.
//! * [`ContentHash::of_samples`], for a large unregistered mesh: a hash of addresses and samples.
//!   An edit of few vertices in place may go unnoticed: the mesh then keeps its old neighbours and
//!   sides.
//! * [`MeshToken`]: some words in constant time, compared at every query. If the token has changed,
//!   the pair forgets the mesh.
//!
//! An edit by `TriMesh::update_vertices` that moves neither the root box nor a sampled vertex
//! leaves the token as it was. Rapier drops the workspace of a pair when a shape was edited, and
//! other hosts must do the same. Parry's own workspaces rely on it, too.

use std::hash::Hasher;

use parry3d::shape::{TriMesh, TriMeshFlags};
use xxhash_rust::xxh3::Xxh3;

/// Identifies a mesh by its content, or a large unregistered mesh by addresses and samples.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ContentHash(u128);

impl ContentHash {
    pub(crate) fn of(mesh: &TriMesh) -> Self {
        let mut hasher = Xxh3::new();
        hasher.write_usize(mesh.vertices().len());
        hasher.write_usize(mesh.indices().len());
        hasher.write_u16((mesh.flags() & TriMeshFlags::DEFORMABLE).bits());
        hasher.update(bytemuck::cast_slice(mesh.indices()));
        hasher.update(bytemuck::cast_slice(mesh.vertices()));
        Self(hasher.digest128())
    }

    /// Hash of the addresses, sizes, flags and samples of a large mesh, in about 2 µs.
    pub(crate) fn of_samples(mesh: &TriMesh) -> Self {
        /// Number of sampled vertices and triangles. Higher: more edits in place are noticed;
        /// lower: each new pair is quicker.
        const SAMPLES: usize = 512;
        let (vertices, triangles) = (mesh.vertices(), mesh.indices());
        // One hash of a copy is three times as fast as a hash of sample after sample.
        let samples: [_; SAMPLES] = std::array::from_fn(|i| {
            let vertex = vertices[i * vertices.len() / SAMPLES].to_array();
            [vertex.map(f32::to_bits), triangles[i * triangles.len() / SAMPLES]]
        });
        let mut hasher = Xxh3::new();
        hasher.update(bytemuck::cast_slice(&MeshToken::of(mesh).0));
        hasher.update(bytemuck::cast_slice(&samples));
        Self(hasher.digest128())
    }
}

/// Identifies a mesh by its buffers, flags, root box and a few samples, in constant time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MeshToken([u32; Self::WORDS]);

impl MeshToken {
    /// Number of sampled vertices and triangles, evenly spread. Higher: more edits in place change
    /// the token; lower: each query is quicker.
    const SAMPLES: usize = 4;
    const WORDS: usize = 12 + 6 * Self::SAMPLES;

    pub(crate) fn of(mesh: &TriMesh) -> Self {
        let (vertices, triangles) = (mesh.vertices(), mesh.indices());
        let root = mesh.bvh().root_aabb();
        let sample = |i: usize, count: usize| i * count / Self::SAMPLES;
        let mut words = [0; Self::WORDS];
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
        Self(words)
    }
}

#[cfg(test)]
mod tests {
    use parry3d::math::Vector;

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

    #[test]
    fn flags_triangles_and_vertices_are_hashed_but_not_the_bvh() {
        let mesh = row(|i| i, TriMeshFlags::empty());
        let hash = ContentHash::of(&mesh);
        assert_eq!(ContentHash::of(&mesh.clone()), hash);
        assert_ne!(ContentHash::of(&row(|i| i, TriMeshFlags::DEFORMABLE)), hash, "flags");
        let mut triangles = mesh.indices().to_vec();
        triangles[7].swap(1, 2);
        let reversed = TriMesh::new(mesh.vertices().to_vec(), triangles).unwrap();
        assert_ne!(ContentHash::of(&reversed), hash, "triangles");
        // An edit refits the BVH.
        let mut edited = row(|i| i * 7 % 16, TriMeshFlags::empty());
        assert_ne!(ContentHash::of(&edited), hash, "vertices");
        edited.set_vertices(mesh.vertices());
        let leaves = |mesh: &TriMesh| mesh.bvh().leaves(|_| true).collect::<Vec<_>>();
        assert_ne!(leaves(&edited), leaves(&mesh));
        assert_eq!(ContentHash::of(&edited), hash);
    }

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
