//! Which half-edges run back along each other.

use glamx::Vec3;
use rustc_hash::FxHashMap;

const NONE: u32 = u32::MAX;

/// The twins of all half-edges, in sixteen bits where these are enough.
#[derive(Clone, Debug)]
pub(super) enum List {
    Narrow(Box<[u16]>),
    Wide(Box<[u32]>),
}

impl List {
    pub(super) fn of(twins: Vec<u32>) -> Self {
        if twins.len() < usize::from(u16::MAX) {
            // What is cut off of `NONE` leaves the largest number.
            Self::Narrow(twins.into_iter().map(|twin| twin as u16).collect())
        } else {
            Self::Wide(twins.into())
        }
    }

    #[inline(always)]
    pub(super) fn get(&self, half_edge: u32) -> Option<u32> {
        let twin = match self {
            Self::Narrow(twins) => {
                let twin = twins[half_edge as usize];
                if twin == u16::MAX { NONE } else { twin.into() }
            }
            Self::Wide(twins) => twins[half_edge as usize],
        };
        (twin != NONE).then_some(twin)
    }

    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Narrow(twins) => size_of_val(&**twins),
            Self::Wide(twins) => size_of_val(&**twins),
        }
    }
}

/// The twin of each half-edge, [`NONE`] where there is not exactly one, and the half-edges that no other makes up for, by their welded ends:
/// borders, and edges along which triangles disagree about the outside.
pub(super) fn find(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<[u32; 2]>) {
    let edges = Edges::new(vertices, triangles);
    let mut uneven = Vec::new();
    let twins = (0..3 * triangles.len()).map(|half_edge| {
        let [start, end] = edges.ends(half_edge);
        let mut back = edges.along([end, start]);
        let twin = back.next();
        let backward = back.count() + usize::from(twin.is_some());
        let forward = edges.along([start, end]).count();
        let is_first = edges.along([start, end]).next() == Some(half_edge as u32);
        if is_first && forward > backward {
            uneven.extend(std::iter::repeat_n([start, end], forward - backward));
        }
        twin.filter(|_| forward == 1 && backward == 1).unwrap_or(NONE)
    });
    (twins.collect(), uneven)
}

/// The half-edges of a mesh, by the vertices that they start at.
struct Edges<'a> {
    triangles: &'a [[u32; 3]],
    /// For each vertex the first one at its place.
    welded: Vec<u32>,
    /// For each vertex one of its half-edges, and for each half-edge another one of its start.
    first: Vec<u32>,
    next: Vec<u32>,
}

impl<'a> Edges<'a> {
    fn new(vertices: &[Vec3], triangles: &'a [[u32; 3]]) -> Self {
        let (first, next) = (vec![NONE; vertices.len()], vec![NONE; 3 * triangles.len()]);
        let mut edges = Self { triangles, welded: weld(vertices), first, next };
        for half_edge in 0..edges.next.len() {
            let [start, end] = edges.ends(half_edge);
            if start != end {
                let first = &mut edges.first[start as usize];
                edges.next[half_edge] = std::mem::replace(first, half_edge as u32);
            }
        }
        edges
    }

    /// Where a half-edge starts and ends.
    fn ends(&self, half_edge: usize) -> [u32; 2] {
        let triangle = self.triangles[half_edge / 3];
        [half_edge % 3, (half_edge + 1) % 3].map(|i| self.welded[triangle[i] as usize])
    }

    /// The half-edges with these ends.
    fn along(&self, ends: [u32; 2]) -> impl Iterator<Item = u32> {
        let is_one = |&half_edge: &u32| half_edge != NONE;
        let first = Some(self.first[ends[0] as usize]).filter(is_one);
        let next = move |&half_edge: &u32| Some(self.next[half_edge as usize]).filter(is_one);
        let from_start = std::iter::successors(first, next);
        from_start.filter(move |&half_edge| self.ends(half_edge as usize) == ends)
    }
}

/// For each vertex the first one at its place.
fn weld(vertices: &[Vec3]) -> Vec<u32> {
    let mut places = FxHashMap::default();
    places.reserve(vertices.len());
    // Minus zero is zero.
    let place = |vertex: &Vec3| (*vertex + Vec3::ZERO).to_array().map(f32::to_bits);
    (0..).zip(vertices).map(|(i, vertex)| *places.entry(place(vertex)).or_insert(i)).collect()
}
