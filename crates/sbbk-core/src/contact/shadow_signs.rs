//! Signs of the vertices of a triangle and of a polygon against the edges of the other, on a plane
//! of view.
//!
//! Each vertex of the triangle has signs against all edges of the polygon, and each edge against
//! all corners. The corners and edges of the polygon take the four SIMD lanes. Lanes beyond the
//! last corner repeat the first one, so the next lane always has the next corner.

use super::triangle::{NEXT, Polygon, Triangle};
use glamx::DVec3;
use wide::f64x4;

/// Signs of all lanes against a vertex or an edge of the triangle.
struct Sides {
    /// Twice the areas between edges and vertices.
    areas: f64x4,
    /// Lanes whose vertices are left of the edges. Vertices in neither mask are on the edge up to
    /// rounding.
    left: u32,
    right: u32,
}

impl Sides {
    #[inline(always)]
    fn new(areas: f64x4, slack: f64x4) -> Self {
        let [left, right] = [areas.simd_gt(slack), areas.simd_lt(-slack)];
        Self { areas, left: left.to_bitmask(), right: right.to_bitmask() }
    }
}

/// A triangle and a polygon in view.
pub(super) struct ShadowSigns {
    /// By vertex of the triangle, against the edges of the polygon.
    vertices: [Sides; 3],
    /// By edge of the triangle, against the corners of the polygon.
    edges: [Sides; 3],
    /// Corners of the polygon.
    count: usize,
}

impl ShadowSigns {
    /// The polygon has two to four corners.
    #[inline(always)]
    pub fn new(t: &Triangle, polygon: &Polygon, normal: DVec3) -> Self {
        let &Polygon { corners, size, tie, .. } = polygon;
        let (x, y) = normal.any_orthonormal_pair();
        let origin = t.vertices[0];
        let (own_x, own_y) = (t.heights(origin, x), t.heights(origin, y));
        // Written out, as `array::map` is not always inlined.
        let corner = |j: usize| corners[if j < corners.len() { j } else { 0 }] - origin;
        let lanes = [corner(0), corner(1), corner(2), corner(3)];
        let (other_x, other_y) = (along(&lanes, x), along(&lanes, y));
        let (to_x, to_y) = (after(other_x) - other_x, after(other_y) - other_y);
        let (splat, tie) = (f64x4::splat, tie * (t.size + size));
        let vertex = |v: usize| {
            let areas = to_x * (splat(own_y[v]) - other_y) - to_y * (splat(own_x[v]) - other_x);
            Sides::new(areas, splat(size * tie))
        };
        let edge = |e: usize| {
            let (x, y) = (own_x[NEXT[e]] - own_x[e], own_y[NEXT[e]] - own_y[e]);
            let areas =
                splat(x) * (other_y - splat(own_y[e])) - splat(y) * (other_x - splat(own_x[e]));
            Sides::new(areas, splat(t.size * tie))
        };
        Self {
            vertices: [vertex(0), vertex(1), vertex(2)],
            edges: [edge(0), edge(1), edge(2)],
            count: corners.len(),
        }
    }

    /// Returns the vertices of the triangle and of the polygon that are inside the other or on its
    /// border. A vertex on all lines does not count: the other shadow has no width.
    #[inline(always)]
    pub fn inside(&self) -> [u32; 2] {
        let lanes = self.lanes();
        let is_inside = |v: usize| {
            let Sides { left, right, .. } = self.vertices[v];
            u32::from((left & lanes != 0) != (right & lanes != 0))
        };
        let [ab, bc, ca] = &self.edges;
        let inside = (ab.left | bc.left | ca.left) ^ (ab.right | bc.right | ca.right);
        [is_inside(0) | is_inside(1) << 1 | is_inside(2) << 2, inside & lanes]
    }

    /// Bit `3 j + i` for each edge `i` of the triangle that crosses edge `j` of the polygon. Edge
    /// `i` runs from vertex `i` to the next.
    #[inline(always)]
    pub fn crossings(&self) -> u32 {
        let next = |lanes: u32| lanes >> 1 | (lanes & 1) << 3;
        // A segment is one edge, not two.
        let lanes = if self.count == 2 { 1 } else { self.lanes() };
        let crossing = |i: usize| {
            let (from, to) = (&self.vertices[i], &self.vertices[NEXT[i]]);
            let along = &self.edges[i];
            // Edges with their ends on either side of the line through an edge.
            let split = from.left & to.right | from.right & to.left;
            apart(split & (along.left & next(along.right) | along.right & next(along.left)) & lanes)
        };
        crossing(0) | crossing(1) << 1 | crossing(2) << 2
    }

