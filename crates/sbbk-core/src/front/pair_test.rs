//! How two trees test pairs of nodes.

use crate::simd::bits;
use crate::traverse::{Counters, Opening, Overlap, PairFrame, Sides, SlotPair, leaves_at};
use crate::tree::{LeafBatch, Slot, Tree};

/// Two trees at a pose, or a stand-in for them in a test.
pub(super) trait PairTest {
    /// The pair of roots, as the only lane, and the mask of lanes that hold a pair of leaves.
    fn roots(&self) -> (Opening, u32);
    /// The pairs below a pair that is not a pair of leaves, and the mask of pairs of leaves.
    fn open(&self, pair: SlotPair) -> (Opening, u32);
    /// Counts and visits a pair of leaves.
    fn visit(&mut self, pair: SlotPair);
    /// The lanes of `lanes` whose pairs come within the margin.
    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32;
}

/// Two trees at a pose.
pub(super) struct TreePair<'a, C, V> {
    pub(super) trees: (&'a Tree, &'a Tree),
    pub(super) frame: &'a mut PairFrame,
    pub(super) counters: C,
    pub(super) visit: V,
}

impl<C, V> TreePair<'_, C, V> {
    fn leaves(&self, opening: &Opening) -> u32 {
        let is_pair = |lane: &usize| leaves_at(self.trees, opening.pair(*lane)).is_some();
        bits(opening.lanes).filter(is_pair).fold(0, |leaves, lane| leaves | 1 << lane)
    }
}

impl<C: Counters, V: FnMut(&LeafBatch, &LeafBatch)> PairTest for TreePair<'_, C, V> {
    fn roots(&self) -> (Opening, u32) {
        let nodes = (Slot::ROOT.node(), Slot::ROOT.node());
        let opening = Opening { nodes, sides: Sides::Both, same_lane: 0, lanes: 0b0001 };
        (opening, self.leaves(&opening))
    }

    fn open(&self, pair: SlotPair) -> (Opening, u32) {
        let opening = Opening::of(self.trees, pair);
        (opening, self.leaves(&opening))
    }

    fn visit(&mut self, pair: SlotPair) {
        self.counters.count(|counts| counts.leaf_pairs += 1);
        if let Some((leaf1, leaf2)) = leaves_at(self.trees, pair) {
            (self.visit)(leaf1, leaf2);
        }
    }

    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32 {
        let mut overlap = Overlap { frame: &mut *self.frame, counters: &mut self.counters };
        opening.compare(self.trees, lanes, &mut overlap).0
    }
}
