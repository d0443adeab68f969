//! Replaces a pair of nodes by the pairs of their children that pass a comparison.

use super::side::NodeLanes;
use crate::simd::{Inner, Outer, Same, Spread, each_bit};
use crate::tree::{Link, Slot, Tree};

/// The sides of a pair whose children replace them.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Sides {
    Both,
    First,
    Second,
}

impl Sides {
    /// Both sides, or the one that is not a leaf.
    #[inline(always)]
    pub(crate) fn of(links: (Link, Link)) -> Self {
        match (links.0.is_leaf(), links.1.is_leaf()) {
            (true, _) => Self::Second,
            (_, true) => Self::First,
            _ => Self::Both,
        }
    }

    /// The inner node that holds the volumes of each side: the node itself, or its parent if it
    /// stays.
    #[inline(always)]
    pub(crate) fn nodes(self, (slot1, slot2): (Slot, Slot), links: (Link, Link)) -> (u32, u32) {
        match self {
            Self::Both => (links.0.index(), links.1.index()),
            Self::First => (links.0.index(), slot2.node()),
            Self::Second => (slot1.node(), links.1.index()),
        }
    }
}

/// A comparison of the children of two nodes, up to four pairs at a time.
pub(crate) trait Compare {
    /// A value computed for each pair.
    type Key: Copy;

    /// Returns a mask of the lanes whose pairs pass, and the key of each lane.
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>)
    -> (u32, [Self::Key; 4]);
}

/// Compares the pairs of children and calls `push` with those that pass.
#[inline(always)]
pub(crate) fn expand<C: Compare>(
    (tree1, tree2): (&Tree, &Tree),
    (slot1, slot2): (Slot, Slot),
    sides: Sides,
    compare: &mut C,
    mut push: impl FnMut((Slot, Slot), C::Key),
) {
    let links = (tree1.link(slot1), tree2.link(slot2));
    let (node1, node2) = sides.nodes((slot1, slot2), links);
    let (one, two) = (tree1.children(node1), tree2.children(node2));
    match sides {
        Sides::Both => {
            let (mask, keys) = compare.compare(&NodeLanes::new((one, Outer), (two, Inner), 0b1111));
            each_bit(mask, |lane| {
                push((Slot::new(node1, lane >> 1), Slot::new(node2, lane & 1)), keys[lane]);
            });
        }
        Sides::First => {
            let same = Same(slot2.lane());
            let (mask, keys) = compare.compare(&NodeLanes::new((one, Outer), (two, same), 0b0101));
            each_bit(mask, |lane| push((Slot::new(node1, lane >> 1), slot2), keys[lane]));
        }
        Sides::Second => {
            let same = Same(slot1.lane());
            let (mask, keys) = compare.compare(&NodeLanes::new((one, same), (two, Inner), 0b0011));
            each_bit(mask, |lane| push((slot1, Slot::new(node2, lane)), keys[lane]));
        }
    }
}
