//! Neighbours of the triangles of a mesh, found one by one by its BVH where something touches.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use arrayvec::ArrayVec;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::shape::TriMesh;
use rustc_hash::FxHashSet;
use sbbk_core::surface::{Place, hangs, is_flat, place, sides};

use super::flags::TriangleFlags;

/// The twins of the edges of a triangle, and its flags.
#[derive(Debug, Default)]
pub(super) struct Neighbour {
    /// 0 before the search, 1 for none, else 2 more than the twin. The highest bit of the first
    /// tells if the triangle is a double.
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

    pub(super) fn is_double(&self) -> bool {
        self.twins[0].load(Ordering::Relaxed) & Self::HIGHEST != 0
    }

    /// Finds the neighbours of a triangle in about 1 µs. Other threads may find the same ones
    /// meanwhile.
    #[cold]
    fn find(&self, mesh: &TriMesh, triangle: u32) {
        let (twins, is_double) = twins(mesh, triangle);
        for edge in [2, 1, 0] {
            let twin = twins[edge].map_or(1, |twin| twin + 2);
            let highest = if is_double && edge == 0 { Self::HIGHEST } else { 0 };
            self.twins[edge].store(twin | highest, Ordering::Release);
        }
    }
}

/// Triangles at one end of an edge beyond which the other end is searched. Higher: fans take
/// longer. Lower: edges between two fans take longer.
const MOST_NEAR: usize = 64;

/// Returns the triangles whose boxes hold both ends of an edge, and others at one end. Looks at an
/// end with fewer than [`MOST_NEAR`].
fn near_edge(mesh: &TriMesh, ends: [Vector; 2]) -> Vec<u32> {
    for end in ends {
        let at = Aabb::new(end, end);
        let near: ArrayVec<u32, MOST_NEAR> =
            mesh.bvh().intersect_aabb(&at).take(MOST_NEAR).collect();
        if !near.is_full() {
            return near.to_vec();
        }
    }
    let [one, other] = ends;
    mesh.bvh().intersect_aabb(&Aabb::new(one.min(other), one.max(other))).collect()
}

/// Returns true if the winding of a triangle tells the front of a sheet. It does not if a double is
/// wound the other way, or if two triangles near it are wound against each other.
pub(super) fn has_front(mesh: &TriMesh, triangle: u32) -> bool {
    let half_edges = |of: u32| {
        let [a, b, c] = mesh.triangle(of).vertices().map(place);
        [[a, b, c], [b, c, a], [c, a, b]]
    };
    let [own, ..] = half_edges(triangle);
    let bounds = mesh.triangle(triangle).local_aabb();
    let mut edges = ArrayVec::<_, { 3 * MOST_NEAR }>::new();
    for theirs in mesh.bvh().intersect_aabb(&bounds).take(MOST_NEAR).map(half_edges) {
        if theirs.iter().any(|&[a, b, c]| own == [b, a, c]) {
            return false;
        }
        edges.extend(theirs.map(|[a, b, c]| ([a.min(b), a.max(b)], a < b, c)));
    }
    edges.sort_unstable();
    // More than two triangles at an edge, besides doubles, cannot all run against each other.
    let is_turned = |of: &[([Place; 2], bool, Place)]| {
        let [one, .., two] = of else { return false };
        one != two && one.1 == two.1 && of.iter().all(|edge| edge == one || edge == two)
    };
    !edges.chunk_by(|one, other| one.0 == other.0).any(is_turned)
}

/// Returns the twins of the edges of a triangle, and whether it is a double. Vertices at one place
/// are one vertex, and doubles have no neighbours, as in [`Surface`](sbbk_core::surface::Surface).
fn twins(mesh: &TriMesh, triangle: u32) -> ([Option<u32>; 3], bool) {
    let corners = |triangle: u32| *mesh.triangle(triangle).vertices();
    let own = corners(triangle);
    let mut is_double = sliver(mesh, triangle).is_some();
    let twins = [0, 1, 2].map(|i| {
        let ends @ [a, b] = [own[i], own[(i + 1) % 3]];
        let mut near = near_edge(mesh, ends);
        near.retain(|&other| ends.iter().all(|end| corners(other).contains(end)));
        near.sort_unstable();
        let mut known = FxHashSet::default();
        near.retain(|&other| {
            sliver(mesh, other) != Some(true) && known.insert(places(corners(other)))
        });
        let is_first = near.contains(&triangle);
        is_double |= !is_first;
        let half_edges = near.iter().flat_map(|other| 3 * other..3 * other + 3);
        let ends_of = |half_edge: u32| {
            let (of, j) = (corners(half_edge / 3), half_edge as usize % 3);
            [of[j], of[(j + 1) % 3]]
        };
        let forward = half_edges.clone().filter(|&other| ends_of(other) == ends).count();
        let mut backward = half_edges.filter(|&other| ends_of(other) == [b, a]);
        let twin = backward.next();
        twin.filter(|_| a != b && is_first && forward == 1 && backward.next().is_none())
    });
    (twins, is_double)
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

/// Neighbours of triangles, found where something touches the mesh. Threads share them, and take no
/// lock.
#[derive(Debug)]
pub(crate) struct Neighbours {
    chunks: Box<[OnceLock<Box<Chunk>>]>,
    chunk_count: AtomicUsize,
}

/// Triangles whose memory is reserved at once. Higher: more memory where few triangles are touched.
/// Lower: a larger table.
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
