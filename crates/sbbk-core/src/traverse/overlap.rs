//! Which of up to four pairs of nodes come within the margin: all four over SIMD lanes.

use wide::f32x4;

use super::correspondence::{Correspondence, KdopLanes};
use super::frame::PairFrame;
use crate::leaf::lane::each;
use crate::tree::{Children, Lanes};

/// How the volumes of one tree's nodes are laid over the four lanes of a test.
pub(crate) trait Spread: Copy {
    fn spread(self, lanes: &Lanes) -> f32x4;
}

/// Children 0, 0, 1, 1: tree 1's side of all four pairs of children.
#[derive(Copy, Clone)]
pub(crate) struct Outer;

/// Children 0, 1, 0, 1: tree 2's side.
#[derive(Copy, Clone)]
pub(crate) struct Inner;

/// One node in all lanes: a leaf, while the other tree goes on.
#[derive(Copy, Clone)]
pub(crate) struct Same(pub(crate) usize);

impl Spread for Outer {
    #[inline(always)]
    fn spread(self, &[a, b]: &Lanes) -> f32x4 {
        f32x4::new([a, a, b, b])
    }
}

impl Spread for Inner {
    #[inline(always)]
    fn spread(self, &[a, b]: &Lanes) -> f32x4 {
        f32x4::new([a, b, a, b])
    }
}

impl Spread for Same {
    #[inline(always)]
    fn spread(self, lanes: &Lanes) -> f32x4 {
        f32x4::splat(lanes[self.0])
    }
}

impl<const AXES: usize> PairFrame<AXES> {
    /// Bit k: lane k's boxes come within the margin on the six face axes of both.
    ///
    /// The nine edge axes are left out: in the measurements the tests that they save cost less than they do.
    #[inline(always)]
    pub(super) fn boxes_meet(
        &self,
        (children1, spread1): (&Children<'_, AXES>, impl Spread),
        (children2, spread2): (&Children<'_, AXES>, impl Spread),
    ) -> u32 {
        let centre1 = each(|axis| spread1.spread(&children1.centre[axis]));
        let extent1 = each(|axis| spread1.spread(&children1.extent[axis]));
        let centre2 = each(|axis| spread2.spread(&children2.centre[axis]));
        let extent2 = each(|axis| spread2.spread(&children2.extent[axis]));

        // Between the centres, in frame 1.
        let mut offset = self.translation_lanes;
        let mut meets = f32x4::splat(f32::from_bits(u32::MAX));
        for axis in 0..3 {
            offset[axis] += dot(&self.axes1.rows[axis], &centre2);
            offset[axis] -= centre1[axis];
            let reach =
                extent1[axis] + dot(&self.axes1.absolute_rows[axis], &extent2) + self.axes1.margin;
            meets &= offset[axis].abs().simd_le(reach);
        }
        if meets.to_bitmask() == 0 {
            return 0;
        }
        for axis in 0..3 {
            let gap = dot(&self.axes2.rows[axis], &offset);
            let reach =
                extent2[axis] + dot(&self.axes2.absolute_rows[axis], &extent1) + self.axes2.margin;
            meets &= gap.abs().simd_le(reach);
        }
        meets.to_bitmask()
    }
}

impl<const AXES: usize> Correspondence<AXES> {
    /// Bit k: bit k of `candidates`, and lane k's k-DOPs come within the margin along the slabs of tree 1.
    ///
    /// Testing the slabs of tree 2 as well prunes a tenth more nodes and costs more than that saves. So do the slabs along x, y
    /// and z, which the boxes have been compared along: without them a descent takes a seventh fewer instructions.
    #[inline(always)]
    pub(super) fn kdops_meet(
        &self,
        side1: (KdopLanes<'_, AXES>, impl Spread),
        side2: (KdopLanes<'_, AXES>, impl Spread),
        candidates: u32,
    ) -> u32 {
        let mut remaining = candidates;
        for (axis, slab) in self.slabs.iter().enumerate().skip(3) {
            let (offset, reach) = slab.offset_and_reach(axis, slab.margin, side1, side2);
            remaining &= offset.abs().simd_le(reach).to_bitmask();
            if remaining == 0 {
                break;
            }
        }
        remaining
    }
}

#[inline(always)]
pub(super) fn dot(row: &[f32x4; 3], v: &[f32x4; 3]) -> f32x4 {
    row[0] * v[0] + row[1] * v[1] + row[2] * v[2]
}
