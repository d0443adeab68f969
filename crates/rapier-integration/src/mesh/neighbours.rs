use std::cell::RefCell;

use parry3d::shape::TriMesh;
use rustc_hash::FxHashMap;
use sbbk_core::surface::Twins;

/// The neighbours of the triangles of a mesh that a pair has come across: of a mesh that is too large
/// to look at as a whole.
pub(crate) type Neighbours = FxHashMap<u32, [Option<u32>; 3]>;

/// Finds them where they are asked for, by Parry's hierarchy: about a microsecond a triangle.
pub(crate) struct NearTwins<'a> {
    mesh: &'a TriMesh,
    known: RefCell<&'a mut Neighbours>,
}

impl<'a> NearTwins<'a> {
    /// Triangles that a pair may know. More: more memory for a body that crosses a large mesh; fewer:
    /// bodies in contact with many triangles look for them again and again.
    const MOST: usize = 4096;

    pub(crate) fn new(mesh: &'a TriMesh, known: &'a mut Neighbours) -> Self {
        if known.len() > Self::MOST {
            known.clear();
        }
        Self { mesh, known: RefCell::new(known) }
    }
}

impl Twins for NearTwins<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        let (triangle, edge) = (half_edge / 3, half_edge as usize % 3);
        let mut known = self.known.borrow_mut();
        known.entry(triangle).or_insert_with(|| twins_of(self.mesh, triangle))[edge]
    }
}

/// The twins of the edges of a triangle. As `sbbk_core::surface::Surface` has them: vertices at one
/// place are one vertex.
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
            if a == d && b == c && a != b {
                backward[i] += 1;
                twins[i] = Some(3 * other + j as u32);
            } else if a == c && b == d {
                forward[i] += 1;
            }
        }
    }
    std::array::from_fn(|i| twins[i].filter(|_| forward[i] == 1 && backward[i] == 1))
}