    /// Computes one crossing.
    #[inline(always)]
    pub fn crossing(&self, bit: usize) -> EdgeCrossing {
        let (i, j) = (bit % 3, bit / 3);
        let at_vertex = |v: usize| self.vertices[v].areas.as_array()[j];
        let (start1, end1) = (at_vertex(i), at_vertex(NEXT[i]));
        let at_corner = |j: usize| self.edges[i].areas.as_array()[j % 4];
        let (start2, end2) = (at_corner(j), at_corner(j + 1));
        let along = [start1 / (start1 - end1), start2 / (start2 - end2)];
        EdgeCrossing { edges: [i, j], along, area: (start1 - end1).abs() }
    }

    /// Mask of the lanes of the polygon.
    #[inline(always)]
    fn lanes(&self) -> u32 {
        (1 << self.count) - 1
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

/// Moves bit `j` of four to bit `3 j`.
#[inline(always)]
fn apart(lanes: u32) -> u32 {
    lanes & 1 | (lanes & 2) << 2 | (lanes & 4) << 4 | (lanes & 8) << 6
}

/// Positions of points along an axis.
#[inline(always)]
fn along([a, b, c, d]: &[DVec3; 4], axis: DVec3) -> f64x4 {
    f64x4::new([a.dot(axis), b.dot(axis), c.dot(axis), d.dot(axis)])
}

/// Moves each lane to the one before.
#[inline(always)]
fn after(lanes: f64x4) -> f64x4 {
    let [a, b, c, d] = lanes.to_array();
    f64x4::new([b, c, d, a])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ManifoldPoints;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Rounding may give signs that no shapes have.
        #[test]
        fn words_of_any_signs_agree_with_definitions_and_fit_a_manifold(
            count in 2_usize..=4,
            signs in prop::array::uniform24(-1_i32..=1),
        ) {
            // Signs of the lanes against a vertex or an edge. Lanes of no corner repeat the first
            // one.
            let sign = |of: usize, j: usize| signs[4 * of + if j < count { j } else { 0 }];
            let sides = |of: usize| {
                let mask = |side: i32| (0..4).filter(|&j| sign(of, j) == side).fold(0, |m, j| m | 1 << j);
                Sides { areas: f64x4::ZERO, left: mask(1), right: mask(-1) }
            };
            let signs =
                ShadowSigns { vertices: [0, 1, 2].map(sides), edges: [3, 4, 5].map(sides), count };
            let are_inside = |signs: &[i32]| signs.iter().all(|s| *s >= 0) != signs.iter().all(|s| *s <= 0);
            let vertex = |v: usize| (0..count).map(|j| sign(v, j)).collect::<Vec<_>>();
            let corner = |j: usize| (3..6).map(|e| sign(e, j)).collect::<Vec<_>>();
            let inside = [
                (0..3).filter(|&v| are_inside(&vertex(v))).fold(0, |m, v| m | 1 << v),
                (0..count).filter(|&j| are_inside(&corner(j))).fold(0, |m, j| m | 1 << j),
            ];
            prop_assert_eq!(signs.inside(), inside);
            let edges = if count == 2 { 1 } else { count };
            let crosses = |i: usize, j: usize| {
                let after = (j + 1) % count;
                sign(i, j) * sign(NEXT[i], j) < 0 && sign(3 + i, j) * sign(3 + i, after) < 0
            };
            let crossings = (0..3).flat_map(|i| (0..edges).map(move |j| (i, j)))
                .filter(|&(i, j)| crosses(i, j))
                .fold(0, |m, (i, j)| m | 1 << (3 * j + i));
            prop_assert_eq!(signs.crossings(), crossings);
            let found = inside[0].count_ones() + inside[1].count_ones() + crossings.count_ones();
            prop_assert!(count > 3 || (found as usize) < ManifoldPoints::new().capacity());
        }
    }
}
