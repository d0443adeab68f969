//! Signs of the vertices of each triangle against the edges of the other, on a plane of view.
//!
//! Nine signs tell on which side of each edge of one shadow each vertex of the other lies, and nine
//! more the reverse. The two sets take the two SIMD lanes: lane 0 has the vertices of triangle 1
//! and the edges of triangle 2, lane 1 the reverse. The signs are bits, bit `6 edge + 2 vertex +
//! lane`, so that a few operations on words answer each question.

use super::closest::TIE;
use super::triangle::{NEXT, Triangle};
use glamx::DVec3;
use wide::f64x2;

pub(super) struct ShadowSigns {
    /// By edge and vertex: twice the area between them.
    area: [[f64x2; 3]; 3],
    /// Vertices left of edges; those in neither mask are on the edge, as far as rounding can tell.
    left: u32,
    right: u32,
}

impl ShadowSigns {
    #[inline(always)]
    pub fn new(t1: &Triangle, t2: &Triangle, normal: DVec3) -> Self {
        let (x, y) = normal.any_orthonormal_pair();
        let (own_x, own_y) = (shadows(t1, t2, x), shadows(t1, t2, y));
        let (other_x, other_y) = (own_x.map(swapped), own_y.map(swapped));
        let slack = f64x2::new([t2.size, t1.size]) * f64x2::splat(TIE * (t1.size + t2.size));
        let mut sides = Self { area: [[f64x2::ZERO; 3]; 3], left: 0, right: 0 };
        for e in 0..3 {
            let edge_x = other_x[NEXT[e]] - other_x[e];
            let edge_y = other_y[NEXT[e]] - other_y[e];
            for v in 0..3 {
                let area = edge_x * (own_y[v] - other_y[e]) - edge_y * (own_x[v] - other_x[e]);
                sides.area[e][v] = area;
                sides.left |= area.simd_gt(slack).to_bitmask() << (6 * e + 2 * v);
                sides.right |= area.simd_lt(-slack).to_bitmask() << (6 * e + 2 * v);
            }
        }
        sides
    }

    /// For each triangle, the vertices inside the other one or on its border. A vertex on all three
    /// lines does not count: the other shadow has no width.
    #[inline(always)]
    pub fn inside(&self) -> [u32; 2] {
        let any = |sides: u32| sides | sides >> 6 | sides >> 12;
        let inside = any(self.left) ^ any(self.right);
        let vertices =
            |k: u32| (inside >> k & 1) | (inside >> k & 4) >> 1 | (inside >> k & 16) >> 2;
        [vertices(0), vertices(1)]
    }

    /// Bit `6 j + 2 i` for each edge `i` of triangle 1 that crosses edge `j` of triangle 2. Edge
    /// `i` runs from vertex `i` to the next.
    #[inline(always)]
    pub fn crossings(&self) -> u32 {
        const LAST: u32 = 0b110000 * 0b1_000001_000001;
        let ends = |sides: u32| (sides >> 2 & !LAST) | (sides << 4 & LAST);
        // Edges with their ends on either side of the line through an edge.
        let split = (self.left & ends(self.right)) | (self.right & ends(self.left));
        split & transposed(split >> 1) & LANE_0
    }

    /// Computes one crossing.
    #[inline(always)]
    pub fn crossing(&self, bit: usize) -> EdgeCrossing {
        let (i, j) = (bit % 6 / 2, bit / 6);
        let area =
            |edge: usize, vertex: usize, lane: usize| self.area[edge][vertex].as_array()[lane];
        let (start1, end1) = (area(j, i, 0), area(j, NEXT[i], 0));
        let (start2, end2) = (area(i, j, 1), area(i, NEXT[j], 1));
        let along = [start1 / (start1 - end1), start2 / (start2 - end2)];
        EdgeCrossing { edges: [i, j], along, area: (start1 - end1).abs() }
    }
}

/// The crossing of the shadows of two edges.
pub(super) struct EdgeCrossing {
    pub edges: [usize; 2],
    /// From 0 to 1 on each edge.
    pub along: [f64; 2],
    /// Area of the parallelogram of both shadows; small if they are near parallel.
    pub area: f64,
}

const LANE_0: u32 = 0b010101 * 0b1_000001_000001;

/// Swaps the roles of edges and vertices: bit `6 e + 2 v` goes to `6 v + 2 e`.
#[inline(always)]
fn transposed(bits: u32) -> u32 {
    const EQUAL: u32 = 1 | 1 << 8 | 1 << 16;
    // Above the diagonal the index of the edge is one or two less than the index of the vertex.
    const ABOVE_1: u32 = 1 << 2 | 1 << 10;
    const ABOVE_2: u32 = 1 << 4;
    bits & EQUAL
        | (bits & ABOVE_1) << 4
        | (bits & ABOVE_2) << 8
        | (bits >> 4) & ABOVE_1
        | (bits >> 8) & ABOVE_2
}

/// Positions of the vertices of triangles 1 and 2 along an axis.
#[inline(always)]
fn shadows(t1: &Triangle, t2: &Triangle, axis: DVec3) -> [f64x2; 3] {
    let origin = t1.vertices[0];
    let ([a, b, c], [d, e, f]) = (t1.heights(origin, axis), t2.heights(origin, axis));
    [f64x2::new([a, d]), f64x2::new([b, e]), f64x2::new([c, f])]
}

#[inline(always)]
fn swapped(lanes: f64x2) -> f64x2 {
    let [a, b] = lanes.to_array();
    f64x2::new([b, a])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::clip::MANIFOLD_CAPACITY;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Rounding may give signs that no triangles have.
        #[test]
        fn words_of_any_signs_agree_with_definitions_and_fit_a_manifold(signs in prop::array::uniform18(-1_i32..=1)) {
            let mask = |sign: i32| (0..18).filter(|&bit| signs[bit] == sign).fold(0, |m, b| m | 1 << b);
            let sides = ShadowSigns { area: Default::default(), left: mask(1), right: mask(-1) };
            let sign = |edge: usize, vertex: usize, lane: usize| signs[6 * edge + 2 * vertex + lane];
            let is_inside = |v: usize, lane: usize| {
                (0..3).all(|e| sign(e, v, lane) >= 0) != (0..3).all(|e| sign(e, v, lane) <= 0)
            };
            let splits = |e: usize, v: usize, lane: usize| sign(e, v, lane) * sign(e, NEXT[v], lane) < 0;
            let inside = [0, 1].map(|lane| (0..3).filter(|&v| is_inside(v, lane)).fold(0, |m, v| m | 1 << v));
            prop_assert_eq!(sides.inside(), inside);
            let crossings = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)))
                .filter(|&(i, j)| splits(j, i, 0) && splits(i, j, 1))
                .fold(0, |m, (i, j)| m | 1 << (6 * j + 2 * i));
            prop_assert_eq!(sides.crossings(), crossings);
            let count = inside[0].count_ones() + inside[1].count_ones() + crossings.count_ones();
            prop_assert!((count as usize) < MANIFOLD_CAPACITY);
        }
    }
}
