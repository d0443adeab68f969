//! Pairs of half-edges that run back along each other.

use std::hash::BuildHasher;

use glamx::Vec3;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};

use super::triangle::area_vector;
use super::{PAIRED, SMALL_COMPONENT};
use crate::collections::CompactIndices;

const NONE: u32 = u32::MAX;

/// Triangles at a vertex beyond which the vertex is a hub. If the first is a face, all count as
/// faces. Higher: fans take longer. Lower: parts within others have contacts.
const HUB: u32 = 1024;

/// Adjacency of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Adjacency {
    /// The twin of each half-edge, if there is exactly one besides doubles. Doubles have none.
    pub(super) twins: CompactIndices,
    /// Number of triangles and first triangle at each hub, by vertex.
    pub(super) hubs: FxHashMap<Place, (u32, u32)>,
    /// True if the two half-edges of an edge run the same way.
    pub(super) is_turned: bool,
    /// True if closed components have few triangles on average.
    pub(super) has_small_components: bool,
    /// `None` above [`PAIRED`] triangles, where no component is known to be closed.
    pub(super) components: Option<Components>,
    /// Triangles with the corners of an earlier one, in either winding, and slivers.
    pub(super) doubles: TriangleSet,
}

/// Tells which components of a mesh are closed. Triangles that share an edge are of one component.
#[derive(Clone, Debug)]
pub(super) struct Components {
    /// The triangles of components with a [border](Edge::is_border).
    pub(super) open: TriangleSet,
    /// True if each edge has one half-edge each way.
    pub(super) is_manifold: bool,
}

impl Components {
    /// The components of `count` triangles.
    fn new(edges: &Edges, count: usize) -> Self {
        let is_manifold = edges.all.iter().all(|edge| edge.counts == [1, 1]);
        Self { open: open_parts(edges, count), is_manifold }
    }

    /// True if all components are closed.
    pub(super) fn are_closed(&self) -> bool {
        self.open.is_empty()
    }
}

/// A set of triangles. Takes no memory if it is empty.
#[derive(Clone, Debug, Default)]
pub(super) struct TriangleSet(Box<[u64]>);

