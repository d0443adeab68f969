//! How far apart up to four pairs of nodes are at least: all four over SIMD lanes.
//!
//! The tests are those of `overlap.rs`, asked for a number. Two boxes that are apart by `gᵢ` along the face axes of
//! one of them are `√Σ gᵢ²` apart at least; k-DOPs that are `g` apart along a slab direction `d`, `g/|d|`. The largest
//! of these bounds holds. If no axis separates the volumes, the largest (negative) gap bounds how deep triangles
//! below them cross: the least translation of two triangles is no longer than their overlap along any axis, and that
//! no longer than the overlap of their volumes.
//!
//! The slabs pay more here than in the overlap test: without them distances took 1.1 to 1.6 times as long on heads of 288
//! and 968 triangles, intersection tests up to 1.9 times.
//!
//! # Rounding
//!
//! Gaps along axes are too small by the margin of [`PairFrame`], never too large. What follows (the subtraction, a
//! norm of three squares, the length of a direction, the scale of the pose) loses at most `γ_8` of the result. A norm
//! that overflows is above the square root of `f32::MAX`, one that underflows is taken as less than it is.

use wide::f32x4;

use super::expand::Compare;
use super::frame::{BoxAxes, PairFrame};
use super::overlap::{Spread, dot};
use crate::leaf::lane::each;
use crate::tree::{Children, Lanes};
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

/// Lower bounds of the signed distances of up to four pairs of nodes: negative where their volumes overlap.
///
/// Needs a frame whose margin is zero.
pub(crate) struct SignedGaps<'a, const AXES: usize> {
    pub(crate) frame: &'a mut PairFrame<AXES>,
    /// Pairs farther apart than this do not matter.
    pub(crate) limit: f32,
    pub(crate) counts: GapCounts,
}

/// The work of a search.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct GapCounts {
    /// Pairs of nodes whose distance was bounded.
    pub node_pairs: u64,
    /// Pairs of leaves whose triangles were compared.
    pub leaf_pairs: u64,
    /// Pairs of triangles whose contact was computed.
    pub triangle_pairs: u64,
}

/// Bounds along axes, combined.
#[derive(Copy, Clone)]
struct Bound {
    /// The largest gap along an axis.
    along: f32x4,
    /// The largest norm of positive gaps.
    norm: f32x4,
}

impl Bound {
    /// Along the three axes of a box, of which a unit is `scale` long.
    #[inline(always)]
    fn of_axes(gaps: [f32x4; 3], scale: f32x4) -> Self {
        let [a, b, c] = each(|axis| gaps[axis].fast_max(f32x4::ZERO));
        let squares = (a * a + b * b + c * c).fast_min(f32x4::splat(f32::MAX));
        let along = gaps[0].fast_max(gaps[1]).fast_max(gaps[2]);
        Self { along: along * scale, norm: squares.sqrt() * scale }
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self { along: self.along.fast_max(other.along), norm: self.norm.fast_max(other.norm) }
    }

    /// Less than the signed distance, in spite of rounding. Lanes that are NaN stay so.
    #[inline(always)]
    fn signed(self) -> f32x4 {
        let apart = self.along.simd_gt(f32x4::ZERO);
        let farther = self.norm.fast_max(self.along) * f32x4::splat(1.0 - gamma(8));
        let deeper = self.along * f32x4::splat(1.0 + gamma(8));
        apart.bitselect(farther, deeper)
    }
}

