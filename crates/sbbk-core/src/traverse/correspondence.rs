use wide::f32x4;

use super::placement::Placement;
use super::side::KdopLanes;
use crate::simd::{Spread, each};
use crate::volumes::{SLABS, directions};

/// Bounds each slab direction of tree 1 by three adjacent slabs of tree 2: see
/// [`directions`].
///
/// Let `b` be the direction in frame 2 and `o = d·t`. The projection of a node of tree 2 has the
/// centre `o + Σ cᵢ·centreᵢ` and the half-length `Σ |cᵢ|·extentᵢ`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Correspondence {
    slabs: [Slab; SLABS],
    /// Rounding of a comparison of slabs.
    rounding: f32,
}

/// `1/|d|` of each slab direction, rounded down.
const INVERSE_LENGTHS: [f32; SLABS] = {
    let mut inverse = [std::f32::consts::FRAC_1_SQRT_2; SLABS];
    (inverse[0], inverse[1], inverse[2]) = (1.0, 1.0, 1.0);
    inverse
};

/// Scalars, spread over lanes by each test: a query computes these once and may test few nodes.
#[derive(Copy, Clone, Debug)]
struct Slab {
    offset: f32,
    coefficients: [f32; 3],
    indices: [u8; 3],
    /// The margin times the length of the direction, plus the rounding.
    slack: f32,
}

impl Correspondence {
    /// `rounding` is the bound for boxes in frame 1. Slabs lose up to six times as much, see
    /// [`rounding`](crate::volumes::rounding).
    pub(super) fn new(placement: &Placement, margin: f32, rounding: f32) -> Self {
        let to_frame2 = placement.rotation.transpose();
        let axes = [to_frame2.x_axis, to_frame2.y_axis, to_frame2.z_axis];
        let seen = directions::project(axes);
        let offsets = directions::project(placement.translation.to_array());
        let directions = directions::DIRECTIONS;
        let rounding = 6.0 * rounding;
        let slabs = std::array::from_fn(|axis| {
            let terms = directions::correspondence(seen[axis]);
            let length = directions[axis].as_dvec3().length();
            let slack = f64::from(margin) * length + f64::from(rounding);
            Slab {
                offset: offsets[axis] as f32,
                coefficients: each(|i| terms[i].1 as f32),
                indices: each(|i| terms[i].0 as u8),
                slack: (slack as f32).next_up(),
            }
        });
        Self { slabs, rounding }
    }

    /// Bit k: bit k of `candidates`, and lane k's k-DOPs come within the margin along the slabs of
    /// tree 1.
    ///
    /// The slabs of tree 2 cost more than they save. The slabs along x, y and z repeat the test of
    /// the boxes.
    #[inline(always)]
    pub(super) fn kdops_meet(
        &self,
        kdops: &KdopLanes<'_, impl Spread, impl Spread>,
        candidates: u32,
    ) -> u32 {
        let mut remaining = candidates;
        for (axis, slab) in self.slabs.iter().enumerate().skip(3) {
            let [offset, reach] = slab.along(axis, slab.slack, kdops);
            remaining &= offset.abs().simd_le(reach).to_bitmask();
            if remaining == 0 {
                break;
            }
        }
        remaining
    }

    /// A lower bound of the largest gap between k-DOPs along the slabs of tree 1 from `first` on,
    /// up to the `γ_8` of `gaps.rs`. Negative if they overlap on all.
    #[inline(always)]
    pub(super) fn gaps(
        &self,
        kdops: &KdopLanes<'_, impl Spread, impl Spread>,
        first: usize,
    ) -> f32x4 {
        let mut largest = f32x4::splat(f32::NEG_INFINITY);
        for (axis, slab) in self.slabs.iter().enumerate().skip(first) {
            let [offset, reach] = slab.along(axis, self.rounding, kdops);
            let gap = (offset.abs() - reach) * f32x4::splat(INVERSE_LENGTHS[axis]);
            largest = largest.fast_max(gap);
        }
        largest
    }
}

impl Slab {
    /// Compares the k-DOPs in each lane along slab `axis` of tree 1. Returns the way from centre 1
    /// to centre 2, and the sum of both half-lengths and `slack`.
    #[inline(always)]
    fn along(
        &self,
        axis: usize,
        slack: f32,
        kdops: &KdopLanes<'_, impl Spread, impl Spread>,
    ) -> [f32x4; 2] {
        let mut offset = f32x4::splat(self.offset) - kdops.one.centre(axis);
        let mut reach = f32x4::splat(slack) + kdops.one.extent(axis);
        for term in 0..3 {
            let index = usize::from(self.indices[term]);
            let coefficient = f32x4::splat(self.coefficients[term]);
            offset += coefficient * kdops.two.centre(index);
            reach += coefficient.abs() * kdops.two.extent(index);
        }
        [offset, reach]
    }
}
