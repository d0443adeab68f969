//! Finds the minimum cones of a triangle from the spread of the edges around its corners and sides.

use std::ops::ControlFlow;

use glamx::DVec3;

use super::cones::MinimumCones;
use super::facets::{Facets, Wedge, visit_ring};
use super::slopes::{BENDS, FLAT, LONG, RISE, RISE_TO_FACE};
use super::triangle::{area_vector, longest_side};
use crate::contact::Feature;
use crate::simd::each;

/// Least height of a triangle that has cones, in its longest side. Higher: fewer triangles have
/// cones. Lower: all corners of a sliver may be equally far in a direction beside its normal.
const SLIVER: f64 = 0.01;

/// Finds the cones of a triangle. Takes about a microsecond.
///
/// A direction at an angle `t` to the normal leads up along one of the edges of a closed one-ring.
/// Let `b` be the greatest sine by which an edge leaves the plane of the triangle. Let `a` be the
/// cosine that belongs to `b`, times the cosine of half the widest angle between edges in the
/// plane. The edge rises by `a sin t - b cos t` at least. This is at most the allowed sine `s`
/// where `t <= atan(b / a) + asin(s / sqrt(a² + b²))`.
pub fn minimum_cones(facets: &impl Facets, triangle: u32) -> MinimumCones {
    let corners = each(|i| facets.corner(3 * triangle, i));
    let area = area_vector(&corners);
    let is_wide = area.length() >= SLIVER * longest_side(&corners).powi(2);
    if !is_wide {
        return MinimumCones::ALL;
    }
    let mut squares = [1.0_f64; 2];
    for feature in (0..3).flat_map(|i| [Feature::Vertex(i), Feature::Edge(i)]) {
        let Some(spread) = Spread::of(facets, triangle, feature, area.normalize()) else {
            return MinimumCones::ALL;
        };
        for (square, most) in squares.iter_mut().zip([RISE, RISE_TO_FACE]) {
            *square = square.min(spread.least_square(most));
        }
    }
    MinimumCones::new(squares)
}

/// How far the edges of a one-ring spread around a normal.
struct Spread {
    normal: DVec3,
    /// Greatest sine by which an edge leaves the plane.
    bend: f64,
    /// Least cosine between neighbouring edges in the plane.
    widest: f64,
}

impl Spread {
    /// Returns the spread of a closed one-ring whose edges run around the normal in their order.
    fn of(facets: &impl Facets, triangle: u32, feature: Feature, normal: DVec3) -> Option<Self> {
        let mut spread = Self { normal, bend: 0.0, widest: 1.0 };
        let (mut count, mut is_fine) = (0, true);
        let is_closed = visit_ring(facets, triangle, feature, |Wedge { edges: [u, v], .. }| {
            count += 1;
            is_fine &= count <= LONG && spread.add(u, v);
            if let Feature::Edge(_) = feature {
                is_fine &= spread.add(v, -u);
            }
            if is_fine { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        (is_closed && is_fine).then_some(spread)
    }

    /// Takes note of two edges. Returns true if the second one is less than half a turn beyond the
    /// first.
    fn add(&mut self, u: DVec3, v: DVec3) -> bool {
        let [up, next_up] = [u, v].map(|edge| edge.dot(self.normal));
        let (along, turn) = (u.dot(v) - up * next_up, self.normal.dot(u.cross(v)));
        self.bend = self.bend.max(up.abs() / u.length());
        self.widest = self.widest.min(along / along.hypot(turn));
        turn > 0.0
    }

    /// Returns the square of the least cosine of a direction along which no edge rises by more than
    /// `most`.
    fn least_square(&self, most: f64) -> f64 {
        let bend = self.bend;
        let most = most.min((BENDS * bend).max(FLAT));
        let along = ((1.0 - bend * bend) * 0.5 * (1.0 + self.widest)).sqrt();
        let length = along.hypot(bend);
        let sine = (most / length).min(1.0);
        let cosine = (along * (1.0 - sine * sine).sqrt() - bend * sine) / length;
        // A `NaN` is no bound.
        if cosine > 0.0 { cosine * cosine } else { 0.0 }
    }
}
