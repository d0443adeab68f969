//! Which half-edges run back along each other.

use glamx::Vec3;
use rustc_hash::FxHashMap;

use crate::collections::Numbers;

const NONE: u32 = u32::MAX;

/// The twin of each half-edge, if there is exactly one, and the half-edges that no other makes up
/// for, by their welded ends: borders, and edges along which triangles disagree about the outside.
pub(super) fn find(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Numbers, Vec<[u32; 2]>) {
    let welded = weld(vertices);
    // Each edge is listed with its lesser end. A mesh has one and a half edges a triangle.
    let mut first = vec![NONE; vertices.len()];
    let mut edges = Vec::<Edge>::with_capacity(triangles.len() * 3 / 2 + 16);
    for (triangle, corners) in (0..).zip(triangles) {
        let [a, b, c] = corners.map(|corner| welded[corner as usize]);
        for (i, [start, end]) in (0..).zip([[a, b], [b, c], [c, a]]) {
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
    let (mut twins, mut uneven) = (vec![None; 3 * triangles.len()], Vec::new());
    for Edge { low, high, last: [up, down], counts, .. } in edges {
        match counts {
            [1, 1] => {
                twins[up as usize] = Some(down);
                twins[down as usize] = Some(up);
            }
            [ups, downs] => {
                let ends = if ups > downs { [low, high] } else { [high, low] };
                uneven.extend(std::iter::repeat_n(ends, ups.abs_diff(downs) as usize));
            }
        }
    }
    (Numbers::new(twins.into_iter()), uneven)
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
