//! The search: depth first, the nearest pair first, with a bound.
//!
//! A pair of nodes is replaced by the pairs of its children whose lower bound is at most the best
//! value so far. The pair with the least bound is next. The first leaves reached are near the
//! answer, so the bound is tight from then on.

use std::ops::ControlFlow;

use wide::f32x4;

use crate::simd::Spread;
use crate::traverse::{
    Compare, DescentScratch, NodeLanes, NodePair, PairFrame, Toward, expand, leaves_at,
};
use crate::tree::{LeafBatch, Tree};

/// Memory of a query, kept by the caller. After a few queries nothing is allocated, but heights of
/// nodes at parallel faces.
#[derive(Clone, Debug, Default)]
pub struct SearchScratch {
    stack: Vec<(f32, NodePair)>,
    pub(super) descent: DescentScratch,
}

/// The limit that ends a search.
pub(super) const FOUND: f32 = f32::NEG_INFINITY;

/// A lower bound of a search.
pub(super) trait LowerBound {
    /// Returns the bounds of pairs of nodes, lane by lane. A bound that is NaN excludes nothing.
    fn of(&self, frame: &mut PairFrame, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4;
}

/// Keeps pairs of nodes that may be below a limit, which the best pair of triangles so far gives.
pub(super) struct Pruned<'a, B> {
    pub(super) frame: &'a mut PairFrame,
    pub(super) bound: B,
    /// Pairs with a bound above this cannot matter. [`FOUND`] ends the search.
    pub(super) limit: f32,
    /// The normal of the best pair of triangles, to try first.
    pub(super) normal: Option<BestNormal>,
}

/// A normal along which gaps bound other pairs.
pub(super) struct BestNormal {
    pub(super) toward: Toward,
    /// The gap whose bound is zero, and the bound for each unit beyond.
    pub(super) target: f32,
    pub(super) scale: f32,
}

impl BestNormal {
    #[inline(always)]
    fn bounds(&self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        (self.toward.gaps(nodes) - f32x4::splat(self.target)) * f32x4::splat(self.scale)
    }
}

impl<B> Pruned<'_, B> {
    /// Returns true if the normal tells that no triangles of two leaves matter.
    #[inline(always)]
    pub(super) fn are_leaves_beyond(&mut self, batch1: &LeafBatch, batch2: &LeafBatch) -> bool {
        self.normal.as_mut().is_some_and(|best| best.toward.are_leaves_beyond(batch1, batch2))
    }

    /// Returns true if a second look, which may take longer, tells that no pair below two nodes
    /// matters.
    fn are_nodes_beyond(&mut self, trees: (&Tree, &Tree), nodes: NodePair) -> bool {
        self.normal.as_mut().is_some_and(|best| best.toward.are_nodes_beyond(trees, nodes))
    }

    /// Returns true if the normal tells that nothing else in two meshes matters.
    #[inline(always)]
    pub(super) fn are_meshes_beyond(&self, trees: (&Tree, &Tree)) -> bool {
        self.normal.as_ref().is_some_and(|best| best.toward.are_meshes_beyond(trees))
    }
}

impl<B: LowerBound> Compare for Pruned<'_, B> {
    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        self.frame.counts.aabb_tests += u64::from(nodes.lanes.count_ones());
        let along = self.normal.as_ref().map(|best| best.bounds(nodes));
        let along = along.unwrap_or(f32x4::splat(f32::NEG_INFINITY));
        // A bound that overflowed to NaN is kept, as it excludes nothing.
        let limit = f32x4::splat(self.limit);
        let within = |bounds: f32x4| nodes.lanes & !bounds.simd_gt(limit).to_bitmask();
        if within(along) == 0 {
            return (0, [0.0; 4]);
        }
        let bounds = self.bound.of(self.frame, nodes).fast_max(along);
        (within(bounds), bounds.to_array())
    }
}

/// Goes through all pairs of leaves that may matter. `leaves` may lower the limit.
pub(super) fn seek<B: LowerBound>(
    trees: (&Tree, &Tree),
    pruned: &mut Pruned<'_, B>,
    scratch: &mut SearchScratch,
    mut leaves: impl FnMut(&mut Pruned<'_, B>, &LeafBatch, &LeafBatch),
) {
    let roots = (f32::NEG_INFINITY, NodePair::ROOTS);
    best_first(&mut scratch.stack, roots, |key, slots, stack| {
        if pruned.limit == FOUND {
            return ControlFlow::Break(());
        }
        // A bound that is NaN prunes nothing.
        if key > pruned.limit || pruned.are_nodes_beyond(trees, slots) {
            return ControlFlow::Continue(());
        }
        if let Some((leaf1, leaf2)) = leaves_at(trees, slots) {
            leaves(pruned, leaf1, leaf2);
        } else {
            expand(trees, slots, pruned, |slots, key| stack.push((key, slots)));
        }
        ControlFlow::Continue(())
    });
}

/// Opens pairs of nodes of any two hierarchies, depth first. The pair with the least bound is next
/// among those that a call of `open` adds, and the last one of equal bounds.
///
/// `open` gets the bound of a pair and the pair. It compares two leaves, or adds the pairs below
/// two nodes with their bounds. The search ends when it breaks.
#[inline(always)]
pub fn best_first<B: Copy + PartialOrd, P: Copy>(
    stack: &mut Vec<(B, P)>,
    roots: (B, P),
    mut open: impl FnMut(B, P, &mut Vec<(B, P)>) -> ControlFlow<()>,
) {
    stack.clear();
    stack.push(roots);
    while let Some((bound, pair)) = stack.pop() {
        let first = stack.len();
        if open(bound, pair, stack).is_break() {
            return;
        }
        let added = &mut stack[first..];
        for end in 1..added.len() {
            for i in (0..end).rev() {
                if added[i].0 < added[i + 1].0 {
                    added.swap(i, i + 1);
                } else {
                    break;
                }
            }
        }
    }
}
