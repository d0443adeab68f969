//! Triangles with their adjacency, and walks around an edge or a vertex.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use glamx::DVec3;

use super::cones::MinimumCones;
use super::memo::PlaceMemo;
use super::slopes::angle;
use crate::contact::Feature;

/// Triangles with their adjacency. Half-edge `3 t + i` runs from vertex `i` of triangle `t` to the
/// next one.
pub trait Facets {
    /// The half-edge that runs back in the neighbour, if there is exactly one.
    fn twin(&self, half_edge: u32) -> Option<u32>;

    /// A corner of the triangle of a half-edge, counted from the start of the half-edge.
    fn corner(&self, half_edge: u32, i: usize) -> DVec3;

    /// True if the one-ring of an edge or a vertex is all of the surface there, as there are no
    /// strays.
    fn is_whole(&self, _triangle: u32, _feature: Feature) -> bool {
        true
    }

    /// Calls `visit` with all triangles near the box between two corners, to find strays. May end
    /// when it breaks.
    fn near(&self, _corners: [DVec3; 2], _visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {}

    /// Sign with which the normal of a triangle leads out of the body; 0 unless the body is on one
    /// side.
    fn outward(&self, _triangle: u32) -> f64 {
        1.0
    }

    /// Bounds of the directions that may be local minima at a triangle. They spare the look at its
    /// neighbours.
    fn cones(&self, _triangle: u32) -> MinimumCones {
        MinimumCones::ALL
    }

    /// Memory for places where many triangles meet.
    fn memo(&self) -> Option<&PlaceMemo> {
        None
    }
}

/// Visits the one-ring of an edge or a vertex, starting with `triangle`, until `visit` breaks.
/// Returns true if the ring closes. Ends for any twins, also for those that a mesh had before an
/// edit.
#[inline(always)]
pub(super) fn visit_ring(
    facets: &impl Facets,
    triangle: u32,
    feature: Feature,
    mut visit: impl FnMut(Wedge) -> ControlFlow<()>,
) -> bool {
    let first = half_edge(triangle, feature);
    let start = facets.corner(first, 0);
    let edge = |half_edge: u32, i: usize| facets.corner(half_edge, i) - start;
    let [first_u, first_v] = [edge(first, 1), edge(first, 2)];
    let own = Wedge { half_edge: first, edges: [first_u, first_v], are_new: [true; 2] };
    if visit(own).is_break() {
        return false;
    }
    if !matches!(feature, Feature::Vertex(_)) {
        let Some(half_edge) = facets.twin(first) else { return false };
        let start = facets.corner(half_edge, 0);
        let edge = |i: usize| facets.corner(half_edge, i) - start;
        let [u, v] = [edge(1), edge(2)];
        return visit(Wedge { half_edge, edges: [u, v], are_new: [true; 2] }).is_continue();
    }
    let (mut at, mut u, mut walk) = (first, first_v, Walk::new(first));
    while let Some(twin) = facets.twin(previous(at)) {
        if twin == first {
            return true;
        }
        if walk.returns_at(twin) {
            return false;
        }
        at = twin;
        let v = edge(at, 2);
        if visit(Wedge { half_edge: at, edges: [u, v], are_new: [false, true] }).is_break() {
            return false;
        }
        u = v;
    }
    // At a border: the other direction.
    let (mut at, mut v, mut walk) = (first, first_u, Walk::new(first));
    while let Some(twin) = facets.twin(at) {
        at = next(twin);
        if walk.returns_at(at) {
            break;
        }
        let u = edge(at, 1);
        if visit(Wedge { half_edge: at, edges: [u, v], are_new: [true, false] }).is_break() {
            break;
        }
        v = u;
    }
    false
}

/// Notices that a walk goes in circles, in constant memory (Brent 1980, "An improved Monte Carlo
/// factorization algorithm").
struct Walk {
    /// Half-edge of an earlier step.
    mark: u32,
    /// Steps to the next mark.
    left: u32,
    /// Steps between the last two marks.
    between: u32,
}

impl Walk {
    fn new(first: u32) -> Self {
        Self { mark: first, left: 1, between: 1 }
    }

    /// Makes a step. Returns true if the walk is where it was before.
    #[inline(always)]
    fn returns_at(&mut self, half_edge: u32) -> bool {
        let returns = half_edge == self.mark;
        self.left -= 1;
        if self.left == 0 {
            self.between *= 2;
            (self.mark, self.left) = (half_edge, self.between);
        }
        returns
    }
}

/// A triangle of a one-ring.
pub(super) struct Wedge {
    /// Starts at the vertex, or at an end of the edge.
    pub(super) half_edge: u32,
    /// Two edges of the triangle, from there.
    pub(super) edges: [DVec3; 2],
    /// True for edges that no earlier triangle of the ring has.
    pub(super) are_new: [bool; 2],
}

impl Wedge {
    /// Normal of the triangle; its length is twice the area.
    #[inline(always)]
    pub(super) fn area(&self) -> DVec3 {
        let [u, v] = self.edges;
        u.cross(v)
    }

    /// Angle of the triangle at the vertex, or at a point of the edge.
    pub(super) fn angle(&self, feature: Feature) -> f64 {
        let [u, v] = self.edges;
        if let Feature::Vertex(_) = feature { angle(u, v) } else { PI }
    }
}

pub(super) fn half_edge(triangle: u32, feature: Feature) -> u32 {
    3 * triangle
        + match feature {
            Feature::Face => 0,
            Feature::Edge(i) | Feature::Vertex(i) => u32::from(i),
        }
}

pub(super) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

pub(super) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    struct AnyTwins(Vec<Option<u32>>);

    impl Facets for AnyTwins {
        fn twin(&self, half_edge: u32) -> Option<u32> {
            self.0[half_edge as usize]
        }

        fn corner(&self, _: u32, _: usize) -> DVec3 {
            DVec3::ZERO
        }
    }

    proptest! {
        /// Would catch a walk that enters a circle without its start, as after an edit that a host
        /// did not tell.
        #[test]
        fn walks_end_for_any_twins(numbers in vec(any::<u32>(), 3..300)) {
            let count = numbers.len() as u32 / 3 * 3;
            let twin = |number: &u32| (!number.is_multiple_of(16)).then_some(number / 16 % count);
            let facets = AnyTwins(numbers.iter().map(twin).collect());
            for half_edge in 0..count {
                let (feature, mut steps) = (Feature::Vertex((half_edge % 3) as u8), 0);
                visit_ring(&facets, half_edge / 3, feature, |_| {
                    steps += 1;
                    assert!(steps <= 8 * count, "{half_edge} of {count}");
                    ControlFlow::Continue(())
                });
            }
        }
    }
}
