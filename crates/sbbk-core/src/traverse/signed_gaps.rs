//! How far apart up to four pairs of nodes are at least: all four over SIMD lanes.
//!
//! The tests are those of `overlap.rs`, asked for a number. Two boxes that are apart by `gᵢ` along the face axes of
//! one of them are `√Σ gᵢ²` apart at least; k-DOPs that are `g` apart along a slab direction `d`, `g/|d|`. The largest
//! of these bounds holds. If no axis separates the volumes, the largest (negative) gap bounds how deep triangles
//! below them cross: the least translation of two triangles is no longer than their overlap along any axis, and that
//! no longer than the overlap of their volumes.
//!
//! The slabs pay more here than in the overlap test: without them distances took 1.1 to 1.6 times as long on heads of 288
//! and 968 triangles, intersection tests up to 1.9 times. Not so those along x, y and z, which the boxes have been compared along:
//! with them distances take up to a sixth longer. To stop at the first axis that shows all lanes to be beyond the limit costs 5 in 100:
//! only the direction of [`Toward`] is worth that.
//!
//! # Rounding
//!
//! Gaps along axes are too small by the margin of [`PairFrame`], never too large. What follows (the subtraction, a
//! norm of three squares, the length of a direction, the scale of the pose) loses at most `γ_8` of the result. A norm
//! that overflows is above the square root of `f32::MAX`, one that underflows is taken as less than it is.

use wide::f32x4;

use super::correspondence::{Correspondence, KdopLanes, inverse_lengths};
use super::expand::Compare;
use super::frame::PairFrame;
use super::overlap::{Spread, dot};
use super::toward::Toward;
use crate::leaf::lane::each;
use crate::tree::Children;
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

/// Lower bounds of the signed distances of up to four pairs of nodes: negative where their volumes overlap.
///
/// Needs a frame whose margin is zero.
pub(crate) struct SignedGaps<'a, const AXES: usize> {
    pub(crate) frame: &'a mut PairFrame<AXES>,
    pub(crate) cutoff: Cutoff,
    /// Looked along before all else.
    pub(crate) toward: Option<Toward>,
}

/// What bounds are compared with. Whatever they bound, pairs of nodes beyond it do not matter.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Cutoff {
    pub(crate) limit: f32,
    pub(crate) counts: GapCounts,
}

impl Cutoff {
    /// Nothing done yet.
    pub(crate) fn at(limit: f32) -> Self {
        Self { limit, counts: GapCounts::default() }
    }

    /// Whether all of `lanes` are beyond the limit.
    #[inline(always)]
    fn is_beyond(&self, bounds: f32x4, lanes: u32) -> bool {
        bounds.simd_gt(f32x4::splat(self.limit)).to_bitmask() & lanes == lanes
    }

    /// The lanes of `lanes` that are within the limit, and the bounds. A bound that overflowed to NaN is kept: it bounds
    /// nothing.
    #[inline(always)]
    pub(crate) fn keep(&mut self, bounds: f32x4, lanes: u32) -> (u32, [f32; 4]) {
        self.counts.node_pairs += u64::from(lanes.count_ones());
        let beyond = bounds.simd_gt(f32x4::splat(self.limit)).to_bitmask();
        (lanes & !beyond, bounds.to_array())
    }
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

/// The nodes of one side and how they lie over the lanes.
type Side<'a, 'b, const AXES: usize, S> = (&'a Children<'b, AXES>, S);

impl<const AXES: usize> PairFrame<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// The bounds of all four lanes. Needs a margin of zero.
    #[inline(always)]
    pub(crate) fn signed_gaps(
        &mut self,
        side1: Side<'_, '_, AXES, impl Spread>,
        side2: Side<'_, '_, AXES, impl Spread>,
    ) -> f32x4 {
        let bound = self.signed_box_gaps(side1, side2);
        let (Some(kdops1), Some(kdops2)) = (side1.0.kdop, side2.0.kdop) else {
            return bound.signed();
        };
        let slabs = self.correspondence().signed_gaps((kdops1, side1.1), (kdops2, side2.1));
        bound.or(slabs).signed()
    }
}

