//! The closest of the nine pairs of edges.
//!
//! With `w` from start to start, the closest points of two lines lie at
//!
//! ```text
//! along1 = (w x e2) . n / n . n,    n = e1 x e2
//! along2 = (along1 e1 - w) . e2 / e2 . e2
//! ```
//!
//! `along1` is clamped to the edge first, then `along2`. If that changed `along2`, or the edges are
//! parallel, `along1` is the foot of that point (C. Ericson, "Real-Time Collision Detection", 2005,
//! section 5.1.9). Ericson computes `along1` from scalar products only, which loses twice as many
//! digits for near parallel edges.
//!
//! A walk finds the closest of the nine pairs. It starts at the edges that face each other and
//! tests each third vertex against the plane through the closest point. If both lie behind, no
//! other pair is closer (duality, see `closest.rs`). Otherwise the walk moves to the edge between
//! the third vertex and the nearer end. On average 1.3 pairs are tried, all nine at most.

use super::closest::{Closest, TIE, closest, within_edge};
use super::feature::{Feature, FeaturePair};
use super::triangle::{NEXT, PREVIOUS, Triangle};
use glamx::DVec3;

/// Least distance, in triangle sizes, whose direction tells on which side a vertex lies. The
/// direction is off by 1e-16 over this, and so is the proof. Higher: close triangles take the
/// whole walk. Lower: distances are off by more.
const CLEAR: f64 = 1.0e-6;

/// The closest points of one edge of each triangle.
#[derive(Clone, Copy)]
struct EdgePair {
    edges: [usize; 2],
    along: [f64; 2],
    difference: DVec3,
    distance_squared: f64,
}

/// The closest features over all edge pairs and their contact. No more than an upper bound when
/// the triangles cross or a vertex is closest to a face.
pub(super) fn closest_edges(t1: &Triangle, t2: &Triangle) -> (FeaturePair, Closest) {
    let mut pair = EdgePair::facing(t1, t2);
    let mut best = pair;
    let mut tried = 0_u32;
    loop {
        let leaves = pair.leaves(t1, t2);
        if leaves == [false; 2] {
            return pair.contact(t1, t2);
        }
        let bit = |[i, j]: [usize; 2]| 1 << (3 * i + j);
        tried |= bit(pair.edges);
        if tried.count_ones() == 9 {
            return best.contact(t1, t2);
        }
        let mut next = pair.next(leaves);
        if tried & bit(next) != 0 {
            let first = tried.trailing_ones() as usize;
            next = [first / 3, first % 3];
        }
        pair = EdgePair::new(t1, t2, next);
        if pair.distance_squared < best.distance_squared {
            best = pair;
        }
    }
}

/// The closest features, if the first or second edge pair of the walk has them, with the proof
/// that no others are closer. Gives up at once where both third vertices lie in front, as they
/// mostly do when triangles cross.
#[inline(always)]
pub(super) fn proved_edges(t1: &Triangle, t2: &Triangle) -> Option<(FeaturePair, Closest)> {
    let mut pair = EdgePair::facing(t1, t2);
    let leaves = pair.leaves(t1, t2);
    if leaves == [true; 2] {
        return None;
    }
    if leaves != [false; 2] {
        pair = EdgePair::new(t1, t2, pair.next(leaves));
        if pair.leaves(t1, t2) != [false; 2] {
            return None;
        }
    }
    Some(pair.contact(t1, t2))
}

impl EdgePair {
    /// The edges opposite to the vertices that lie farthest from the other triangle.
    #[inline(always)]
    fn facing(t1: &Triangle, t2: &Triangle) -> Self {
        let [a1, b1, c1] = *t1.vertices;
        let [a2, b2, c2] = *t2.vertices;
        let between = (a2 - a1) + (b2 - b1) + (c2 - c1);
        Self::new(t1, t2, [NEXT[lowest(t1, between)], NEXT[lowest(t2, -between)]])
    }

    #[inline(always)]
    fn new(t1: &Triangle, t2: &Triangle, [i, j]: [usize; 2]) -> Self {
        let (e1, e2) = (t1.edges[i], t2.edges[j]);
        let between = t2.vertices[j] - t1.vertices[i];
        let normal = e1.cross(e2);
        let area = normal.length_squared();
        let on_lines = within_edge(between.cross(e2).dot(normal) / area);
        let product = e1.dot(e2);
        let rest2 = on_lines * product - between.dot(e2);
        let length2 = e2.length_squared();
        let s2 = within_edge(rest2 / length2);
        let settled = area > 0.0 && rest2 >= 0.0 && rest2 <= length2;
        let s1 = if settled {
            on_lines
        } else {
            within_edge((between.dot(e1) + s2 * product) / e1.length_squared())
        };
        let difference = between + e2 * s2 - e1 * s1;
        let distance_squared = difference.length_squared();
        Self { edges: [i, j], along: [s1, s2], difference, distance_squared }
    }

    /// True for each triangle whose third vertex lies in front of the plane through its closest
    /// point, or close to that plane. Then points off the edge may be closer.
    #[inline(always)]
    fn leaves(&self, t1: &Triangle, t2: &Triangle) -> [bool; 2] {
        let ([i, j], [s1, s2]) = (self.edges, self.along);
        let distance = self.distance_squared.sqrt();
        if distance <= CLEAR * (t1.size + t2.size) {
            return [true; 2];
        }
        let slack = TIE * distance;
        let third1 = t1.opposite(i) - t1.edges[i] * s1;
        let third2 = t2.opposite(j) - t2.edges[j] * s2;
        let (ahead1, ahead2) = (third1.dot(self.difference), third2.dot(self.difference));
        [ahead1 > slack * t1.size, -ahead2 > slack * t2.size]
    }

    /// The pair to try next: of each triangle that leaves, the edge between its third vertex and
    /// the nearer end of this one.
    #[inline(always)]
    fn next(&self, leaves: [bool; 2]) -> [usize; 2] {
        let next = |k: usize| match (leaves[k], self.along[k] < 0.5) {
            (false, _) => self.edges[k],
            (true, true) => PREVIOUS[self.edges[k]],
            (true, false) => NEXT[self.edges[k]],
        };
        [next(0), next(1)]
    }

    /// The contact of the features where the closest points lie.
    #[inline(always)]
    fn contact(&self, t1: &Triangle, t2: &Triangle) -> (FeaturePair, Closest) {
        let ([i, j], [s1, s2]) = (self.edges, self.along);
        let features = FeaturePair::new(feature_at(i, s1), feature_at(j, s2));
        let closest = closest(t1, t2, features).unwrap_or_else(|| {
            let point1 = t1.vertices[i] + t1.edges[i] * s1;
            let point2 = t2.vertices[j] + t2.edges[j] * s2;
            Closest::between(point1, point2, self.difference)
        });
        (features, closest)
    }
}

/// The vertex that lies least far along a direction.
#[inline(always)]
fn lowest(t: &Triangle, direction: DVec3) -> usize {
    let ahead = t.edges[0].dot(direction);
    let behind = -t.edges[2].dot(direction);
    if ahead < 0.0 && ahead < behind {
        1
    } else if behind < 0.0 {
        2
    } else {
        0
    }
}

fn feature_at(edge: usize, along: f64) -> Feature {
    if along <= 0.0 {
        Feature::Vertex(edge as u8)
    } else if along >= 1.0 {
        Feature::Vertex(NEXT[edge] as u8)
    } else {
        Feature::Edge(edge as u8)
    }
}
