//! Bins of centroids for the surface area heuristic.

use glamx::{Vec3, Vec3A};

use super::node::BATCH;
use crate::volumes::Aabb;

/// Greatest number of bins. Higher: slightly better splits; lower: faster builds.
const MOST_BINS: usize = 16;
/// Least number of bins. Higher: slower builds of small nodes; lower: worse splits.
const LEAST_BINS: usize = 4;

/// A box in SIMD registers, as the build mostly merges boxes.
#[derive(Copy, Clone)]
pub(super) struct Bounds {
    pub(super) min: Vec3A,
    pub(super) max: Vec3A,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    #[inline]
    pub(super) fn of_corners([a, b, c]: [Vec3; 3]) -> Self {
        let [a, b, c] = [a, b, c].map(Vec3A::from);
        Self { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    #[inline]
    pub(super) fn merge(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    #[inline]
    pub(super) fn with_point(&self, point: Vec3A) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    #[inline]
    pub(super) fn centre(&self) -> Vec3A {
        0.5 * self.min + 0.5 * self.max
    }

    pub(super) fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }

    pub(super) fn longest_axis(&self) -> usize {
        Vec3::from(self.max - self.min).max_position()
    }

    #[inline]
    fn half_area(&self) -> f32 {
        let d = self.max - self.min;
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

/// Maps centroids to bins along one axis.
///
/// The bin is clamped, as the multiplication may round up to the number of bins. NaN casts to 0.
#[derive(Copy, Clone)]
pub(super) struct BinMapping {
    axis: usize,
    origin: f32,
    scale: f32,
    bin_count: usize,
}

impl BinMapping {
    /// A mapping of `count` triangles along the longest axis of their centroids. `None` if these
    /// are equal there.
    pub(super) fn new(centroids: &Bounds, count: usize) -> Option<Self> {
        let size = centroids.max - centroids.min;
        let axis = centroids.longest_axis();
        let bin_count = count.clamp(LEAST_BINS, MOST_BINS);
        let scale = bin_count as f32 / size[axis];
        // The reciprocal of a size below 1/f32::MAX is infinite: such an axis counts as flat.
        scale.is_finite().then_some(Self { axis, origin: centroids.min[axis], scale, bin_count })
    }

    #[inline]
    pub(super) fn bin(&self, centroid: Vec3A) -> usize {
        (((centroid[self.axis] - self.origin) * self.scale) as usize).min(self.bin_count - 1)
    }
}

/// The content of one bin.
#[derive(Copy, Clone)]
struct Bin {
    bounds: Bounds,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds::EMPTY, count: 0 };

    #[inline]
    fn merge(&self, other: &Self) -> Self {
        Self { bounds: self.bounds.merge(&other.bounds), count: self.count + other.count }
    }

    /// The cost of testing full leaves in a volume of this size; NaN for an empty bin.
    #[inline]
    fn cost(&self) -> f32 {
        self.bounds.half_area() * self.count.div_ceil(BATCH as u32) as f32
    }
}

/// The bins of some triangles.
pub(super) struct Bins {
    bins: [Bin; MOST_BINS],
    bin_count: usize,
}

impl Bins {
    pub(super) fn new(mapping: &BinMapping) -> Self {
        Self { bins: [Bin::EMPTY; MOST_BINS], bin_count: mapping.bin_count }
    }

    #[inline]
    pub(super) fn add(&mut self, bin: usize, bounds: &Bounds) {
        let bin = &mut self.bins[bin];
        bin.bounds = bin.bounds.merge(bounds);
        bin.count += 1;
    }

    /// Returns the bin before which the cheapest split with triangles on both sides is, and the
    /// boxes of both.
    pub(super) fn best_split(&self) -> Option<(usize, [Bounds; 2])> {
        let bins = &self.bins[..self.bin_count];
        let mut above = [Bin::EMPTY; MOST_BINS + 1];
        for (i, bin) in bins.iter().enumerate().rev() {
            above[i] = bin.merge(&above[i + 1]);
        }
        let mut best = None;
        let mut best_cost = f32::INFINITY;
        let mut below = Bin::EMPTY;
        for i in 1..bins.len() {
            below = below.merge(&bins[i - 1]);
            let cost = below.cost() + above[i].cost();
            // False if a side is empty, as the cost is NaN.
            if cost < best_cost {
                best_cost = cost;
                best = Some((i, [below.bounds, above[i].bounds]));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mapping(min: Vec3A, max: Vec3A, count: usize) -> Option<BinMapping> {
        BinMapping::new(&Bounds { min, max }, count)
    }

    /// Would catch a missing clamp, with which the largest centroid is out of range.
    #[test]
    fn ends_are_in_the_first_and_last_bin() {
        for count in [2, 5, 100] {
            let mapping = mapping(Vec3A::splat(-3.0), Vec3A::splat(7.0), count).unwrap();
            assert_eq!(mapping.bin(Vec3A::splat(-3.0)), 0);
            assert_eq!(mapping.bin(Vec3A::splat(7.0)), mapping.bin_count - 1);
            assert!((LEAST_BINS..=MOST_BINS).contains(&mapping.bin_count));
        }
    }

    /// Division by zero or by a denormal must not give NaN bins or split a flat axis.
    #[test]
    fn flat_and_tiny_axes_are_not_split() {
        assert!(mapping(Vec3A::ONE, Vec3A::ONE, 9).is_none());
        assert!(mapping(Vec3A::ZERO, Vec3A::splat(1e-44), 9).is_none());
        let long_y = mapping(Vec3A::ZERO, Vec3A::new(1.0, 2.0, 1.5), 9).unwrap();
        assert_eq!(long_y.axis, 1);
    }

    /// A size that overflows leaves everything in range.
    #[test]
    fn huge_axes_stay_in_range() {
        let far = Vec3A::new(0.0, 0.0, f32::MAX);
        if let Some(mapping) = mapping(-far, far, 100) {
            for z in [-f32::MAX, 0.0, f32::MAX] {
                assert!(mapping.bin(Vec3A::new(1.0, 0.0, z)) < MOST_BINS);
            }
        }
    }
}
