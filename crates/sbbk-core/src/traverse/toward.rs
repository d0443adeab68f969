//! Lower bounds of the distance of nodes or triangles along one direction: the normal of the
//! nearest triangles so far.
//!
//! Two meshes far apart have many pairs of nodes nearly as close as the closest. A bound along a
//! slab is short by the cosine of its angle to the vector between them, and this normal is parallel
//! to it. Three adjacent slabs bound each k-DOP along the normal, see
//! [`correspondence`](crate::volumes::directions::correspondence). Triangles are bounded by their
//! corners.

use glamx::DVec3;
use wide::f32x4;

use super::frame::PairFrame;
use super::side::{NodeLanes, Side};
use crate::simd::{Spread, V3, dot, each, smallest};
use crate::tree::LeafBatch;
use crate::volumes::directions;

/// A direction from mesh 1 to mesh 2. Mesh 1 is bounded against it, so both meshes have least heights.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Toward {
    /// Offset of frame 2 along the direction, less the rounding.
    nodes_offset: f32,
    /// The offset for triangles.
    leaves_offset: f32,
    /// Against the direction in frame 1, and along it in frame 2.
    directions: [Direction; 2],
    /// The same without rounding to `f32`.
    exact: [DVec3; 2],
    /// Offset of frame 2 along the direction, more by the rounding in `f64`.
    exact_offset: f64,
}

#[derive(Copy, Clone, Debug)]
struct Direction {
    components: V3<f32>,
    /// The slabs that bound it.
    terms: [Term; 3],
}

#[derive(Copy, Clone, Debug)]
struct Term {
    slab: usize,
    coefficient: f32x4,
}

/// Rounding of projections in `f64`, as a share of the rounding in `f32`: 2⁻⁵³ to 2⁻²⁴, and some more.
const EXACT_ROUNDING: f64 = 1.0e-8;

/// Projections of coordinates with less rounding than this cannot overflow.
const LARGEST_ROUNDING: f32 = 1.0e28;

impl Toward {
    /// Bounds along the unit vector `normal` of frame 1. `None` if coordinates are so large that a
    /// projection may overflow.
    pub(crate) fn new(frame: &PairFrame, normal: DVec3) -> Option<Self> {
        let is_safe = frame.rounding.iter().all(|&rounding| rounding < LARGEST_ROUNDING);
        if !is_safe {
            return None;
        }
        let directions = [-normal, frame.placement.rotation.transpose() * normal];
        let along = normal.dot(frame.placement.translation);
        let rounding = f64::from(frame.rounding[0]);
        Some(Self {
            nodes_offset: (along - 6.0 * rounding) as f32,
            leaves_offset: (along - rounding) as f32,
            directions: directions.map(Direction::new),
            exact: directions,
            exact_offset: along + EXACT_ROUNDING * rounding,
        })
    }

    /// Lower bounds of the signed distances of the volumes in four lanes: k-DOPs, or boxes where a tree has none.
    #[inline(always)]
    pub(crate) fn gaps(&self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        let [of1, of2] = &self.directions;
        let heights = match (&nodes.kdops, &nodes.boxes) {
            (Some(kdops), _) => kdops.one.lowest(of1.terms) + kdops.two.lowest(of2.terms),
            (None, boxes) => boxes.one.lowest(of1.axes()) + boxes.two.lowest(of2.axes()),
        };
        f32x4::splat(self.nodes_offset) + heights
    }

    /// A lower bound of the distance of any triangle of leaf 1 from any of leaf 2.
    #[inline(always)]
    pub(crate) fn gap_of_leaves(&self, batch1: &LeafBatch, batch2: &LeafBatch) -> f32 {
        let [of1, of2] = &self.directions;
        self.leaves_offset + of1.lowest(batch1) + of2.lowest(batch2)
    }

    /// Returns true if the triangles of two leaves are no nearer than a distance, up to rounding in `f64`. `limit` is not
    /// less than the distance.
    #[inline(always)]
    pub(crate) fn are_beyond(
        &self,
        distance: f64,
        limit: f32,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
    ) -> bool {
        self.gap_of_leaves(batch1, batch2) > limit
            || self.exact_gap_of_leaves(batch1, batch2) >= distance
    }

    fn exact_gap_of_leaves(&self, batch1: &LeafBatch, batch2: &LeafBatch) -> f64 {
        let lowest = |along: DVec3, batch: &LeafBatch| {
            let corners = (0..batch.count()).flat_map(|lane| batch.corners(lane));
            corners.map(|corner| along.dot(corner.as_dvec3())).fold(f64::INFINITY, f64::min)
        };
        self.exact_offset + lowest(self.exact[0], batch1) + lowest(self.exact[1], batch2)
    }
}

impl<const COUNT: usize, S: Spread> Side<'_, COUNT, S> {
    /// The least height along a direction.
    #[inline(always)]
    fn lowest(&self, terms: [Term; 3]) -> f32x4 {
        let heights = terms.map(|Term { slab, coefficient }| {
            coefficient * self.centre(slab) - coefficient.abs() * self.extent(slab)
        });
        heights[0] + heights[1] + heights[2]
    }
}

impl Direction {
    /// The axes of a box, as its slabs.
    #[inline(always)]
    fn axes(&self) -> [Term; 3] {
        each(|slab| Term { slab, coefficient: f32x4::splat(self.components[slab]) })
    }

    fn new(direction: DVec3) -> Self {
        let term =
            |(slab, coefficient)| Term { slab, coefficient: f32x4::splat(coefficient as f32) };
        Self {
            components: direction.as_vec3().to_array(),
            terms: directions::correspondence(direction).map(term),
        }
    }

    /// The least height of the corners of a leaf.
    #[inline(always)]
    fn lowest(&self, batch: &LeafBatch) -> f32 {
        let direction = each(|axis| f32x4::splat(self.components[axis]));
        let corners = batch.lanes();
        let heights = smallest(each(|corner| dot(direction, corners[corner])));
        heights.to_array().into_iter().fold(f32::INFINITY, f32::min)
    }
}
