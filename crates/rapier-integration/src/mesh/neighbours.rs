use std::cell::RefCell;

use parry3d::shape::TriMesh;
use rustc_hash::FxHashMap;
use sbbk_core::surface::HalfEdges;

/// Twins of the edges of the triangles that a pair has touched, by triangle.
pub(crate) type Neighbours = FxHashMap<u32, [Option<u32>; 3]>;

/// Adjacency of a mesh that is too large to analyse as a whole. Finds the neighbours of a triangle by
/// the BVH, in about 1 µs.
pub(crate) struct NearTwins<'a> {
    mesh: &'a TriMesh,
    known: RefCell<&'a mut Neighbours>,
}

impl<'a> NearTwins<'a> {
    /// Triangles whose neighbours a pair keeps. Higher: more memory for a body that crosses a large
    /// mesh; lower: bodies that touch many triangles search for the same neighbours again.
    const MOST: usize = 4096;

    pub(crate) fn new(mesh: &'a TriMesh, known: &'a mut Neighbours) -> Self {
        if known.len() > Self::MOST {
            known.clear();
        }
        Self { mesh, known: RefCell::new(known) }
    }
}

impl HalfEdges for NearTwins<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        let (triangle, edge) = (half_edge / 3, half_edge as usize % 3);
        let mut known = self.known.borrow_mut();
        known.entry(triangle).or_insert_with(|| twins_of(self.mesh, triangle))[edge]
    }
}

/// Returns the twins of the edges of a triangle. Vertices at one place are one vertex, as in
/// [`Surface`](sbbk_core::surface::Surface).
fn twins_of(mesh: &TriMesh, triangle: u32) -> [Option<u32>; 3] {
    let triangle = mesh.triangle(triangle);
    let own = [triangle.a, triangle.b, triangle.c];
    let (mut forward, mut backward, mut twins) = ([0; 3], [0; 3], [None; 3]);
    for other in mesh.bvh().intersect_aabb(&triangle.local_aabb()) {
        let neighbour = mesh.triangle(other);
        let theirs = [neighbour.a, neighbour.b, neighbour.c];
        for (i, j) in (0..9).map(|pair| (pair / 3, pair % 3)) {
            let [a, b] = [own[i], own[(i + 1) % 3]];
            let [c, d] = [theirs[j], theirs[(j + 1) % 3]];
            if a == d && b == c {
                backward[i] += 1;
                twins[i] = Some(3 * other + j as u32);
            } else if a == c && b == d {
                forward[i] += 1;
            }
        }
    }
    std::array::from_fn(|i| twins[i].filter(|_| forward[i] == 1 && backward[i] == 1))
}

#[cfg(test)]
mod tests {
    use oorandom::Rand32;
    use parry3d::math::Vector;
    use sbbk_core::surface::Surface;

    use super::*;

    /// The triangles of these soups are often points, segments, duplicates, or share an edge with two
    /// others.
    #[test]
    fn local_twins_are_those_of_the_surface() {
        let (mut random, mut found) = (Rand32::new(1), 0);
        for round in 0..400 {
            let mut place = || Vector::from_array([(); 3].map(|()| random.rand_range(0..3) as f32));
            let vertices: Vec<Vector> = (0..12).map(|_| place()).collect();
            let mut corner = || random.rand_range(0..12);
            let triangles = (0..1 + round % 20).map(|_| [corner(), corner(), corner()]).collect();
            let mesh = TriMesh::new(vertices, triangles).expect("there are triangles");
            let whole = Surface::new(mesh.vertices(), mesh.indices());
            let mut known = Neighbours::default();
            let near = NearTwins::new(&mesh, &mut known);
            for half_edge in 0..3 * mesh.indices().len() as u32 {
                let twin = whole.twin(half_edge);
                assert_eq!(near.twin(half_edge), twin, "{half_edge} of {:?}", mesh.indices());
                found += u32::from(twin.is_some());
            }
        }
        assert!(found > 1000, "{found} twins");
    }

    #[test]
    fn neighbours_are_forgotten_beyond_the_limit() {
        let triangle = vec![[0, 1, 2]];
        let mesh = TriMesh::new(vec![Vector::ZERO, Vector::X, Vector::Y], triangle).unwrap();
        let most = NearTwins::MOST as u32;
        let mut known: Neighbours = (0..most).map(|index| (index, [None; 3])).collect();
        NearTwins::new(&mesh, &mut known);
        assert_eq!(known.len(), most as usize);
        known.insert(most, [None; 3]);
        NearTwins::new(&mesh, &mut known);
        assert!(known.is_empty());
    }
}
