//! Tests which of up to four pairs of nodes come within the margin.

use wide::f32x4;

use super::expand::Compare;
use super::frame::PairFrame;
use super::side::NodeLanes;
use crate::simd::{Spread, largest};

impl PairFrame {
    /// Bit k: lane k's boxes come within the margin on the six face axes of both.
    #[inline(always)]
    pub(super) fn boxes_meet(&self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> u32 {
        let in_frame1 = self.along1(nodes, self.slack[0]);
        let meets = in_frame1.meet();
        if meets.to_bitmask() == 0 {
            return 0;
        }
        let in_frame2 = self.along2(nodes, in_frame1.offset, self.slack[1]);
        (meets & in_frame2.meet()).to_bitmask()
    }
}

/// Keeps the children whose volumes come within the margin. Compares boxes first, then k-DOPs if
/// both sides have them.
pub(crate) struct Overlap<'a>(pub(crate) &'a mut PairFrame);

impl Compare for Overlap<'_> {
    type Key = ();

    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [(); 4]) {
        let Self(frame) = self;
        frame.counts.aabb_tests += u64::from(nodes.lanes.count_ones());
        let meeting = frame.boxes_meet(nodes) & nodes.lanes;
        match &nodes.kdops {
            Some(kdops) if meeting != 0 => {
                (frame.correspondence().kdops_meet(kdops, meeting), [(); 4])
            }
            _ => (meeting, [(); 4]),
        }
    }
}

/// Keeps pairs of nodes whose volumes come within the margin. The key is minus the least overlap of
/// the boxes along their face axes.
pub(crate) struct OrderedOverlap<'a> {
    pub(crate) frame: &'a mut PairFrame,
    /// Larger keys do not matter to a search.
    pub(crate) limit: f32,
}

impl Compare for OrderedOverlap<'_> {
    type Key = f32;

    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        let frame = &mut *self.frame;
        // A gap that overflowed to NaN is kept.
        let meeting = |gap: f32x4| nodes.lanes & !gap.simd_gt(f32x4::ZERO).to_bitmask();
        let in_frame1 = frame.along1(nodes, frame.slack[0]);
        let gap1 = largest(in_frame1.gaps());
        if meeting(gap1) == 0 {
            return (0, [0.0; 4]);
        }
        let in_frame2 = frame.along2(nodes, in_frame1.offset, frame.slack[1]);
        let gap = gap1.fast_max(largest(in_frame2.gaps()));
        let meeting = meeting(gap);
        match &nodes.kdops {
            Some(kdops) if meeting != 0 => {
                (frame.correspondence().kdops_meet(kdops, meeting), gap.to_array())
            }
            _ => (meeting, gap.to_array()),
        }
    }
}