impl<const AXES: usize> SignedGaps<'_, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// One over the lengths of the slab directions.
    const INVERSE_LENGTHS: [f32; AXES] = inverse_lengths(&Directions::<AXES>::DIRECTIONS);

    /// The bounds of all four lanes.
    #[inline(always)]
    pub(crate) fn signed(
        &mut self,
        side1: (&Children<'_, AXES>, impl Spread),
        side2: (&Children<'_, AXES>, impl Spread),
    ) -> f32x4 {
        let bound = self.frame.signed_box_gaps(side1, side2);
        let (Some(kdops1), Some(kdops2)) = (side1.0.kdop, side2.0.kdop) else {
            return bound.signed();
        };
        bound.or(self.kdop_gaps((kdops1, side1.1), (kdops2, side2.1))).signed()
    }

    /// Where the centres of the boxes of tree 2 are, seen from those of tree 1, and how far both boxes reach together:
    /// along the axes of frame 1.
    #[inline(always)]
    pub(crate) fn offset_and_reach(
        &self,
        (children1, spread1): (&Children<'_, AXES>, impl Spread),
        (children2, spread2): (&Children<'_, AXES>, impl Spread),
    ) -> ([f32x4; 3], [f32x4; 3]) {
        let (frame, axes) = (&self.frame, &self.frame.axes1);
        let centre2 = each(|axis| spread2.spread(&children2.centre[axis]));
        let extent2 = each(|axis| spread2.spread(&children2.extent[axis]));
        let offset = each(|axis| {
            let moved = frame.translation_lanes[axis] + dot(&axes.rows[axis], &centre2);
            moved - spread1.spread(&children1.centre[axis])
        });
        let reach = each(|axis| {
            let extent1 = spread1.spread(&children1.extent[axis]);
            extent1 + dot(&axes.absolute_rows[axis], &extent2) + axes.margin
        });
        (offset, reach)
    }

    /// Along the slabs of tree 1 beyond the box's.
    #[inline(always)]
    fn kdop_gaps(
        &mut self,
        (kdops1, spread1): ((&[Lanes; AXES], &[Lanes; AXES]), impl Spread),
        (kdops2, spread2): ((&[Lanes; AXES], &[Lanes; AXES]), impl Spread),
    ) -> Bound {
        let mut along = f32x4::splat(f32::NEG_INFINITY);
        for (axis, slab) in self.frame.correspondence().slabs.iter().enumerate() {
            let mut gap = f32x4::splat(slab.offset) - spread1.spread(&kdops1.0[axis]);
            let mut reach = f32x4::splat(slab.margin) + spread1.spread(&kdops1.1[axis]);
            for term in 0..3 {
                let index = usize::from(slab.indices[term]);
                let coefficient = f32x4::splat(slab.coefficients[term]);
                gap += coefficient * spread2.spread(&kdops2.0[index]);
                reach += coefficient.abs() * spread2.spread(&kdops2.1[index]);
            }
            let gap = (gap.abs() - reach) * f32x4::splat(Self::INVERSE_LENGTHS[axis]);
            along = along.fast_max(gap);
        }
        Bound { along, norm: along }
    }
}

impl<const AXES: usize> PairFrame<AXES> {
    /// Along the six face axes of boxes.
    #[inline(always)]
    fn signed_box_gaps(
        &self,
        (children1, spread1): (&Children<'_, AXES>, impl Spread),
        (children2, spread2): (&Children<'_, AXES>, impl Spread),
    ) -> Bound {
        let centre1 = each(|axis| spread1.spread(&children1.centre[axis]));
        let extent1 = each(|axis| spread1.spread(&children1.extent[axis]));
        let centre2 = each(|axis| spread2.spread(&children2.centre[axis]));
        let extent2 = each(|axis| spread2.spread(&children2.extent[axis]));

        let moved =
            each(|axis| self.translation_lanes[axis] + dot(&self.axes1.rows[axis], &centre2));
        let offset = each(|axis| moved[axis] - centre1[axis]);
        let gaps = |axes: &BoxAxes, offset: [f32x4; 3], own: [f32x4; 3], other: [f32x4; 3]| {
            each(|axis| {
                let reach = own[axis] + dot(&axes.absolute_rows[axis], &other) + axes.margin;
                offset[axis].abs() - reach
            })
        };
        let turned = each(|axis| dot(&self.axes2.rows[axis], &offset));
        let in_frame1 = gaps(&self.axes1, offset, extent1, extent2);
        let in_frame2 = gaps(&self.axes2, turned, extent2, extent1);
        let scale2 = f32x4::splat(self.placement.rotation.x_axis.length() as f32);
        Bound::of_axes(in_frame1, f32x4::ONE).or(Bound::of_axes(in_frame2, scale2))
    }
}

impl<const AXES: usize> Compare<AXES> for SignedGaps<'_, AXES>
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
        self.counts.node_pairs += u64::from(lanes.count_ones());
        let gaps = self.signed(side1, side2);
        // A gap that overflowed to NaN is kept.
        let far = gaps.simd_gt(f32x4::splat(self.limit)).to_bitmask();
        (lanes & !far, gaps.to_array())
    }
}

const fn inverse_lengths<const AXES: usize>(directions: &[glamx::Vec3; AXES]) -> [f32; AXES] {
    // Rounded once, of the lengths 1, √2 and √3.
    const INVERSE_ROOTS: [f32; 4] = [0.0, 1.0, std::f32::consts::FRAC_1_SQRT_2, 0.577_350_26];
    let mut lengths = [0.0; AXES];
    let mut axis = 0;
    while axis < AXES {
        let d = directions[axis];
        lengths[axis] = INVERSE_ROOTS[(d.x * d.x + d.y * d.y + d.z * d.z) as usize];
        axis += 1;
    }
    lengths
}
