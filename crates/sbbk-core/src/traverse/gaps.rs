//! Lower bounds of the signed distance of up to four pairs of nodes.
//!
//! Two boxes with gaps `gᵢ` along the face axes of one of them are at least `√Σ gᵢ²` apart. k-DOPs
//! with a gap `g` along a slab direction `d` are at least `g/|d|` apart. The largest of these
//! bounds holds.
//!
//! If no axis separates the volumes, the largest (negative) gap bounds the depth of triangles below
//! them. The least translation that parts two triangles is no longer than their overlap along any
//! axis, which is no longer than the overlap of their volumes.
//!
//! Slabs save more here than in the overlap test. The slabs along x, y and z repeat the boxes.
//!
//! Gaps along axes are conservative by the rounding of [`PairFrame`]. Later operations lose at most
//! `γ_8` of the result. A norm that overflows is above the square root of `f32::MAX`, and one that
//! underflows is too small, which is safe.

use wide::f32x4;

use super::frame::PairFrame;
use super::side::NodeLanes;
use crate::simd::{Spread, V3, dot, each, largest};
use crate::volumes::rounding::gamma;

/// Combined bounds along axes.
#[derive(Copy, Clone)]
pub(super) struct Bound {
    /// The largest gap along an axis.
    along: f32x4,
    /// The largest norm of positive gaps.
    norm: f32x4,
}

impl Bound {
    /// The bound along the three axes of a box, with a unit of length `scale`.
    #[inline(always)]
    pub(super) fn of_axes(gaps: V3<f32x4>, scale: f32x4) -> Self {
        let apart = each(|axis| gaps[axis].fast_max(f32x4::ZERO));
        let squares = dot(apart, apart).fast_min(f32x4::splat(f32::MAX));
        Self { along: largest(gaps) * scale, norm: squares.sqrt() * scale }
    }

    /// The bound along slabs.
    #[inline(always)]
    fn of_slabs(along: f32x4) -> Self {
        Self { along, norm: along }
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self { along: self.along.fast_max(other.along), norm: self.norm.fast_max(other.norm) }
    }

    /// A lower bound of the signed distance that includes rounding. NaN stays NaN.
    #[inline(always)]
    pub(super) fn signed(self) -> f32x4 {
        let apart = self.along.simd_gt(f32x4::ZERO);
        let farther = self.norm.fast_max(self.along) * f32x4::splat(1.0 - gamma(8));
        let deeper = self.along * f32x4::splat(1.0 + gamma(8));
        apart.bitselect(farther, deeper)
    }
}

impl PairFrame {
    /// The bounds of all four lanes, for any margin.
    #[inline(always)]
    pub(crate) fn signed_gaps(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        let bound = self.box_bound(nodes);
        let of_slabs =
            nodes.kdops.as_ref().map(|kdops| Bound::of_slabs(self.correspondence().gaps(kdops, 3)));
        of_slabs.map_or(bound, |of_slabs| bound.or(of_slabs)).signed()
    }

    /// The bound along the six face axes of boxes.
    #[inline(always)]
    fn box_bound(&self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> Bound {
        let [rounding1, rounding2] = self.rounding.map(f32x4::splat);
        let in_frame1 = self.along1(nodes, rounding1);
        let in_frame2 = self.along2(nodes, in_frame1.offset, rounding2);
        let unit2 = f32x4::splat(self.placement.rotation.x_axis.length() as f32);
        Bound::of_axes(in_frame1.gaps(), f32x4::ONE).or(Bound::of_axes(in_frame2.gaps(), unit2))
    }
}
