//! Borders: where a surface ends.

use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use glamx::DVec3;

use super::facets::{Facets, Wedge, half_edge, previous};
use super::memo::{Memo, key};
use super::one_ring::Around;
use crate::contact::Feature;
use crate::simd::each;

/// Distance from the ends of an edge at which other triangles are sought along the edge, as a share
/// of its length. Higher: a T-junction near an end makes a border. Lower: edges of slivers go on in
/// their neighbours.
const OFF_ENDS: f64 = 0.1;

impl<F: Facets> Around<F> {
    /// True if a surface ends at an edge or a vertex. A triangle there has an edge without a twin,
    /// along which no other triangle goes on.
    pub fn is_border(&self, triangle: u32, feature: Feature, place: DVec3) -> bool {
        match feature {
            Feature::Edge(i) if self.facets.twin(3 * triangle + u32::from(i)).is_none() => {}
            Feature::Vertex(_) => {}
            _ => return false,
        }
        let place = self.place(triangle, feature, Some(place));
        let (triangle, feature, ring) = self.first_of_ring(triangle, feature);
        let find = || self.ends_at(triangle, feature, place);
        Memo::answer(self.facets.memo().map(|memo| &memo.borders), (ring, key(place)), find)
    }

    /// Returns true if an edge without a twin is a border at a place, or if one at a vertex is.
    /// Also returns the number of triangles there.
    fn ends_at(&self, triangle: u32, feature: Feature, place: DVec3) -> (bool, usize) {
        let (mut borders, mut count) = (ArrayVec::<(u32, f64), 2>::new(), 0);
        let first = half_edge(triangle, feature);
        if let Feature::Edge(_) = feature {
            let [start, end] = [0, 1].map(|i| self.corner(first, i));
            let at = (place - start).dot(end - start) / start.distance_squared(end);
            borders.push((first, at.clamp(OFF_ENDS, 1.0 - OFF_ENDS)));
        } else {
            self.visit(triangle, feature, |Wedge { half_edge, .. }| {
                let sides = [(half_edge, OFF_ENDS), (previous(half_edge), 1.0 - OFF_ENDS)];
                let is_alone = |(side, _): &(u32, f64)| self.facets.twin(*side).is_none();
                sides.into_iter().filter(is_alone).for_each(|side| _ = borders.try_push(side));
                count += 1;
                ControlFlow::Continue(())
            });
        }
        let ends = |(side, at): (u32, f64)| {
            let [start, end, third] = each(|i| self.corner(side, i));
            let place = start.lerp(end, at);
            let own = [start, end, third].map(|corner| corner - place);
            let mut ends = true;
            self.visit_touching(side / 3, place, usize::MAX, |other, corners, _| {
                let is_double = own.iter().all(|corner| corners.contains(corner));
                ends &= other == side / 3 || is_double;
                count += 1;
                ControlFlow::Continue(())
            });
            ends
        };
        (borders.into_iter().any(ends), count)
    }

    /// Returns true if the surface ends at the highest corner of a triangle along a unit axis.
    /// `heights` has the heights of the corners.
    pub fn ends_along(&self, triangle: u32, heights: [f64; 3], axis: DVec3) -> bool {
        let highest = (0..3).max_by(|&a, &b| heights[a].total_cmp(&heights[b])).unwrap_or_default();
        self.is_local_minimum(triangle, Feature::Vertex(highest as u8), axis, None)
    }
}
