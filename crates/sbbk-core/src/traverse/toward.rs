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
use crate::simd::{Spread, V3, dot, each, largest, smallest};
use crate::tree::LeafBatch;
use crate::volumes::directions;

/// A direction from mesh 1 to mesh 2, in the slabs of both trees.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Toward {
    /// Offset of frame 2 along the direction, less the rounding.
    nodes_offset: f32,
    /// The offset for triangles.
    leaves_offset: f32,
    /// The direction in each frame.
    directions: [Direction; 2],
    /// The direction in each frame, without rounding to `f32`.
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
        let directions = [normal, frame.placement.rotation.transpose() * normal];
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
        let [direction1, direction2] = &self.directions;
        let offset = f32x4::splat(self.nodes_offset);
        match &nodes.kdops {
            Some(kdops) => {
                let [terms1, terms2] = [direction1.terms, direction2.terms];
                offset + kdops.two.lowest(terms2) + kdops.one.lowest(terms1.map(Term::reversed))
            }
            None => {
                let [terms1, terms2] = [direction1.axes(), direction2.axes()];
                let boxes = &nodes.boxes;
                offset + boxes.two.lowest(terms2) + boxes.one.lowest(terms1.map(Term::reversed))
            }
        }
    }

    /// A lower bound of the distance of any triangle of leaf 1 from any of leaf 2.
    #[inline(always)]
    pub(crate) fn gap_of_leaves(&self, batch1: &LeafBatch, batch2: &LeafBatch) -> f32 {
        let [direction1, direction2] = &self.directions;
        let ends1 = largest(direction1.project(batch1)).to_array();
        let starts2 = smallest(direction2.project(batch2)).to_array();
        let end1 = ends1.into_iter().fold(f32::NEG_INFINITY, f32::max);
        starts2.into_iter().fold(f32::INFINITY, f32::min) + self.leaves_offset - end1
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
        let [ends1, starts2] =
            [(batch1, self.exact[0]), (batch2, -self.exact[1])].map(|(of, along)| {
                let corners = (0..of.count()).flat_map(|lane| of.corners(lane));
                corners.map(|corner| along.dot(corner.as_dvec3())).fold(f64::NEG_INFINITY, f64::max)
            });
        self.exact_offset - starts2 - ends1
    }
}

impl Term {
    #[inline(always)]
    fn reversed(self) -> Self {
        Self { coefficient: -self.coefficient, ..self }
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

    /// Projects the corners of all triangles of a leaf on the direction.
    #[inline(always)]
    fn project(&self, batch: &LeafBatch) -> V3<f32x4> {
        let direction = each(|axis| f32x4::splat(self.components[axis]));
        let corners = batch.lanes();
        each(|corner| dot(direction, corners[corner]))
    }
}
