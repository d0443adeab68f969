use std::sync::atomic::{AtomicU64, Ordering};

use parry3d::shape::TriMesh;

use super::identity::MeshToken;

/// Which meshes have vertices that are NaN or infinite. By token: such a vertex of a mesh that has
/// the same token as before is overlooked, and its triangles touch nothing all the same.
///
/// A table without locks. The address of a mesh is its place there. Where two meshes have one
/// place, the last one looked at is remembered, and the other one is looked at again.
pub(super) struct Soundness(Box<[AtomicU64; Self::PLACES]>);

impl Default for Soundness {
    fn default() -> Self {
        Self(Box::new([const { AtomicU64::new(EMPTY) }; Self::PLACES]))
    }
}

const EMPTY: u64 = 0;

impl Soundness {
    const PLACES: usize = 1 << 10;

    /// Whether a triangle of the mesh has a vertex that is not finite. Reads all vertices of a mesh
    /// that it does not know, a millisecond for a million.
    #[inline]
    pub(super) fn is_broken(&self, mesh: &TriMesh, token: MeshToken) -> bool {
        // The lowest bit is the answer.
        let (place, name) = (self.place(mesh), token.0 & !1 | 2);
        let noted = place.load(Ordering::Relaxed);
        if noted & !1 == name {
            return noted & 1 == 1;
        }
        let is_broken = is_broken(mesh);
        place.store(name | u64::from(is_broken), Ordering::Relaxed);
        is_broken
    }

    #[inline]
    fn place(&self, mesh: &TriMesh) -> &AtomicU64 {
        let address = mesh.vertices().as_ptr().addr() as u64;
        // The upper bits of a product with 2⁶⁴ over the golden ratio spread well.
        let spread = address.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        &self.0[(spread >> (u64::BITS - Self::PLACES.ilog2())) as usize]
    }
}

/// Vertices that no triangle uses may be anything.
fn is_broken(mesh: &TriMesh) -> bool {
    // Zero times a number is zero, or NaN: sums need no branches.
    let coordinates: &[f32] = bytemuck::cast_slice(mesh.vertices());
    let mut sums = [0.0; 16];
    let (blocks, rest) = coordinates.as_chunks::<16>();
    for block in blocks {
        for (sum, x) in sums.iter_mut().zip(block) {
            *sum += 0.0 * x;
        }
    }
    let is_finite = sums.iter().chain(rest).all(|x| x.is_finite());
    !is_finite && !mesh.indices().iter().all(|triangle| is_whole(mesh, triangle))
}

/// The triangles of a mesh whose corners are finite.
pub(crate) fn whole_ones(mesh: &TriMesh) -> impl Iterator<Item = u32> {
    let triangles = mesh.indices().iter().zip(0..);
    triangles.filter(|(triangle, _)| is_whole(mesh, triangle)).map(|(_, index)| index)
}

/// Whether all corners of a triangle are finite.
fn is_whole(mesh: &TriMesh, triangle: &[u32; 3]) -> bool {
    let is_finite =
        |&vertex: &u32| mesh.vertices().get(vertex as usize).is_some_and(|v| v.is_finite());
    triangle.iter().all(is_finite)
}

#[cfg(test)]
mod tests {
    use parry3d::math::Vector;

    use super::*;

    fn mesh(corner: Vector) -> TriMesh {
        TriMesh::new(vec![Vector::ZERO, Vector::X, corner], vec![[0, 1, 2]]).unwrap()
    }

    /// Would catch answers that are another mesh's, or that outlive an edit.
    #[test]
    fn every_mesh_gets_its_own_answer() {
        let soundness = Soundness::default();
        let broken = |mesh: &TriMesh| soundness.is_broken(mesh, MeshToken::of(mesh));
        let corner =
            |i: usize| if i.is_multiple_of(3) { Vector::NAN } else { Vector::Y * i as f32 };
        let mut meshes: Vec<TriMesh> = (0..3000).map(|i| mesh(corner(i))).collect();
        for _ in 0..2 {
            for (i, mesh) in meshes.iter().enumerate() {
                assert_eq!(broken(mesh), i % 3 == 0, "{i}");
            }
        }
        for (i, mesh) in meshes.iter_mut().enumerate() {
            mesh.update_vertices(|vertices| vertices[2] = corner(i + 1));
            assert_eq!(broken(mesh), (i + 1) % 3 == 0, "{i}");
        }
    }

    /// Would catch a vertex overlooked for its place among others, and one that no triangle has.
    #[test]
    fn each_vertex_counts_if_it_is_used() {
        for count in [3, 4, 5, 16, 17, 64] {
            for bad in 0..count {
                for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                    let mut vertices: Vec<_> = (0..count).map(|i| Vector::X * i as f32).collect();
                    vertices[bad].y = value;
                    let triangles = (0..count as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
                    let mesh = TriMesh::new(vertices.clone(), triangles).unwrap();
                    assert!(is_broken(&mesh), "{bad} of {count}");
                    let unused = TriMesh::new(vertices, vec![[(bad as u32 + 1) % 3; 3]]).unwrap();
                    assert_eq!(is_broken(&unused), (bad + 1) % 3 == bad, "{bad} of {count}");
                }
            }
        }
    }

    /// The places of many meshes are many: 1000 at random would be at 639 of 1024.
    #[test]
    fn places_are_spread() {
        let soundness = Soundness::default();
        let meshes: Vec<TriMesh> = (0..1000).map(|i| mesh(Vector::Y * i as f32)).collect();
        meshes.iter().for_each(|mesh| _ = soundness.is_broken(mesh, MeshToken::of(mesh)));
        let is_used = |place: &&AtomicU64| place.load(Ordering::Relaxed) != EMPTY;
        let used = soundness.0.iter().filter(is_used).count();
        assert!(used > 500, "{used} places");
    }
}
