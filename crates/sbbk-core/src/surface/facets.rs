//! Triangles with their adjacency, and walks around an edge or a vertex.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use glamx::DVec3;

use super::cones::MinimumCones;
use super::memo::PlaceMemo;
use super::slopes::angle;
use crate::contact::Feature;

/// Triangles with their adjacency. Half-edge `3 t + i` runs from vertex `i` of triangle `t` to the next one.
pub trait Facets {
    /// The half-edge that runs back in the neighbour, if there is exactly one.
    fn twin(&self, half_edge: u32) -> Option<u32>;

    /// A corner of the triangle of a half-edge, counted from the start of the half-edge.
    fn corner(&self, half_edge: u32, i: usize) -> DVec3;

    /// True if the one-ring of an edge or a vertex is all of the surface there, as there are no strays.
    fn is_whole(&self, _triangle: u32, _feature: Feature) -> bool {
        true
    }

    /// Calls `visit` with all triangles near the box between two corners, to find strays. May end when it breaks.
    fn near(&self, _corners: [DVec3; 2], _visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {}

    /// Sign with which the normal of a triangle leads out of the body; 0 unless the body is on one side.
    fn outward(&self, _triangle: u32) -> f64 {
        1.0
    }

    /// Bounds of the directions that may be local minima at a triangle. They spare the look at its neighbours.
    fn cones(&self, _triangle: u32) -> MinimumCones {
        MinimumCones::ALL
    }

    /// Memory for places where many triangles meet.
    fn memo(&self) -> Option<&PlaceMemo> {
        None
    }
}

/// Visits the one-ring of an edge or a vertex, starting with `triangle`, until `visit` breaks.
/// Returns true if the ring closes.
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
    let (mut at, mut u) = (first, first_v);
    while let Some(twin) = facets.twin(previous(at)) {
        if twin == first {
            return true;
        }
        at = twin;
        let v = edge(at, 2);
        if visit(Wedge { half_edge: at, edges: [u, v], are_new: [false, true] }).is_break() {
            return false;
        }
        u = v;
    }
    // At a border: the other direction.
    let (mut at, mut v) = (first, first_u);
    while let Some(twin) = facets.twin(at) {
        at = next(twin);
        let u = edge(at, 1);
        if visit(Wedge { half_edge: at, edges: [u, v], are_new: [true, false] }).is_break() {
            break;
        }
        v = u;
    }
    false
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
