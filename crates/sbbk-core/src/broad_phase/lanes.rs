//! Eight boxes in lanes, and the test of one against all eight.

use glamx::Vec3;
use wide::f32x8;

use crate::simd::each;
use crate::volumes::Aabb;

/// Number of boxes tested at once.
pub(super) const LANE_COUNT: usize = 8;

/// A float for each lane.
pub(super) type Lanes = f32x8;

/// A bit for each lane.
pub(super) type LaneMask = u8;

/// Eight boxes, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxLanes {
    min: [Lanes; 3],
    max: [Lanes; 3],
}

impl BoxLanes {
    /// Eight empty boxes, which overlap nothing.
    pub(super) const EMPTY: Self = Self {
        min: [Lanes::new([f32::INFINITY; LANE_COUNT]); 3],
        max: [Lanes::new([f32::NEG_INFINITY; LANE_COUNT]); 3],
    };

    #[inline]
    pub(super) fn set(&mut self, lane: usize, value: &Aabb) {
        for axis in 0..3 {
            self.min[axis].as_mut_array()[lane] = value.min[axis];
            self.max[axis].as_mut_array()[lane] = value.max[axis];
        }
    }

    #[inline]
    pub(super) fn lane(&self, lane: usize) -> Aabb {
        let corner = |ends: &[Lanes; 3]| Vec3::from_array(each(|axis| ends[axis].as_array()[lane]));
        Aabb { min: corner(&self.min), max: corner(&self.max) }
    }

    /// The box around all eight.
    #[inline]
    pub(super) fn union(&self) -> Aabb {
        let smaller = |a: f32, &b: &f32| if b < a { b } else { a };
        let larger = |a: f32, &b: &f32| if b > a { b } else { a };
        let min = self.min.map(|lanes| lanes.as_array().iter().fold(f32::INFINITY, smaller));
        let max = self.max.map(|lanes| lanes.as_array().iter().fold(f32::NEG_INFINITY, larger));
        Aabb { min: min.into(), max: max.into() }
    }

    /// The lanes that overlap `other`, touching included.
    #[inline]
    pub(super) fn overlaps(&self, other: &Aabb) -> LaneMask {
        let mut overlap = Lanes::splat(other.min[0]).simd_le(self.max[0])
            & self.min[0].simd_le(Lanes::splat(other.max[0]));
        for axis in 1..3 {
            overlap &= Lanes::splat(other.min[axis]).simd_le(self.max[axis])
                & self.min[axis].simd_le(Lanes::splat(other.max[axis]));
        }
        overlap.to_bitmask() as LaneMask
    }

    /// The sum of the sides of each box; 0 for an empty one.
    pub(super) fn side_sums(&self) -> Lanes {
        (0..3)
            .map(|axis| (self.max[axis] - self.min[axis]).fast_max(Lanes::ZERO))
            .fold(Lanes::ZERO, |sum, side| sum + side)
    }
}
