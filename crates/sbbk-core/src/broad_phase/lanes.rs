//! Eight boxes or spheres side by side, and the pair test of one against all eight.

use wide::f32x8;

use super::bounds::{ABSOLUTE_SLACK, Aabb, RELATIVE_SLACK, Reach};

/// Boxes or spheres tested at once.
pub(super) const LANE_COUNT: usize = 8;

/// One float a lane.
pub(super) type Lanes = f32x8;

/// One bit a lane.
pub(super) type LaneMask = u8;

/// The lanes whose bit is set, lowest first.
#[inline]
pub(super) fn lanes_of(mut mask: LaneMask) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < LANE_COUNT).then_some(lane)
    })
}

/// Eight boxes, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxLanes {
    min: [Lanes; 3],
    max: [Lanes; 3],
}

impl BoxLanes {
    /// Eight boxes that contain nothing and overlap nothing.
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
        Aabb {
            min: [0, 1, 2].map(|axis| self.min[axis].as_array()[lane]),
            max: [0, 1, 2].map(|axis| self.max[axis].as_array()[lane]),
        }
    }

    /// The box around all eight.
    #[inline]
    pub(super) fn union(&self) -> Aabb {
        let smaller = |a: f32, &b: &f32| if b < a { b } else { a };
        let larger = |a: f32, &b: &f32| if b > a { b } else { a };
        Aabb {
            min: self.min.map(|lanes| lanes.as_array().iter().fold(f32::INFINITY, smaller)),
            max: self.max.map(|lanes| lanes.as_array().iter().fold(f32::NEG_INFINITY, larger)),
        }
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

    /// For each box the sum of its sides; 0 for an empty box.
    pub(super) fn side_sums(&self) -> Lanes {
        (0..3)
            .map(|axis| (self.max[axis] - self.min[axis]).fast_max(Lanes::ZERO))
            .fold(Lanes::ZERO, |sum, side| sum + side)
    }
}

/// Eight spheres, coordinate by coordinate; what an unused lane holds does not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereLanes {
    centre: [Lanes; 3],
    radius: Lanes,
}

impl SphereLanes {
    pub(super) const ZERO: Self = Self { centre: [Lanes::ZERO; 3], radius: Lanes::ZERO };

    #[inline]
    pub(super) fn set(&mut self, lane: usize, reach: &Reach) {
        for axis in 0..3 {
            self.centre[axis].as_mut_array()[lane] = reach.centre[axis];
        }
        self.radius.as_mut_array()[lane] = reach.radius;
    }

    /// The lanes that overlap the sphere in `lane` of `other`: [`Reach::overlaps`], lane by lane.
    #[inline]
    pub(super) fn overlaps(&self, other: &Self, lane: usize) -> LaneMask {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| self.centre[axis] - Lanes::splat(other.centre[axis].as_array()[lane]));
        let reach = self.radius + Lanes::splat(other.radius.as_array()[lane]);
        let limit = reach * reach * Lanes::splat(RELATIVE_SLACK) + Lanes::splat(ABSOLUTE_SLACK);
        (x * x + y * y + z * z).simd_le(limit).to_bitmask() as LaneMask
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broad_phase::bounds::Bounds;
    use glamx::Vec3;

    /// Two spheres whose gap is within a few units in the last place of the margin.
    fn nearly_touching(step: u32, scale: f32) -> [Reach; 2] {
        let direction = Vec3::new(0.48, -0.6, 0.64);
        let distance = f32::from_bits((3.5 * scale).to_bits() - 20 + step);
        [(0.0, 1.0), (distance, 2.0)].map(|(along, radius)| {
            let centre = along * direction + Vec3::splat(0.3 * scale);
            let bounds = Bounds {
                centre,
                radius: radius * scale,
                min: Vec3::splat(-1e30),
                max: Vec3::splat(1e30),
            };
            Reach::new(&bounds, 0.5 * scale)
        })
    }

    /// Catches a sphere test over lanes that rounds differently from the scalar one, for example
    /// by fused operations.
    #[test]
    fn sphere_lanes_agree_with_the_scalar_test_to_the_last_bit() {
        let mut outcomes = [0, 0];
        for (step, scale) in (0..60).flat_map(|step| [1e-3, 1.0, 77.7].map(|s| (step, s))) {
            let [one, other] = nearly_touching(step, scale);
            let mut lanes = [SphereLanes::ZERO; 2];
            lanes[0].set(5, &one);
            (0..LANE_COUNT).for_each(|lane| lanes[1].set(lane, &other));
            let expected = one.overlaps(&other);
            let mask = lanes[1].overlaps(&lanes[0], 5);
            assert_eq!(mask, if expected { LaneMask::MAX } else { 0 });
            outcomes[usize::from(expected)] += 1;
        }
        assert!(outcomes.iter().all(|&count| count > 20), "{outcomes:?}");
    }

    /// Catches strict instead of inclusive comparisons, swapped axes, and empty lanes that
    /// overlap something.
    #[test]
    fn box_lanes_touch_inclusively_on_each_axis() {
        let unit = Aabb { min: [0.0; 3], max: [1.0; 3] };
        for axis in 0..3 {
            let mut lanes = BoxLanes::EMPTY;
            for lane in 1..LANE_COUNT {
                let mut aabb = unit;
                // One below, touching below, overlapping three times, touching above, one above.
                let offset = [0.0, -1.25, -1.0, -0.5, 0.0, 0.5, 1.0, 1.25][lane];
                aabb.min[axis] += offset;
                aabb.max[axis] += offset;
                lanes.set(lane, &aabb);
            }
            assert_eq!(lanes.overlaps(&unit), 0b0111_1100);
            let everything = Aabb { min: [f32::MIN; 3], max: [f32::INFINITY; 3] };
            assert_eq!(lanes.overlaps(&everything), 0b1111_1110);
            assert_eq!(lanes.overlaps(&Aabb::EMPTY), 0);
        }
    }

    /// Catches an empty lane that spoils the box of its group.
    #[test]
    fn union_ignores_empty_lanes() {
        let mut lanes = BoxLanes::EMPTY;
        assert_eq!(lanes.union(), Aabb::EMPTY);
        for lane in [2, 6] {
            let corner = lane as f32;
            let aabb = Aabb { min: [corner, -corner, 0.0], max: [corner + 1.0, 0.0, corner] };
            lanes.set(lane, &aabb);
            assert_eq!(lanes.lane(lane), aabb);
        }
        assert_eq!(lanes.union(), Aabb { min: [2.0, -6.0, 0.0], max: [7.0, 0.0, 6.0] });
    }
}
