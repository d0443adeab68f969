use wide::f32x4;

use crate::simd::{Spread, V3, each};
use crate::tree::{Children, Intervals};
use crate::volumes::SLABS;

/// A side of up to four pairs of nodes, spread over the lanes.
#[derive(Copy, Clone)]
pub(crate) struct Side<'a, S> {
    pub(crate) children: Children<'a>,
    pub(crate) spread: S,
}

/// The k-DOPs of one side.
#[derive(Copy, Clone)]
pub(super) struct KdopSide<'a, S> {
    kdops: Intervals<'a, SLABS>,
    spread: S,
}

/// The k-DOPs of both sides.
#[derive(Copy, Clone)]
pub(super) struct KdopSides<'a, S1, S2> {
    pub(super) one: KdopSide<'a, S1>,
    pub(super) two: KdopSide<'a, S2>,
}

impl<'a, S: Spread> Side<'a, S> {
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

    /// Returns the k-DOPs of both sides if both have them.
    #[inline(always)]
    pub(super) fn kdops_with<S2: Spread>(
        &self,
        other: &Side<'a, S2>,
    ) -> Option<KdopSides<'a, S, S2>> {
        Some(KdopSides {
            one: KdopSide { kdops: self.children.kdops?, spread: self.spread },
            two: KdopSide { kdops: other.children.kdops?, spread: other.spread },
        })
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
