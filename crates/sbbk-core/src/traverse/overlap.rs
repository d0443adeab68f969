//! Tests which of up to four pairs of nodes come within the margin.

use wide::f32x4;

use super::expand::Compare;
use super::frame::PairFrame;
use super::side::NodeLanes;
use crate::simd::{Spread, bits, largest};

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

    /// Minus the least overlap of the boxes in each lane along their face axes, with the margin.
    /// Positive if the volumes do not come within the margin. May be NaN if a number overflows.
    #[inline(always)]
    pub(crate) fn overlaps(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        let meeting = |gaps: f32x4| nodes.lanes & !gaps.simd_gt(f32x4::ZERO).to_bitmask();
        let in_frame1 = self.along1(nodes, self.slack[0]);
        let gaps1 = largest(in_frame1.gaps());
        if meeting(gaps1) == 0 {
            return gaps1;
        }
        let in_frame2 = self.along2(nodes, in_frame1.offset, self.slack[1]);
        let gaps = gaps1.fast_max(largest(in_frame2.gaps()));
        let candidates = meeting(gaps);
        let Some(kdops) = nodes.kdops.as_ref().filter(|_| candidates != 0) else { return gaps };
        let apart = candidates & !self.correspondence().kdops_meet(kdops, candidates);
        let mut gaps = gaps.to_array();
        bits(apart).for_each(|lane| gaps[lane] = f32::INFINITY);
        f32x4::new(gaps)
    }
}

/// Keeps the children whose volumes come within the margin. Compares boxes first, then k-DOPs if
/// both sides have them. There are no keys.
pub(crate) struct Overlap<'a>(pub(crate) &'a mut PairFrame);

impl Compare for Overlap<'_> {
    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        let Self(frame) = self;
        frame.counts.aabb_tests += u64::from(nodes.lanes.count_ones());
        let meeting = frame.boxes_meet(nodes) & nodes.lanes;
        let meeting = match &nodes.kdops {
            Some(kdops) if meeting != 0 => frame.correspondence().kdops_meet(kdops, meeting),
            _ => meeting,
        };
        (meeting, [0.0; 4])
    }
}