impl TriangleSet {
    /// Adds one of `count` triangles. Returns false if it was there.
    fn insert(&mut self, triangle: u32, count: usize) -> bool {
        if self.is_empty() {
            self.0 = vec![0; count.div_ceil(64)].into();
        }
        let (word, bit) = (&mut self.0[triangle as usize / 64], 1 << (triangle % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn contains(&self, triangle: u32) -> bool {
        let word = self.0.get(triangle as usize / 64);
        word.is_some_and(|word| word >> (triangle % 64) & 1 == 1)
    }

    /// Memory in bytes, without this value.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.0)
    }
}

/// Returns the triangles of components with a border, among `count` triangles.
fn open_parts(Edges { all, around, .. }: &Edges, count: usize) -> TriangleSet {
    let mut open = TriangleSet::default();
    let at_borders = all.iter().filter(|edge| edge.is_border()).flat_map(|edge| edge.last);
    let mut reached: Vec<u32> = at_borders.filter(|&half_edge| half_edge != NONE).collect();
    while let Some(half_edge) = reached.pop() {
        let triangle = half_edge / 3;
        if open.insert(triangle, count) {
            reached.extend(&around[3 * triangle as usize..][..3]);
        }
    }
    open
}

/// Returns the triangles that have the corners of an earlier one.
///
/// All twins of such a triangle are in one triangle, as other edges have several half-edges one
/// way.
fn doubles(welded: &[u32], triangles: &[[u32; 3]], twins: &[Option<u32>]) -> TriangleSet {
    let may_be_double = |triangle: usize| {
        let mut neighbours = twins[3 * triangle..][..3].iter().flatten().map(|twin| twin / 3);
        let first = neighbours.next();
        neighbours.all(|other| Some(other) == first)
    };
    let (mut known, mut doubles) = (FxHashSet::default(), TriangleSet::default());
    for triangle in (0..triangles.len()).filter(|&triangle| may_be_double(triangle)) {
        let mut corners = triangles[triangle].map(|corner| welded[corner as usize]);
        corners.sort_unstable();
        if !known.insert(corners) {
            doubles.insert(triangle as u32, triangles.len());
        }
    }
    doubles
}

/// Triangles without an area. Each is a point, or has an edge of a triangle that has one.
#[derive(Default)]
struct Slivers {
    all: Vec<u32>,
    /// Slivers that fill no gap between three others. Edges have their twins without them.
    hanging: FxHashSet<u32>,
}

impl Slivers {
    /// Finds the slivers of a mesh with these edges.
    fn find(vertices: &[Vec3], welded: &[u32], triangles: &[[u32; 3]], edges: &[Edge]) -> Self {
        let corners = |triangle: u32| triangles[triangle as usize].map(|i| vertices[i as usize]);
        let flat = (0..triangles.len() as u32).filter(|&triangle| is_flat(&corners(triangle)));
        let flat: Vec<u32> = flat.collect();
        let mut slivers = Self::default();
        if flat.is_empty() {
            return slivers;
        }
        let sides = |triangle: u32| {
            sides(triangles[triangle as usize].map(|corner| welded[corner as usize]))
        };
        // Half-edges of each side: of triangles without an area, and of all.
        let mut counts = FxHashMap::<[u32; 2], [u32; 2]>::default();
        for side in flat.iter().flat_map(|&triangle| sides(triangle)) {
            counts.entry(side).or_default()[0] += 1;
        }
        for Edge { ends, counts: [up, down], .. } in edges {
            counts.entry(*ends).and_modify(|known| known[1] = up + down);
        }
        for triangle in flat {
            let sides = sides(triangle).map(|ends| (ends, counts[&ends]));
            if let Some(hangs) = hangs(&sides) {
                slivers.all.push(triangle);
                slivers.hanging.extend(hangs.then_some(triangle));
            }
        }
        slivers
    }
}

/// Returns the ends of the sides of a triangle, the lesser end first.
pub fn sides<End: Copy + Ord>([a, b, c]: [End; 3]) -> [[End; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// Returns whether a triangle without an area hangs: it does not fill a gap between three others.
/// `None` if it is a segment that shares no side with a triangle that has an area. `sides` have
/// their ends, and the half-edges of triangles without an area and of all.
pub fn hangs<End: PartialEq>(sides: &[([End; 2], [u32; 2]); 3]) -> Option<bool> {
    let is_of_face = |([a, b], [flat, all]): &([End; 2], [u32; 2])| a != b && all > flat;
    let is_filled = |([a, b], [_, all]): &([End; 2], [u32; 2])| a != b && *all == 2;
    let is_point = sides.iter().all(|([a, b], _)| a == b);
    (is_point || sides.iter().any(is_of_face)).then(|| !sides.iter().all(is_filled))
}

/// Roundings of a corner that lies on a side. Higher: low triangles have no contacts. Lower:
/// rounding decides where slivers have contacts.
const ROUNDINGS: f64 = 4.0 * f32::EPSILON as f64;

/// Returns true if a triangle has no area, up to rounding of its corners.
pub fn is_flat(corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let sides = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
    let longest2 = sides.into_iter().fold(0.0, f64::max);
    let slack = ROUNDINGS * a.abs().max(b.abs()).max(c.abs()).max_element();
    area_vector(&[a, b, c]).length_squared() <= slack * slack * longest2
}

/// A place where vertices are one.
pub type Place = [u32; 3];

/// Returns the place of a vertex.
pub fn place(vertex: Vec3) -> Place {
    // Minus zero is zero.
    (vertex + Vec3::ZERO).to_array().map(f32::to_bits)
}

pub(super) fn find(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Adjacency {
    let welded = weld(vertices);
    let valence = valence(&welded, triangles);
    let numbered = (0..).zip(triangles.iter().copied());
    let edges_of = |of: &dyn Fn(u32) -> bool| {
        edges(&welded, &valence, numbered.clone().filter(|(triangle, _)| of(*triangle))).0
    };
    let mut edges = edges_of(&|_| true);
    let slivers = Slivers::find(vertices, &welded, triangles, &edges.all);
    let hangs = |triangle: u32| slivers.hanging.contains(&triangle);
    if !slivers.hanging.is_empty() {
        edges = edges_of(&|triangle| !hangs(triangle));
    }
    // A closed component without handles has two more vertices and triangles than edges.
    let vertex_count = valence.iter().filter(|&&count| count > 0).count();
    let parts = (vertex_count + triangles.len()).saturating_sub(edges.all.len()) / 2;
    let has_small_components = parts > 1 && parts * SMALL_COMPONENT >= triangles.len();
    let mut twins = paired(&edges.all, triangles.len());
    let hubs = hubs(vertices, &welded, &valence, triangles);
    let count = triangles.len();
    let is_turned = edges.all.iter().any(|edge| matches!(edge.counts, [2, 0] | [0, 2]));
    let components = (count <= PAIRED).then(|| Components::new(&edges, count));
    let mut doubles = doubles(&welded, triangles, &twins);
    if !doubles.is_empty() {
        let single = edges_of(&|triangle| !doubles.contains(triangle) && !hangs(triangle));
        twins = paired(&single.all, triangles.len());
    }
    slivers.all.iter().for_each(|&triangle| _ = doubles.insert(triangle, count));
    let twins = CompactIndices::new(twins.into_iter());
    Adjacency { twins, hubs, is_turned, has_small_components, components, doubles }
}

/// Returns the twin of each half-edge of `count` triangles.
fn paired(edges: &[Edge], count: usize) -> Vec<Option<u32>> {
    let mut twins = vec![None; 3 * count];
    for &Edge { last: [up, down], .. } in edges.iter().filter(|edge| edge.counts == [1, 1]) {
        twins[up as usize] = Some(down);
        twins[down as usize] = Some(up);
    }
    twins
}

/// Number of triangles at each vertex.
fn valence(welded: &[u32], triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut valence = vec![0; welded.len()];
    for &corner in triangles.as_flattened() {
        valence[welded[corner as usize] as usize] += 1;
    }
    valence
}

fn hubs(
    vertices: &[Vec3],
    welded: &[u32],
    valence: &[u32],
    triangles: &[[u32; 3]],
) -> FxHashMap<Place, (u32, u32)> {
    let mut hubs = FxHashMap::default();
    if valence.iter().all(|&count| count <= HUB) {
        return hubs;
    }
    for (triangle, corners) in (0..).zip(triangles) {
        for vertex in corners.map(|corner| welded[corner as usize] as usize) {
            if valence[vertex] > HUB {
                hubs.entry(place(vertices[vertex])).or_insert((valence[vertex], triangle));
            }
        }
    }
    hubs
}

/// All half-edges between two vertices.
struct Edge {
    /// The lesser vertex, and the other one.
    ends: [u32; 2],
    /// The next edge of the same list.
    next: u32,
    /// The last half-edge up and down, and the number of either.
    last: [u32; 2],
    counts: [u32; 2],
}

impl Edge {
    /// True if more half-edges run one way than back. A component without a border has a whole
    /// winding number at each point.
    fn is_border(&self) -> bool {
        self.counts[0] != self.counts[1]
    }
}

/// The edges of a mesh.
struct Edges {
    /// In the order of their first half-edges.
    all: Vec<Edge>,
    /// For each half-edge the next one of the same edge. The last leads to the first.
    around: Vec<u32>,
}

/// Finds all edges. Also returns the number of list steps.
///
/// Each edge is listed at that end which fewer triangles share. An edge of a planar
/// graph then takes a constant number of list steps at any valence.
fn edges(
    welded: &[u32],
    valence: &[u32],
    triangles: impl Iterator<Item = (u32, [u32; 3])>,
) -> (Edges, usize) {
    let mut first = vec![NONE; welded.len()];
    // A closed mesh has one and a half edges a triangle.
    let mut all = Vec::<Edge>::with_capacity(triangles.size_hint().0 * 3 / 2 + 16);
    let mut around = Vec::<u32>::with_capacity(triangles.size_hint().0 * 3);
    let mut steps = 0;
    for (triangle, corners) in triangles {
        let [a, b, c] = corners.map(|corner| welded[corner as usize]);
        around.extend(around.len() as u32..3 * triangle + 3);
        for (half_edge, [start, end]) in (3 * triangle..).zip([[a, b], [b, c], [c, a]]) {
            let way = usize::from(start > end);
            let ends = if way == 0 { [start, end] } else { [end, start] };
            let [low, high] = ends.map(|end| end as usize);
            let head = &mut first[if valence[low] <= valence[high] { low } else { high }];
            let mut at = *head;
            while at != NONE && all[at as usize].ends != ends {
                at = all[at as usize].next;
                steps += 1;
            }
            if at == NONE {
                at = all.len() as u32;
                all.push(Edge { ends, next: *head, last: [NONE; 2], counts: [0; 2] });
                *head = at;
            }
            let edge = &mut all[at as usize];
            if let Some(other) = edge.last.into_iter().find(|&other| other != NONE) {
                around.swap(half_edge as usize, other as usize);
            }
            edge.last[way] = half_edge;
            edge.counts[way] += 1;
        }
    }
    (Edges { all, around }, steps)
}

/// For each vertex the first one at its place.
///
/// Sorts the vertices by a hash of their places. A map from places would miss the cache at each
/// vertex.
fn weld(vertices: &[Vec3]) -> Vec<u32> {
    let hash = |vertex: Vec3| FxBuildHasher.hash_one(place(vertex)) & !u64::from(u32::MAX);
    let mut by_hash: Vec<u64> = (0..).zip(vertices).map(|(i, &v)| hash(v) | i).collect();
    by_hash.sort_unstable();
    let mut welded = vec![0; vertices.len()];
    let mut firsts = Vec::new();
    for of_one_hash in by_hash.chunk_by(|a, b| a >> 32 == b >> 32) {
        firsts.clear();
        for vertex in of_one_hash.iter().map(|&key| key as u32) {
            let here = place(vertices[vertex as usize]);
            let known = firsts.iter().find(|(place, _)| *place == here);
            welded[vertex as usize] = known.map_or(vertex, |&(_, first)| first);
            if known.is_none() {
                firsts.push((here, vertex));
            }
        }
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;

    /// List steps for a fan of triangles around a hub.
    fn steps(count: u32, hub_is_first: bool) -> usize {
        let hub = if hub_is_first { 0 } else { count + 1 };
        let rim = |i: u32| i + u32::from(hub_is_first);
        let triangles: Vec<_> = (0..count).map(|i| [hub, rim(i), rim(i + 1)]).collect();
        let welded: Vec<u32> = (0..count + 2).collect();
        edges(&welded, &valence(&welded, &triangles), (0..).zip(triangles)).1
    }

    /// Would catch vertices that are joined though they differ, or that are not joined to the first
    /// one.
    #[test]
    fn vertices_at_one_place_are_the_first_of_them() {
        let at = |i: u32| Vec3::new((i * 7 % 50) as f32 - 25.0, (i % 3) as f32, -0.0);
        let mut vertices: Vec<Vec3> = (0..1000).map(at).collect();
        vertices.extend([Vec3::new(-25.0, 0.0, 0.0), Vec3::NAN, Vec3::NAN]);
        let first = |here: &Vec3| vertices.iter().position(|v| place(*v) == place(*here)).unwrap();
        let expected: Vec<u32> = vertices.iter().map(|v| first(v) as u32).collect();
        assert_eq!(weld(&vertices), expected);
    }

    #[test]
    fn steps_of_a_fan_grow_with_its_triangles() {
        for hub_is_first in [true, false] {
            let [few, many] = [250, 4000].map(|count| steps(count, hub_is_first));
            assert!(many <= 17 * few && many < 3 * 4000, "{few} {many}");
        }
    }
}
