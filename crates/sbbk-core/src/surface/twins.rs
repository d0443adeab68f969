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

/// The twin of each half-edge, [`NONE`] where there is not exactly one, and the half-edges that no
/// other makes up for, by their welded ends: borders, and edges along which triangles disagree about
/// the outside.
pub(super) fn find(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<[u32; 2]>) {
    let welded = weld(vertices);
    // Each edge is listed with its lesser end. A mesh has one and a half edges a triangle.
    let mut first = vec![NONE; vertices.len()];
    let mut edges = Vec::<Edge>::with_capacity(triangles.len() * 3 / 2 + 16);
    for (triangle, corners) in (0..).zip(triangles) {
        let [a, b, c] = corners.map(|corner| welded[corner as usize]);
        for (i, [start, end]) in (0..).zip([[a, b], [b, c], [c, a]]) {
            if start == end {
                continue;
            }
            let way = usize::from(start > end);
            let (low, high) = if way == 0 { (start, end) } else { (end, start) };
            let head = &mut first[low as usize];
            let mut at = *head;
            while at != NONE && edges[at as usize].high != high {
                at = edges[at as usize].next;
            }
            if at == NONE {
                at = edges.len() as u32;
                edges.push(Edge { low, high, next: *head, last: [NONE; 2], counts: [0; 2] });
                *head = at;
            }
            let edge = &mut edges[at as usize];
            edge.last[way] = 3 * triangle + i;
            edge.counts[way] += 1;
        }
    }
    let (mut twins, mut uneven) = (vec![NONE; 3 * triangles.len()], Vec::new());
    for Edge { low, high, last: [up, down], counts, .. } in edges {
        match counts {
            [1, 1] => {
                twins[up as usize] = down;
                twins[down as usize] = up;
            }
            [ups, downs] => {
                let ends = if ups > downs { [low, high] } else { [high, low] };
                uneven.extend(std::iter::repeat_n(ends, ups.abs_diff(downs) as usize));
            }
        }
    }
    (twins, uneven)
}

/// All half-edges between two vertices.
struct Edge {
    low: u32,
    high: u32,
    /// Another edge with the same lesser end.
    next: u32,
    /// The last half-edge up and down, and how many there are.
    last: [u32; 2],
    counts: [u32; 2],
}

/// For each vertex the first one at its place.
fn weld(vertices: &[Vec3]) -> Vec<u32> {
    let mut places = FxHashMap::default();
    places.reserve(vertices.len());
    // Minus zero is zero.
    let place = |vertex: &Vec3| (*vertex + Vec3::ZERO).to_array().map(f32::to_bits);
    (0..).zip(vertices).map(|(i, vertex)| *places.entry(place(vertex)).or_insert(i)).collect()
}
