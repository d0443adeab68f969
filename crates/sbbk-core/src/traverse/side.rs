use wide::f32x4;

use crate::simd::{Spread, V3, each};
use crate::tree::{Children, Intervals};
use crate::volumes::SLABS;

/// Pairs of nodes of two trees, one in each of up to four lanes.
#[derive(Copy, Clone)]
pub(crate) struct NodeLanes<'a, S1, S2> {
    pub(super) one: Side<'a, S1>,
    pub(super) two: Side<'a, S2>,
    /// Mask of the lanes that hold a pair.
    pub(crate) lanes: u32,
}

/// The nodes of one tree, spread over the lanes.
#[derive(Copy, Clone)]
pub(super) struct Side<'a, S> {
    children: Children<'a>,
    spread: S,
}

/// The k-DOPs of one tree.
#[derive(Copy, Clone)]
pub(super) struct KdopSide<'a, S> {
    kdops: Intervals<'a, SLABS>,
    spread: S,
}

/// The k-DOPs of both trees.
#[derive(Copy, Clone)]
pub(super) struct KdopLanes<'a, S1, S2> {
    pub(super) one: KdopSide<'a, S1>,
    pub(super) two: KdopSide<'a, S2>,
}

impl<'a, S1: Copy, S2: Copy> NodeLanes<'a, S1, S2> {
    /// Pairs of children, each tree with its way to spread them.
    #[inline(always)]
    pub(crate) fn new(
        (children1, spread1): (Children<'a>, S1),
        (children2, spread2): (Children<'a>, S2),
        lanes: u32,
    ) -> Self {
        let one = Side { children: children1, spread: spread1 };
        Self { one, two: Side { children: children2, spread: spread2 }, lanes }
    }

    /// Returns the k-DOPs if both trees have them.
    #[inline(always)]
    pub(super) fn kdops(&self) -> Option<KdopLanes<'a, S1, S2>> {
        let Self { one, two, .. } = self;
        Some(KdopLanes {
            one: KdopSide { kdops: one.children.kdops?, spread: one.spread },
            two: KdopSide { kdops: two.children.kdops?, spread: two.spread },
        })
    }
}

impl<S: Spread> Side<'_, S> {
    /// The centres of the boxes.
    #[inline(always)]
    pub(super) fn centre(&self) -> V3<f32x4> {
        each(|axis| self.spread.spread(&self.children.boxes.centre[axis]))
    }

    /// The half-lengths of the boxes.
    #[inline(always)]
    pub(super) fn extent(&self) -> V3<f32x4> {
        each(|axis| self.spread.spread(&self.children.boxes.extent[axis]))
    }
}

impl<S: Spread> KdopSide<'_, S> {
    #[inline(always)]
    pub(super) fn centre(&self, slab: usize) -> f32x4 {
        self.spread.spread(&self.kdops.centre[slab])
    }

    #[inline(always)]
    pub(super) fn extent(&self, slab: usize) -> f32x4 {
        self.spread.spread(&self.kdops.extent[slab])
    }
}
