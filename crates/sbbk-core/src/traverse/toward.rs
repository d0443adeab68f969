//! Lower bounds of the distance of nodes or triangles along one direction: the normal of the
//! nearest triangles so far.
//!
//! Two meshes far apart have many pairs of nodes nearly as close as the closest. A bound along a
//! slab is short by the cosine of its angle to the vector between them, and this normal is parallel
//! to it. Three adjacent slabs bound each k-DOP along the normal, see
//! [`correspondence`](crate::volumes::directions::correspondence). Triangles are bounded by their
//! corners.
//!
//! Pairs of triangles of two parallel faces are equally near, and rounding lowers the bounds of
//! nodes. Heights in `f64` then tell that whole meshes, nodes, or leaves are no nearer. Heights of
//! nodes take long, so each tie of leaves pays for as many leaves as there were ties.

use glamx::DVec3;
use rustc_hash::FxHashMap;
use wide::f32x4;

use super::expand::NodePair;
use super::frame::PairFrame;
use super::side::{NodeLanes, Side};
use crate::simd::{Spread, V3, dot, each, smallest};
use crate::tree::{LeafBatch, Slot, Tree};
use crate::volumes::{Aabb, directions};

/// A direction from mesh 1 to mesh 2, and the distance that nearer pairs are below. Mesh 1 is
/// bounded against the direction, so both meshes have least heights.
#[derive(Clone, Debug)]
pub(crate) struct Toward {
    distance: f64,
    /// Upper bound of the distance.
    limit: f32,
    /// Offset of frame 2 along the direction, less the rounding.
    nodes_offset: f32,
    /// The offset for triangles.
    leaves_offset: f32,
    /// Against the direction in frame 1, and along it in frame 2.
    directions: [Direction; 2],
    /// The directions without rounding to `f32`.
    exact: [DVec3; 2],
    /// Offset of frame 2 along the direction, more by the rounding in `f64`.
    exact_offset: f64,
    /// Least heights of inner nodes in `f64`.
    heights: [FxHashMap<u32, f64>; 2],
    /// Pairs of leaves that are no nearer than the distance, though rounding left that open.
    ties: u32,
    /// Leaves that heights of nodes may still look at.
    allowance: u32,
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

/// Rounding of projections in `f64`, as a share of the rounding in `f32`: 2⁻⁵³ to 2⁻²⁴, and some
/// more.
const EXACT_ROUNDING: f64 = 1.0e-8;

/// Projections of coordinates with less rounding than this cannot overflow.
const LARGEST_ROUNDING: f32 = 1.0e28;

impl Toward {
    /// Bounds along the unit vector `normal` of frame 1, for pairs nearer than `distance`. `None`
    /// if coordinates are so large that a projection may overflow.
    pub(crate) fn new(frame: &PairFrame, normal: DVec3, distance: f64) -> Option<Self> {
        let is_safe = frame.rounding.iter().all(|&rounding| rounding < LARGEST_ROUNDING);
        if !is_safe {
            return None;
        }
        let directions = [-normal, frame.placement.rotation.transpose() * normal];
        let along = normal.dot(frame.placement.translation);
        let rounding = f64::from(frame.rounding[0]);
        Some(Self {
            distance,
            limit: (distance as f32).next_up(),
            nodes_offset: (along - 6.0 * rounding) as f32,
            leaves_offset: (along - rounding) as f32,
            directions: directions.map(Direction::new),
            exact: directions,
            exact_offset: along + EXACT_ROUNDING * rounding,
            heights: Default::default(),
            ties: 0,
            allowance: 0,
        })
    }

    /// Lower bounds of the signed distances of the volumes in four lanes: k-DOPs, or boxes where a
    /// tree has none.
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

    /// Returns true if no triangles of two meshes are nearer than the distance, by boxes around the
    /// meshes.
    pub(crate) fn are_meshes_beyond(&self, trees: (&Tree, &Tree)) -> bool {
        let [direction1, direction2] = self.exact;
        let lowest = |direction: DVec3, tree: &Tree| {
            let Aabb { min, max } = tree.bounds();
            (direction * min.as_dvec3()).min(direction * max.as_dvec3()).element_sum()
        };
        self.are_beyond(lowest(direction1, trees.0), lowest(direction2, trees.1))
    }

    /// Returns true if no triangles of two leaves are nearer than the distance, up to rounding in
    /// `f64`.
    #[inline(always)]
    pub(crate) fn are_leaves_beyond(&mut self, batch1: &LeafBatch, batch2: &LeafBatch) -> bool {
        self.gap_of_leaves(batch1, batch2) > self.limit || self.is_tie(batch1, batch2)
    }

    fn is_tie(&mut self, batch1: &LeafBatch, batch2: &LeafBatch) -> bool {
        let [direction1, direction2] = self.exact;
        let is_tie = self.are_beyond(lowest(direction1, batch1), lowest(direction2, batch2));
        self.ties += u32::from(is_tie);
        self.allowance = self.allowance.saturating_add(if is_tie { self.ties } else { 0 });
        is_tie
    }

    /// Returns true if no triangles of two nodes are nearer than the distance, up to rounding in
    /// `f64`. Returns false if the allowance is used up.
    #[inline(always)]
    pub(crate) fn are_nodes_beyond(&mut self, trees: (&Tree, &Tree), nodes: NodePair) -> bool {
        self.allowance > 0 && self.are_heights_beyond(trees, nodes)
    }

    #[inline(never)]
    fn are_heights_beyond(
        &mut self,
        (tree1, tree2): (&Tree, &Tree),
        NodePair(node1, node2): NodePair,
    ) -> bool {
        let lowest1 = self.lowest(0, tree1, node1);
        let both = lowest1.and_then(|lowest1| Some((lowest1, self.lowest(1, tree2, node2)?)));
        both.is_some_and(|(lowest1, lowest2)| self.are_beyond(lowest1, lowest2))
    }

    fn are_beyond(&self, lowest1: f64, lowest2: f64) -> bool {
        self.exact_offset + lowest1 + lowest2 >= self.distance
    }

    /// Returns the least height of the triangles of a node; `None` if the allowance is used up.
    fn lowest(&mut self, side: usize, tree: &Tree, slot: Slot) -> Option<f64> {
        let link = tree.link(slot);
        if link.is_leaf() {
            self.allowance = self.allowance.checked_sub(1)?;
            return Some(lowest(self.exact[side], tree.leaf(link.index())));
        }
        if let Some(known) = self.heights[side].get(&link.index()) {
            return Some(*known);
        }
        let [slot1, slot2] = [0, 1].map(|lane| Slot::new(link.index(), lane));
        let height = self.lowest(side, tree, slot1)?.min(self.lowest(side, tree, slot2)?);
        self.heights[side].insert(link.index(), height);
        Some(height)
    }
}

/// The least height of the corners of a leaf.
fn lowest(direction: DVec3, batch: &LeafBatch) -> f64 {
    let corners = (0..batch.count()).flat_map(|lane| batch.corners(lane));
    corners.map(|corner| direction.dot(corner.as_dvec3())).fold(f64::INFINITY, f64::min)
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