impl<const AXES: usize> PairFrame<AXES> {
    /// Along the six face axes of boxes.
    #[inline(always)]
    fn signed_box_gaps(
        &self,
        side1: Side<'_, '_, AXES, impl Spread>,
        side2: Side<'_, '_, AXES, impl Spread>,
    ) -> Bound {
        let (offset, reach) = self.offset_and_reach(side1, side2);
        let turned = each(|axis| dot(&self.axes2.rows[axis], &offset));
        let extent1 = each(|axis| side1.1.spread(&side1.0.extent[axis]));
        let in_frame1 = each(|axis| offset[axis].abs() - reach[axis]);
        let in_frame2 = each(|axis| {
            let extent2 = side2.1.spread(&side2.0.extent[axis]);
            let across = dot(&self.axes2.absolute_rows[axis], &extent1);
            turned[axis].abs() - (extent2 + across + self.axes2.margin)
        });
        let scale2 = f32x4::splat(self.placement.rotation.x_axis.length() as f32);
        Bound::of_axes(in_frame1, f32x4::ONE).or(Bound::of_axes(in_frame2, scale2))
    }

    /// Where the centres of the boxes of tree 2 are, seen from those of tree 1, and how far both boxes reach together:
    /// along the axes of frame 1.
    #[inline(always)]
    pub(crate) fn offset_and_reach(
        &self,
        (children1, spread1): Side<'_, '_, AXES, impl Spread>,
        (children2, spread2): Side<'_, '_, AXES, impl Spread>,
    ) -> ([f32x4; 3], [f32x4; 3]) {
        let axes = &self.axes1;
        let centre2 = each(|axis| spread2.spread(&children2.centre[axis]));
        let extent2 = each(|axis| spread2.spread(&children2.extent[axis]));
        let offset = each(|axis| {
            let moved = self.translation_lanes[axis] + dot(&axes.rows[axis], &centre2);
            moved - spread1.spread(&children1.centre[axis])
        });
        let reach = each(|axis| {
            let extent1 = spread1.spread(&children1.extent[axis]);
            extent1 + dot(&axes.absolute_rows[axis], &extent2) + axes.margin
        });
        (offset, reach)
    }
}

impl<const AXES: usize> Correspondence<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// Along the slabs of tree 1 beyond those of the boxes.
    #[inline(always)]
    fn signed_gaps(
        &self,
        side1: (KdopLanes<'_, AXES>, impl Spread),
        side2: (KdopLanes<'_, AXES>, impl Spread),
    ) -> Bound {
        let inverse_lengths =
            const { inverse_lengths(&<Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS) };
        let mut along = f32x4::splat(f32::NEG_INFINITY);
        for (axis, slab) in self.slabs.iter().enumerate().skip(3) {
            let (offset, reach) = slab.offset_and_reach(axis, slab.margin, side1, side2);
            let gap = (offset.abs() - reach) * f32x4::splat(inverse_lengths[axis]);
            along = along.fast_max(gap);
        }
        Bound { along, norm: along }
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
        side1: Side<'_, '_, AXES, impl Spread>,
        side2: Side<'_, '_, AXES, impl Spread>,
        lanes: u32,
    ) -> (u32, [f32; 4]) {
        let kdops = side1.0.kdop.zip(side2.0.kdop);
        let along = match (&self.toward, kdops) {
            (Some(toward), Some(kdops)) => toward.gaps((kdops.0, side1.1), (kdops.1, side2.1)),
            _ => f32x4::splat(f32::NEG_INFINITY),
        };
        // Mostly it is enough.
        if self.cutoff.is_beyond(along, lanes) {
            return self.cutoff.keep(along, lanes);
        }
        let gaps = self.frame.signed_gaps(side1, side2).fast_max(along);
        self.cutoff.keep(gaps, lanes)
    }
}
