//! How far apart four pairs of nodes are at least: the overlap test of [`overlap`](super::overlap) with the number
//! instead of the answer.
//!
//! A gap is a lower bound of the distance, in frame 1 and without the margin, between whatever is in two volumes: the
//! largest distance of their projections on an axis, negative where they meet on all. (Three face axes at right angles
//! also bound the distance by the root of the sum of squares. That was tried: not one test in a thousand fewer.)
//!
//! # Rounding
//!
//! With the bound of [`PairFrame`], `r = γ_16·(M1 + T + 2·s·M2)`: that bound includes the addition of a margin, here of
//! `r` itself. New are the difference of offset and reach, and the product with a length: two roundings of something
//! that is at most `2·(M1 + T + 1.8·s·M2)`, less than `γ_4` of the sum in `r`. A gap is reduced by `21/16·r`, which is
//! more than `γ_20` of it.

use wide::f32x4;

use super::correspondence::{Correspondence, KdopLanes, inverse_lengths};
use super::frame::PairFrame;
use super::overlap::{Spread, dot};
use crate::leaf::lane::each;
use crate::tree::Children;
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

/// The bound of the gaps over that of the overlap test.
const ROUNDING: f32 = 21.0 / 16.0;

/// What gaps need of a pair of trees beyond [`PairFrame`].
#[derive(Copy, Clone, Debug)]
pub(crate) struct GapFrame {
    rounding1: f32x4,
    rounding2: f32x4,
    /// A unit of frame 2 in frame 1, rounded down.
    unit2: f32x4,
    /// Of the slabs.
    slab_rounding: f32,
}

impl GapFrame {
    pub(crate) fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        let inverse = &frame.placement.inverse;
        let scale = [0, 1, 2].map(|i| inverse.row(i).length()).into_iter().fold(0.0, f64::max);
        Self {
            rounding1: f32x4::splat(ROUNDING * frame.rounding),
            rounding2: f32x4::splat(ROUNDING * frame.rounding2),
            unit2: f32x4::splat((1.0 / scale) as f32 * (1.0 - gamma(2))),
            slab_rounding: 6.0 * ROUNDING * frame.rounding,
        }
    }
}

/// Gaps lane by lane.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Gaps {
    pub(crate) gaps: f32x4,
    /// Lanes that were compared by k-DOPs.
    pub(crate) kdop_lanes: u32,
}

/// One side of four pairs: the nodes and how they lie over the lanes.
pub(crate) type Side<'a, 'b, const AXES: usize, S> = (&'a Children<'b, AXES>, S);

impl<const AXES: usize> PairFrame<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// The gaps of the pairs in `lanes`. Once all of them are beyond the margin, no further slab is asked: they could
    /// only be larger. Asking all saves 1 test in 50 later, and takes longer.
    #[inline(always)]
    pub(crate) fn gaps(
        &mut self,
        with: &GapFrame,
        side1: Side<'_, '_, AXES, impl Spread>,
        side2: Side<'_, '_, AXES, impl Spread>,
        lanes: u32,
    ) -> Gaps {
        let margin = f32x4::splat(self.margin());
        let mut gaps = self.box_gaps(with, side1, side2);
        let meeting = !gaps.simd_gt(margin).to_bitmask() & lanes;
        let mut kdop_lanes = 0;
        if let (Some(kdops1), Some(kdops2)) = (side1.0.kdop, side2.0.kdop)
            && meeting != 0
        {
            kdop_lanes = meeting;
            let sides = ((kdops1, side1.1), (kdops2, side2.1));
            for axis in 0..AXES {
                let gap = self.correspondence().slab_gap(with, axis, sides.0, sides.1);
                gaps = gaps.fast_max(gap);
                if !gaps.simd_gt(margin).to_bitmask() & lanes == 0 {
                    break;
                }
            }
        }
        Gaps { gaps, kdop_lanes }
    }

    #[inline(always)]
    fn box_gaps(
        &self,
        with: &GapFrame,
        side1: Side<'_, '_, AXES, impl Spread>,
        side2: Side<'_, '_, AXES, impl Spread>,
    ) -> f32x4 {
        let offset = each(|axis| self.offset(axis, side1, side2));
        let gaps1 = each(|axis| self.gap1(with, axis, offset[axis], side1, side2));
        let gaps2 = each(|axis| self.gap2(with, axis, &offset, side1, side2));
        let largest = |gaps: &[f32x4; 3]| gaps[0].fast_max(gaps[1]).fast_max(gaps[2]);
        largest(&gaps1).fast_max(largest(&gaps2))
    }

    /// Between the centres, along an axis of frame 1.
    #[inline(always)]
    fn offset(
        &self,
        axis: usize,
        (children1, spread1): Side<'_, '_, AXES, impl Spread>,
        (children2, spread2): Side<'_, '_, AXES, impl Spread>,
    ) -> f32x4 {
        let centre2 = each(|i| spread2.spread(&children2.centre[i]));
        self.translation_lanes[axis] + dot(&self.axes1.rows[axis], &centre2)
            - spread1.spread(&children1.centre[axis])
    }

    #[inline(always)]
    fn gap1(
        &self,
        with: &GapFrame,
        axis: usize,
        offset: f32x4,
        (children1, spread1): Side<'_, '_, AXES, impl Spread>,
        (children2, spread2): Side<'_, '_, AXES, impl Spread>,
    ) -> f32x4 {
        let extent2 = each(|i| spread2.spread(&children2.extent[i]));
        let reach = spread1.spread(&children1.extent[axis])
            + dot(&self.axes1.absolute_rows[axis], &extent2)
            + with.rounding1;
        offset.abs() - reach
    }

    #[inline(always)]
    fn gap2(
        &self,
        with: &GapFrame,
        axis: usize,
        offset: &[f32x4; 3],
        (children1, spread1): Side<'_, '_, AXES, impl Spread>,
        (children2, spread2): Side<'_, '_, AXES, impl Spread>,
    ) -> f32x4 {
        let extent1 = each(|i| spread1.spread(&children1.extent[i]));
        let reach = spread2.spread(&children2.extent[axis])
            + dot(&self.axes2.absolute_rows[axis], &extent1)
            + with.rounding2;
        (dot(&self.axes2.rows[axis], offset).abs() - reach) * with.unit2
    }
}

