//! The earliest time at which pairs of moving nodes may come within a distance, over SIMD lanes.
//!
//! The later of two bounds counts. Boxes that move along a line overlap on each axis of frame 1
//! during an interval, and on all three during the intersection (the slabs of a ray against the
//! Minkowski sum). Volumes with a gap need at least the gap over the speed.
//!
//! # Rounding
//!
//! The offset and the reach come from [`PairFrame`], conservative by its rounding. The velocity is
//! exact in frame 1. A quotient loses at most `γ_4`, and the target distance added to the reach
//! `γ_2`. Intervals start earlier and end later by `γ_8`.

use glamx::Vec3;
use wide::f32x4;

use crate::simd::Spread;
use crate::traverse::{Along, Compare, NodeLanes, PairFrame, within};
use crate::volumes::rounding::gamma;

/// Lower bounds of times of impact.
pub(super) struct Sweep<'a> {
    pub(super) frame: &'a mut PairFrame,
    /// Velocity of mesh 2 against mesh 1, in frame 1.
    pub(super) velocity: Vec3,
    /// Lower bound of one over the length of the velocity; infinite for no velocity.
    pub(super) inverse_speed: f32,
    /// Upper bound of the distance that counts as an impact.
    pub(super) target: f32,
    /// Later impacts do not matter. Finite, or minus infinity.
    pub(super) limit: f32,
}

impl Sweep<'_> {
    /// The earliest times, infinite where the nodes pass each other.
    #[inline(always)]
    fn times(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        let target = f32x4::splat(self.target);
        let apart = self.frame.signed_gaps(nodes) - target;
        let mut start = (apart * f32x4::splat(self.inverse_speed)).fast_max(f32x4::ZERO);
        let mut end = f32x4::splat(f32::INFINITY);
        let rounding = f32x4::splat(self.frame.rounding[0]);
        let Along { offset, reach } = self.frame.along1(nodes, rounding);
        for axis in 0..3 {
            let speed = self.velocity[axis];
            let inverse = f32x4::splat(1.0 / speed.abs());
            let ahead = offset[axis] * f32x4::splat(1.0_f32.copysign(speed));
            let reach = reach[axis] + target;
            start = ((-reach - ahead) * inverse).fast_max(start);
            end = ((reach - ahead) * inverse).fast_min(end);
        }
        let start = start * f32x4::splat(1.0 - gamma(8));
        let passes = (end * f32x4::splat(1.0 + gamma(8))).simd_lt(start);
        passes.bitselect(f32x4::splat(f32::INFINITY), start)
    }
}

impl Compare for Sweep<'_> {
    type Key = f32;

    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        let times = self.times(nodes);
        within(self.limit, times, nodes.lanes)
    }
}
