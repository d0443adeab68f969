use std::sync::atomic::{AtomicU64, Ordering};

use parry3d::shape::TriMesh;

use super::identity::MeshToken;

/// Meshes that cannot have a tree: not asked about again. By token, so a mesh that is taken for one
/// of them by mistake is answered by Parry, correctly if slowly.
///
/// A table without locks. The address of a mesh is its place there, and so all others cost one look
/// at a place that is most likely empty. Where two meshes have one place, the last one noted is
/// remembered, and the other one is asked about again.
pub(super) struct Unsupported(Box<[AtomicU64; Self::PLACES]>);

impl Default for Unsupported {
    fn default() -> Self {
        Self(Box::new([const { AtomicU64::new(EMPTY) }; Self::PLACES]))
    }
}

const EMPTY: u64 = 0;

impl Unsupported {
    const PLACES: usize = 1 << 10;

    pub(super) fn note(&self, mesh: &TriMesh) {
        self.place(mesh).store(MeshToken::of(mesh).0, Ordering::Relaxed);
    }

    #[inline]
    pub(super) fn contains(&self, mesh: &TriMesh) -> bool {
        let noted = self.place(mesh).load(Ordering::Relaxed);
        noted != EMPTY && noted == MeshToken::of(mesh).0
    }

    #[inline]
    fn place(&self, mesh: &TriMesh) -> &AtomicU64 {
        let address = mesh.vertices().as_ptr().addr() as u64;
        // The upper bits of a product with 2⁶⁴ over the golden ratio spread well.
        let spread = address.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        &self.0[(spread >> (u64::BITS - Self::PLACES.ilog2())) as usize]
    }
}

#[cfg(test)]
mod tests {
    use parry3d::math::Vector;

    use super::*;

    fn mesh(corner: Vector) -> TriMesh {
        TriMesh::new(vec![Vector::ZERO, Vector::X, corner], vec![[0, 1, 2]]).unwrap()
    }

    /// Would catch meshes forgotten while there is room, and a mesh taken for another one: one that
    /// was not noted, and one that was edited.
    #[test]
    fn meshes_are_known_until_another_takes_their_place() {
        let unsupported = Unsupported::default();
        let meshes: Vec<TriMesh> = (0..200).map(|i| mesh(Vector::Y * i as f32)).collect();
        let (noted, others) = meshes.split_at(100);
        noted.iter().for_each(|mesh| unsupported.note(mesh));
        let count = |meshes: &[TriMesh]| meshes.iter().filter(|m| unsupported.contains(m)).count();
        assert!(count(noted) > 80, "{} of 100", count(noted));
        assert_eq!(count(others), 0);
        let mut edited = mesh(Vector::Z);
        unsupported.note(&edited);
        assert!(unsupported.contains(&edited));
        edited.update_vertices(|vertices| vertices[2] = Vector::Y);
        assert!(!unsupported.contains(&edited));
    }

    /// The places of many meshes are many: 1000 at random would be at 639 of 1024.
    #[test]
    fn places_are_spread() {
        let unsupported = Unsupported::default();
        let meshes: Vec<TriMesh> = (0..1000).map(|i| mesh(Vector::Y * i as f32)).collect();
        meshes.iter().for_each(|mesh| unsupported.note(mesh));
        let is_used = |place: &&AtomicU64| place.load(Ordering::Relaxed) != EMPTY;
        let used = unsupported.0.iter().filter(is_used).count();
        assert!(used > 500, "{used} places");
    }
}
