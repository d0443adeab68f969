//! The search: depth first, the nearest pair first, with a bound.
//!
//! A pair of nodes is replaced by the pairs of its children whose lower bound is at most the best
//! value so far. The pair with the least bound is next. The first leaves reached are near the
//! answer, so the bound is tight from then on.

use std::ops::ControlFlow;

use crate::traverse::{Compare, DescentScratch, NodePair, expand, leaves_at};
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

/// Lower bounds of pairs of nodes, and what they are compared with.
pub(super) trait Bounds: Compare<Key = f32> {
    /// Pairs with a bound above this cannot matter. [`FOUND`] ends the search.
    fn limit(&self) -> f32;

    /// Returns true if a second look, which may take longer, tells that a pair of nodes cannot
    /// matter.
    fn are_beyond(&mut self, _trees: (&Tree, &Tree), _nodes: NodePair) -> bool {
        false
    }
}

/// Goes through all pairs of leaves that may matter. `leaves` may lower the limit.
pub(super) fn seek<B: Bounds>(
    trees: (&Tree, &Tree),
    bounds: &mut B,
    scratch: &mut SearchScratch,
    mut leaves: impl FnMut(&mut B, &LeafBatch, &LeafBatch),
) {
    let roots = (f32::NEG_INFINITY, NodePair::ROOTS);
    best_first(&mut scratch.stack, roots, |key, slots, stack| {
        if bounds.limit() == FOUND {
            return ControlFlow::Break(());
        }
        // A bound that is NaN prunes nothing.
        if key > bounds.limit() || bounds.are_beyond(trees, slots) {
            return ControlFlow::Continue(());
        }
        if let Some((leaf1, leaf2)) = leaves_at(trees, slots) {
            leaves(bounds, leaf1, leaf2);
        } else {
            expand(trees, slots, bounds, |slots, key| stack.push((key, slots)));
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
