//! What a front asks of two trees.

use wide::f32x4;

use crate::simd::{Inner, Outer, Same};
use crate::traverse::{Counters, PairFrame, Side, Sides};
use crate::tree::{Link, Slot, Tree};

/// A pair of nodes.
pub(super) type SlotPair = (Slot, Slot);

/// The pairs below a pair of nodes, lane by lane, as a descent compares them.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct Opening {
    /// The inner nodes that hold the volumes.
    pub(super) nodes: (u32, u32),
    pub(super) sides: Sides,
    /// Of the side that stays.
    pub(super) same_lane: u8,
    /// Lanes that hold a pair.
    pub(super) lanes: u8,
    /// Those of them that hold a pair of leaves.
    pub(super) leaves: u8,
}

impl Opening {
    /// The pair in a lane.
    pub(super) fn pair(&self, lane: usize) -> SlotPair {
        let same = usize::from(self.same_lane);
        let (lane1, lane2) = match self.sides {
            Sides::Both => (lane >> 1, lane & 1),
            Sides::First => (lane >> 1, same),
            Sides::Second => (same, lane & 1),
        };
        (Slot::new(self.nodes.0, lane1), Slot::new(self.nodes.1, lane2))
    }
}

/// Two trees at a pose, or what stands for them in a test.
pub(super) trait PairTest {
    /// The pair of roots, as the only lane.
    fn roots(&self) -> Opening;
    /// What is below a pair that is not a pair of leaves.
    fn open(&self, pair: SlotPair) -> Opening;
    /// The numbers of a pair of leaves.
    fn leaves(&self, pair: SlotPair) -> (u32, u32);
    /// Lower bounds of the distances of the pairs in `lanes`.
    fn gaps(&mut self, opening: &Opening, lanes: u8) -> f32x4;
}

/// Two trees at a pose.
pub(super) struct TreePair<'a, C> {
    trees: (&'a Tree, &'a Tree),
    frame: &'a mut PairFrame,
    counters: C,
}

impl<'a, C: Counters> TreePair<'a, C> {
    pub(super) fn new(trees: (&'a Tree, &'a Tree), frame: &'a mut PairFrame, counters: C) -> Self {
        Self { trees, frame, counters }
    }

    fn opening(&self, nodes: (u32, u32), sides: Sides, same_lane: usize, lanes: u8) -> Opening {
        let mut opening = Opening { nodes, sides, same_lane: same_lane as u8, lanes, leaves: 0 };
        for lane in (0..4).filter(|lane| lanes >> lane & 1 != 0) {
            let links = self.links(opening.pair(lane));
            opening.leaves |= u8::from(links.0.is_leaf() && links.1.is_leaf()) << lane;
        }
        opening
    }

    fn links(&self, (slot1, slot2): SlotPair) -> (Link, Link) {
        (self.trees.0.link(slot1), self.trees.1.link(slot2))
    }
}

impl<C: Counters> PairTest for TreePair<'_, C> {
    fn roots(&self) -> Opening {
        self.opening((Slot::ROOT.node(), Slot::ROOT.node()), Sides::Both, 0, 0b0001)
    }

    #[inline(always)]
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

    #[inline(always)]
    fn leaves(&self, pair: SlotPair) -> (u32, u32) {
        let links = self.links(pair);
        (links.0.index(), links.1.index())
    }

    #[inline(always)]
    fn gaps(&mut self, opening: &Opening, lanes: u8) -> f32x4 {
        self.counters.aabb_tests(lanes.count_ones());
        let (tree1, tree2) = self.trees;
        let (one, two) = (tree1.children(opening.nodes.0), tree2.children(opening.nodes.1));
        let same = Same(usize::from(opening.same_lane));
        let (outer, inner) =
            (Side { children: one, spread: Outer }, Side { children: two, spread: Inner });
        let (frame, lanes) = (&mut *self.frame, u32::from(lanes));
        let found = match opening.sides {
            Sides::Both => frame.gaps_beyond_margin(&outer, &inner, lanes),
            Sides::First => {
                frame.gaps_beyond_margin(&outer, &Side { children: two, spread: same }, lanes)
            }
            Sides::Second => {
                frame.gaps_beyond_margin(&Side { children: one, spread: same }, &inner, lanes)
            }
        };
        self.counters.kdop_tests(found.kdop_lanes.count_ones());
        found.gaps
    }
}
