//! The pairs of nodes below a pair, and how two trees test them.

use crate::simd::{Inner, Outer, Same, each_bit};
use crate::traverse::{Compare, Counters, NodeLanes, Overlap, PairFrame, Sides};
use crate::tree::{LeafBatch, Link, Slot, Tree};

/// A pair of nodes.
pub(super) type SlotPair = (Slot, Slot);

/// The pairs below a pair of nodes, lane by lane, as a descent compares them.
#[derive(Copy, Clone, Debug)]
pub(super) struct Opening {
    /// The inner nodes that hold the volumes.
    pub(super) nodes: (u32, u32),
    pub(super) sides: Sides,
    /// The lane of the side that stays.
    pub(super) same_lane: usize,
    /// Lanes that hold a pair.
    pub(super) lanes: u32,
    /// Lanes that hold a pair of leaves.
    pub(super) leaves: u32,
}

impl Opening {
    /// The pair in a lane.
    pub(super) fn pair(&self, lane: usize) -> SlotPair {
        let (lane1, lane2) = match self.sides {
            Sides::Both => (lane >> 1, lane & 1),
            Sides::First => (lane >> 1, self.same_lane),
            Sides::Second => (self.same_lane, lane & 1),
        };
        (Slot::new(self.nodes.0, lane1), Slot::new(self.nodes.1, lane2))
    }
}

/// Two trees at a pose, or a stand-in for them in a test.
pub(super) trait PairTest {
    /// The pair of roots, as the only lane.
    fn roots(&self) -> Opening;
    /// The pairs below a pair that is not a pair of leaves.
    fn open(&self, pair: SlotPair) -> Opening;
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
    fn opening(&self, nodes: (u32, u32), sides: Sides, same_lane: usize, lanes: u32) -> Opening {
        let mut opening = Opening { nodes, sides, same_lane, lanes, leaves: 0 };
        each_bit(lanes, |lane| {
            let links = self.links(opening.pair(lane));
            opening.leaves |= u32::from(links.0.is_leaf() && links.1.is_leaf()) << lane;
        });
        opening
    }

    fn links(&self, (slot1, slot2): SlotPair) -> (Link, Link) {
        (self.trees.0.link(slot1), self.trees.1.link(slot2))
    }
}

impl<C: Counters, V: FnMut(&LeafBatch, &LeafBatch)> PairTest for TreePair<'_, C, V> {
    fn roots(&self) -> Opening {
        self.opening((Slot::ROOT.node(), Slot::ROOT.node()), Sides::Both, 0, 0b0001)
    }

    fn open(&self, pair: SlotPair) -> Opening {
        let links = self.links(pair);
        let sides = Sides::of(links);
        let (same_lane, lanes) = match sides {
            Sides::Both => (0, 0b1111),
            Sides::First => (pair.1.lane(), 0b0101),
            Sides::Second => (pair.0.lane(), 0b0011),
        };
        self.opening(sides.nodes(pair, links), sides, same_lane, lanes)
    }

    fn visit(&mut self, pair: SlotPair) {
        self.counters.count(|counts| counts.leaf_pairs += 1);
        let links = self.links(pair);
        let (tree1, tree2) = self.trees;
        (self.visit)(tree1.leaf(links.0.index()), tree2.leaf(links.1.index()));
    }

    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32 {
        let (one, two) =
            (self.trees.0.children(opening.nodes.0), self.trees.1.children(opening.nodes.1));
        let same = Same(opening.same_lane);
        let mut overlap = Overlap { frame: &mut *self.frame, counters: &mut self.counters };
        let (meeting, _) = match opening.sides {
            Sides::Both => overlap.compare(&NodeLanes::new((one, Outer), (two, Inner), lanes)),
            Sides::First => overlap.compare(&NodeLanes::new((one, Outer), (two, same), lanes)),
            Sides::Second => overlap.compare(&NodeLanes::new((one, same), (two, Inner), lanes)),
        };
        meeting
    }
}
