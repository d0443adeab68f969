use wide::f32x4;

use crate::simd::Spread;
use crate::tree::{Children, Intervals};
use crate::volumes::SLABS;

/// Pairs of nodes of two trees, one in each of up to four lanes.
#[derive(Copy, Clone)]
pub(crate) struct NodeLanes<'a, S1, S2> {
    pub(super) boxes: BothSides<'a, 3, S1, S2>,
    /// Present if both trees have k-DOPs here.
    pub(super) kdops: Option<KdopLanes<'a, S1, S2>>,
    /// Mask of the lanes that hold a pair.
    pub(crate) lanes: u32,
}

/// Volumes of one kind of both trees.
#[derive(Copy, Clone)]
pub(super) struct BothSides<'a, const COUNT: usize, S1, S2> {
    pub(super) one: Side<'a, COUNT, S1>,
    pub(super) two: Side<'a, COUNT, S2>,
}

/// The k-DOPs of both trees.
pub(super) type KdopLanes<'a, S1, S2> = BothSides<'a, SLABS, S1, S2>;

/// Volumes of one tree, spread over the lanes.
#[derive(Copy, Clone)]
pub(super) struct Side<'a, const COUNT: usize, S> {
    intervals: Intervals<'a, COUNT>,
    spread: S,
}

impl<'a, S1: Copy, S2: Copy> NodeLanes<'a, S1, S2> {
    /// Pairs of children, each tree with its way to spread them.
    #[inline(always)]
    pub(crate) fn new(
        (children1, spread1): (Children<'a>, S1),
        (children2, spread2): (Children<'a>, S2),
        lanes: u32,
    ) -> Self {
        let kdops = children1.kdops.zip(children2.kdops);
        Self {
            boxes: BothSides::new((children1.boxes, spread1), (children2.boxes, spread2)),
            kdops: kdops.map(|(one, two)| BothSides::new((one, spread1), (two, spread2))),
            lanes,
        }
    }
}

impl<'a, const COUNT: usize, S1, S2> BothSides<'a, COUNT, S1, S2> {
    #[inline(always)]
    fn new(one: (Intervals<'a, COUNT>, S1), two: (Intervals<'a, COUNT>, S2)) -> Self {
        let one = Side { intervals: one.0, spread: one.1 };
        Self { one, two: Side { intervals: two.0, spread: two.1 } }
    }
}

impl<const COUNT: usize, S: Spread> Side<'_, COUNT, S> {
    /// The centres along an axis or a slab.
    #[inline(always)]
    pub(super) fn centre(&self, axis: usize) -> f32x4 {
        self.spread.spread(&self.intervals.centre[axis])
    }

    /// The half-lengths along an axis or a slab.
    #[inline(always)]
    pub(super) fn extent(&self, axis: usize) -> f32x4 {
        self.spread.spread(&self.intervals.extent[axis])
    }
}
