//! The overlap test of a descent with an order: which pairs of nodes meet, and which of them overlap most.

use wide::f32x4;

use super::expand::Compare;
use super::frame::PairFrame;
use super::overlap::{Spread, dot};
use crate::leaf::lane::each;
use crate::tree::Children;
use crate::volumes::{DirectionSet, Directions};

/// Keeps pairs of nodes whose volumes come within the margin. The key is minus the least overlap of the boxes along their face axes.
///
/// Of other keys (along the axes of one box, the sum of overlaps, the distance of the centres, all slabs as well) none found a pair
/// of crossing triangles in less time on about a thousand poses of heads, tori and helicopters, nor in much more.
pub(crate) struct OrderedOverlap<'a, const AXES: usize>(pub(crate) &'a mut PairFrame<AXES>);

impl<const AXES: usize> Compare<AXES> for OrderedOverlap<'_, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    type Key = f32;

    #[inline(always)]
    fn compare(
        &mut self,
        side1: (&Children<'_, AXES>, impl Spread),
        side2: (&Children<'_, AXES>, impl Spread),
        lanes: u32,
    ) -> (u32, [f32; 4]) {
        let frame = &mut *self.0;
        // A gap that overflowed to NaN is kept.
        let meets = |gap: f32x4| lanes & !gap.simd_gt(f32x4::ZERO).to_bitmask();
        let largest = |gaps: [f32x4; 3]| gaps[0].fast_max(gaps[1]).fast_max(gaps[2]);

        let (offset, reach) = frame.offset_and_reach(side1, side2);
        let in_frame1 = largest(each(|axis| offset[axis].abs() - reach[axis]));
        if meets(in_frame1) == 0 {
            return (0, [0.0; 4]);
        }
        let axes2 = &frame.axes2;
        let extent1 = each(|axis| side1.1.spread(&side1.0.extent[axis]));
        let in_frame2 = largest(each(|axis| {
            let extent2 = side2.1.spread(&side2.0.extent[axis]);
            let reach = extent2 + dot(&axes2.absolute_rows[axis], &extent1) + axes2.margin;
            dot(&axes2.rows[axis], &offset).abs() - reach
        }));
        let gap = in_frame1.fast_max(in_frame2);
        let meeting = meets(gap);
        let keys = gap.to_array();
        match side1.0.kdop.zip(side2.0.kdop) {
            Some((kdops1, kdops2)) if meeting != 0 => {
                let slabs = frame.correspondence();
                (slabs.kdops_meet((kdops1, side1.1), (kdops2, side2.1), meeting), keys)
            }
            _ => (meeting, keys),
        }
    }
}
