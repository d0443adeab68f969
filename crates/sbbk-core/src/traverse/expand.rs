//! Replaces a pair of nodes by the pairs of their children that pass a comparison.

use super::side::NodeLanes;
use crate::simd::{Inner, Outer, Same, Spread, bits};
use crate::tree::{LeafBatch, Slot, Tree};

/// A node of each of two trees.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NodePair(pub(crate) Slot, pub(crate) Slot);

impl NodePair {
    pub(crate) const ROOTS: Self = Self(Slot::ROOT, Slot::ROOT);
}

/// The leaves of a pair, if both nodes are leaves.
#[inline(always)]
pub(crate) fn leaves_at<'a>(
    (tree1, tree2): (&'a Tree, &'a Tree),
    NodePair(slot1, slot2): NodePair,
) -> Option<(&'a LeafBatch, &'a LeafBatch)> {
    let (link1, link2) = (tree1.link(slot1), tree2.link(slot2));
    let is_pair = link1.is_leaf() && link2.is_leaf();
    is_pair.then(|| (tree1.leaf(link1.index()), tree2.leaf(link2.index())))
}

/// Ratio of lengths above which only the larger node of a pair is replaced. Small nodes lie whole
/// in the boxes of much larger ones, so a descent of both compares all of the small ones with each.
/// Higher: more tests for meshes of unlike sizes. Lower: more tests for meshes of one size.
const LARGER: f32 = 2.0;

/// The sides of a pair whose children replace them.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Sides {
    Both,
    First,
    Second,
}

/// The pairs below a pair of nodes, lane by lane.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Opening {
    /// The inner nodes that hold the volumes.
    pub(crate) nodes: (u32, u32),
    pub(crate) sides: Sides,
    /// The lane of the side that stays.
    pub(crate) same_lane: usize,
    /// Mask of the lanes that hold a pair.
    pub(crate) lanes: u32,
}

impl Opening {
    /// Returns the pairs below a pair that is not a pair of leaves. A leaf stays, and so does a
    /// node much smaller than the other one.
    #[inline(always)]
    pub(crate) fn of((tree1, tree2): (&Tree, &Tree), NodePair(slot1, slot2): NodePair) -> Self {
        let (link1, link2) = (tree1.link(slot1), tree2.link(slot2));
        let [length1, length2] = [tree1.length(slot1), tree2.length(slot2)];
        let stays1 = link1.is_leaf() || !link2.is_leaf() && length2 > LARGER * length1;
        let stays2 = link2.is_leaf() || !link1.is_leaf() && length1 > LARGER * length2;
        let (nodes, sides, same_lane, lanes) = match (stays1, stays2) {
            (true, _) => ((slot1.node(), link2.index()), Sides::Second, slot1.lane(), 0b0011),
            (_, true) => ((link1.index(), slot2.node()), Sides::First, slot2.lane(), 0b0101),
            _ => ((link1.index(), link2.index()), Sides::Both, 0, 0b1111),
        };
        Self { nodes, sides, same_lane, lanes }
    }

    /// The pair in a lane.
    #[inline(always)]
    pub(crate) fn pair(&self, lane: usize) -> NodePair {
        let (lane1, lane2) = match self.sides {
            Sides::Both => (lane >> 1, lane & 1),
            Sides::First => (lane >> 1, self.same_lane),
            Sides::Second => (self.same_lane, lane & 1),
        };
        NodePair(Slot::new(self.nodes.0, lane1), Slot::new(self.nodes.1, lane2))
    }

    /// Compares the pairs in some of the lanes.
    #[inline(always)]
    pub(crate) fn compare<C: Compare>(
        &self,
        (tree1, tree2): (&Tree, &Tree),
        lanes: u32,
        compare: &mut C,
    ) -> (u32, [f32; 4]) {
        let (one, two) = (tree1.children(self.nodes.0), tree2.children(self.nodes.1));
        let same = Same(self.same_lane);
        match self.sides {
            Sides::Both => compare.compare(&NodeLanes::new((one, Outer), (two, Inner), lanes)),
            Sides::First => compare.compare(&NodeLanes::new((one, Outer), (two, same), lanes)),
            Sides::Second => compare.compare(&NodeLanes::new((one, same), (two, Inner), lanes)),
        }
    }
}

/// A comparison of the children of two nodes, up to four pairs at a time.
pub(crate) trait Compare {
    /// Returns a mask of the lanes whose pairs pass, and a key for each lane.
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]);
}

/// Compares the pairs of children and calls `push` with those that pass.
#[inline(always)]
pub(crate) fn expand<C: Compare>(
    trees: (&Tree, &Tree),
    pair: NodePair,
    compare: &mut C,
    mut push: impl FnMut(NodePair, f32),
) {
    let opening = Opening::of(trees, pair);
    let (mask, keys) = opening.compare(trees, opening.lanes, compare);
    for lane in bits(mask) {
        push(opening.pair(lane), keys[lane]);
    }
}
