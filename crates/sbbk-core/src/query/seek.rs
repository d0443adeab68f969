//! The search: depth first, the nearest pair first, with a bound.
//!
//! A pair of nodes is replaced by the pairs of its children whose lower bound is at most the best
//! value so far. The pair with the least bound is next. The first leaves reached are near the answer, so the
//! bound is tight from then on.

use crate::traverse::{Compare, DescentScratch, SlotPair, expand, leaves_at};
use crate::tree::{LeafBatch, Slot, Tree};

/// A best-first search with lower bounds.
pub(super) trait BestFirst {
    /// Computes lower bounds for pairs of nodes.
    type Compare: Compare<Key = f32>;

    /// The comparison of nodes.
    fn compare(&mut self) -> &mut Self::Compare;

    /// Pairs whose bound is above this cannot matter; [`FOUND`] ends the search.
    fn limit(&self) -> f32;

    /// Compares the triangles of two leaves; may lower the limit.
    fn leaves(&mut self, batch1: &LeafBatch, batch2: &LeafBatch);
}

/// Memory of a query, kept by the caller: after the first few nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct SearchScratch {
    stack: Vec<BoundedPair>,
    pub(super) descent: DescentScratch,
}

/// A pair of nodes and its bound.
#[derive(Copy, Clone, Debug)]
struct BoundedPair {
    key: f32,
    slots: SlotPair,
}

/// The limit that ends a search.
pub(super) const FOUND: f32 = f32::NEG_INFINITY;

/// Goes through all pairs of leaves that may matter.
pub(super) fn seek<B: BestFirst>(
    trees: (&Tree, &Tree),
    bounds: &mut B,
    scratch: &mut SearchScratch,
) {
    let stack = &mut scratch.stack;
    stack.clear();
    stack.push(BoundedPair { key: f32::NEG_INFINITY, slots: (Slot::ROOT, Slot::ROOT) });
    while let Some(BoundedPair { key, slots }) = stack.pop() {
        if bounds.limit() == FOUND {
            return;
        }
        // A bound that is NaN prunes nothing.
        if key > bounds.limit() {
            continue;
        }
        if let Some((leaf1, leaf2)) = leaves_at(trees, slots) {
            bounds.leaves(leaf1, leaf2);
            continue;
        }
        let first = stack.len();
        expand(trees, slots, bounds.compare(), |slots, key| {
            stack.push(BoundedPair { key, slots });
        });
        nearest_last(&mut stack[first..]);
    }
}

/// Sorts up to four pairs, so that the one with the least bound is popped first; equal ones in the
/// order they have.
#[inline(always)]
fn nearest_last(pairs: &mut [BoundedPair]) {
    for end in 1..pairs.len() {
        for i in (0..end).rev() {
            if pairs[i].key < pairs[i + 1].key {
                pairs.swap(i, i + 1);
            } else {
                break;
            }
        }
    }
}