impl<const AXES: usize> Correspondence<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// Along a slab of tree 1, over its length. See [`Correspondence::new`] for the rounding.
    #[inline(always)]
    fn slab_gap(
        &self,
        with: &GapFrame,
        axis: usize,
        side1: (KdopLanes<'_, AXES>, impl Spread),
        side2: (KdopLanes<'_, AXES>, impl Spread),
    ) -> f32x4 {
        let (offset, reach) =
            self.slabs[axis].offset_and_reach(axis, with.slab_rounding, side1, side2);
        let inverse_lengths =
            const { inverse_lengths(&<Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS) };
        (offset.abs() - reach) * f32x4::splat(inverse_lengths[axis])
    }
}

#[cfg(test)]
mod tests {
    use glamx::{Pose3, Quat, Vec3};

    use super::*;
    use crate::traverse::noise::point;
    use crate::traverse::{Inner, Outer};
    use crate::tree::{BuildOptions, LayerPlan, Tree};

    /// Two triangles under their roots, and those of the other tree: no gap is more than the distance of
    /// the corners that it is between. Would catch a wrong sign, lane, length of a slab or unit, and a
    /// bound that is of no use.
    #[test]
    fn gaps_are_below_distances_and_not_far_below() {
        let mut tightest = 0.0f32;
        for i in 0..2000 {
            let plan = LayerPlan { sphere_root: true, kdop_from_depth: Some(1) };
            let options = BuildOptions { layers: plan, leaf_size: 1 };
            let triangles = [[0, 1, 2], [3, 4, 5]];
            let meshes = [20 * i, 20 * i + 6].map(|first| {
                let corner = |k: u32| 0.3 * point(first + k) + Vec3::X * (k / 3) as f32;
                [0, 1, 2, 3, 4, 5].map(corner)
            });
            let trees = meshes.map(|mesh| Tree::<9>::build(&mesh, &triangles, &options).unwrap());
            let scale = [1.0, 1.0, 0.9, 1.2][i as usize % 4];
            let turn = Quat::from_scaled_axis(6.0 * point(20 * i + 12)) * scale;
            let pos12 = Pose3::from_parts(4.0 * point(20 * i + 13) - Vec3::splat(2.0), turn);
            let mut frame = PairFrame::new(&trees[0], &trees[1], &pos12, 0.01);
            let with = GapFrame::new(&frame);
            let nodes = [0, 1].map(|tree| trees[tree].link(crate::tree::Slot::ROOT).index());
            let children = [0, 1].map(|tree| trees[tree].children(nodes[tree]));
            let sides = ((&children[0], Outer), (&children[1], Inner));
            let all = frame.gaps(&with, sides.0, sides.1, 0b1111).gaps.to_array();
            for lane in 0..4 {
                let leaf = |tree: usize, child: usize| {
                    trees[tree].leaf(children[tree].links[child].index()).corners(0)
                };
                let (one, two) = (leaf(0, lane >> 1), leaf(1, lane & 1));
                let distances = one
                    .iter()
                    .flat_map(|&x| two.map(|y| frame.placement().to_frame1(y, x).length() as f32));
                let distance = distances.fold(f32::INFINITY, f32::min);
                assert!(all[lane] <= distance, "{} {distance}", all[lane]);
                tightest = tightest.max(all[lane] / distance);
            }
        }
        assert!((0.95..=1.0).contains(&tightest), "{tightest}");
    }
}
