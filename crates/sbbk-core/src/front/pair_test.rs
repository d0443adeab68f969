//! How two trees test pairs of nodes.

use crate::simd::each_bit;
use crate::traverse::{Counters, Opening, Overlap, PairFrame, Sides, SlotPair};
use crate::tree::{LeafBatch, Link, Slot, Tree};

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
        let mut leaves = 0;
        each_bit(opening.lanes, |lane| {
            let links = self.links(opening.pair(lane));
            leaves |= u32::from(links.0.is_leaf() && links.1.is_leaf()) << lane;
        });
        leaves
    }

    fn links(&self, (slot1, slot2): SlotPair) -> (Link, Link) {
        (self.trees.0.link(slot1), self.trees.1.link(slot2))
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
        let links = self.links(pair);
        let (tree1, tree2) = self.trees;
        (self.visit)(tree1.leaf(links.0.index()), tree2.leaf(links.1.index()));
    }

    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32 {
        let mut overlap = Overlap { frame: &mut *self.frame, counters: &mut self.counters };
        opening.compare(self.trees, lanes, &mut overlap).0
    }
}
