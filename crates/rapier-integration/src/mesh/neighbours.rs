//! Neighbours of the triangles of a mesh, found one by one by its BVH where something touches.

use std::ops::ControlFlow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use parry3d::math::Vector;
use parry3d::shape::TriMesh;
use rustc_hash::FxHashSet;
use sbbk_core::surface::{Place, RayTriangles, hangs, is_flat, place, sides};

use super::flags::TriangleFlags;
use super::rays::MeshRays;

/// The twins of the edges of a triangle, and its flags.
#[derive(Debug, Default)]
pub(super) struct Neighbour {
    /// 0 before the search, 1 for none, else 2 more than the twin. The highest bits tell if the triangle is a double, and if it
    /// has a double that is wound the other way.
    twins: [AtomicU32; 3],
    pub(super) flags: TriangleFlags,
}

impl Neighbour {
    const HIGHEST: u32 = 1 << 31;

    fn is_known(&self) -> bool {
        // Makes the other twins visible, see `find`.
        self.twins[0].load(Ordering::Acquire) != 0
    }

    pub(super) fn twin(&self, edge: u32) -> Option<u32> {
        let twin = self.twins[edge as usize].load(Ordering::Relaxed);
        (twin & !Self::HIGHEST).checked_sub(2)
    }

    fn has_highest(&self, edge: usize) -> bool {
        self.twins[edge].load(Ordering::Relaxed) & Self::HIGHEST != 0
    }

    pub(super) fn is_double(&self) -> bool {
        self.has_highest(0)
    }

    pub(super) fn is_two_sided(&self) -> bool {
        self.has_highest(1)
    }

    /// Finds the neighbours of a triangle in about 1 µs. Other threads may find the same ones meanwhile.
    #[cold]
    fn find(&self, mesh: &TriMesh, triangle: u32) {
        let (twins, is_double) = twins(mesh, triangle);
        let highest = [is_double, is_two_sided(mesh, triangle), false];
        for edge in [2, 1, 0] {
            let twin = twins[edge].map_or(1, |twin| twin + 2);
            let highest = if highest[edge] { Self::HIGHEST } else { 0 };
            self.twins[edge].store(twin | highest, Ordering::Release);
        }
    }
}

/// Returns true if a triangle has a double that is wound the other way.
pub(super) fn is_two_sided(mesh: &TriMesh, triangle: u32) -> bool {
    let rays = MeshRays(mesh);
    let [a, b, c] = rays.corners(triangle);
    let backs = [[a, c, b], [c, b, a], [b, a, c]];
    let mut is_two_sided = false;
    rays.near(triangle, 0.0, &mut |other| {
        is_two_sided = backs.contains(&rays.corners(other));
        if is_two_sided { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    is_two_sided
}

/// Returns the twins of the edges of a triangle, and whether it is a double. Vertices at one place are one vertex, and doubles
/// have no neighbours, as in [`Surface`].
fn twins(mesh: &TriMesh, triangle: u32) -> ([Option<u32>; 3], bool) {
    let corners = |triangle: u32| *mesh.triangle(triangle).vertices();
    let own = corners(triangle);
    let shares_edge = |other: &u32| {
        let theirs = corners(*other);
        own.into_iter().filter(|corner| theirs.contains(corner)).count() > 1
    };
    let bounds = mesh.triangle(triangle).local_aabb();
    let near = mesh.bvh().intersect_aabb(&bounds);
    let mut near: Vec<u32> = near.filter(shares_edge).collect();
    near.sort_unstable();
    let mut known = FxHashSet::default();
    near.retain(|&other| sliver(mesh, other) != Some(true) && known.insert(places(corners(other))));
    let is_first = near.contains(&triangle);
    let (mut forward, mut backward, mut twins) = ([0; 3], [0; 3], [None; 3]);
    for other in near {
        let theirs = corners(other);
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
    let is_paired = |i: usize| is_first && forward[i] == 1 && backward[i] == 1;
    let is_double = !is_first || sliver(mesh, triangle).is_some();
    (std::array::from_fn(|i| twins[i].filter(|_| is_paired(i))), is_double)
}

/// Returns whether a sliver [hangs](hangs()). `None` for other triangles.
pub(super) fn sliver(mesh: &TriMesh, triangle: u32) -> Option<bool> {
    let corners = |triangle: u32| *mesh.triangle(triangle).vertices();
    let sides = |triangle: u32| sides(corners(triangle).map(place));
    if !is_flat(&corners(triangle)) {
        return None;
    }
    let mut counted = sides(triangle).map(|ends| (ends, [0; 2]));
    for other in mesh.bvh().intersect_aabb(&mesh.triangle(triangle).local_aabb()) {
        let is_flat = u32::from(is_flat(&corners(other)));
        let theirs = sides(other);
        for (ends, [flat, all]) in &mut counted {
            let count = theirs.iter().filter(|side| *side == ends).count() as u32;
            *flat += is_flat * count;
            *all += count;
        }
    }
    hangs(&counted)
}

/// Returns the places of three corners, sorted.
pub(super) fn places(corners: [Vector; 3]) -> [Place; 3] {
    let mut places = corners.map(place);
    places.sort_unstable();
    places
}

/// Neighbours of triangles, found where something touches the mesh. Threads share them, and take no lock.
#[derive(Debug)]
pub(crate) struct Neighbours {
    chunks: Box<[OnceLock<Box<Chunk>>]>,
    chunk_count: AtomicUsize,
}

/// Triangles whose memory is reserved at once. Higher: more memory where few triangles are touched. Lower: a larger table.
const CHUNK: usize = 64;

type Chunk = [Neighbour; CHUNK];

impl Neighbours {
    /// Reserves a table for `count` triangles.
    pub(super) fn new(count: usize) -> Self {
        let chunks = (0..count.div_ceil(CHUNK)).map(|_| OnceLock::new()).collect();
        Self { chunks, chunk_count: AtomicUsize::new(0) }
    }

    /// Returns the neighbours of a triangle.
    #[inline]
    pub(super) fn of(&self, mesh: &TriMesh, triangle: u32) -> &Neighbour {
        let triangle_in = triangle as usize % CHUNK;
        let chunk = self.chunks[triangle as usize / CHUNK].get_or_init(|| {
            self.chunk_count.fetch_add(1, Ordering::Relaxed);
            Box::new(std::array::from_fn(|_| Neighbour::default()))
        });
        let neighbour = &chunk[triangle_in];
        if !neighbour.is_known() {
            neighbour.find(mesh, triangle);
        }
        neighbour
    }

    /// Memory in bytes.
    pub(super) fn bytes(&self) -> usize {
        let chunks = self.chunk_count.load(Ordering::Relaxed) * size_of::<Chunk>();
        size_of_val(&*self.chunks) + chunks
    }
}
