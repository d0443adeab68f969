use glamx::Vec3;

use super::directions::{SLABS, project};
use super::rounding::gamma;

/// A discrete oriented polytope of nine slabs: an 18-DOP.
///
/// The first three slabs are those of the [`Aabb`](super::Aabb). Klosowski et al., *Efficient
/// Collision Detection Using Bounding Volume Hierarchies of k-DOPs*, 1998.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Kdop {
    /// The smallest projection on each of the [`DIRECTIONS`](super::directions::DIRECTIONS).
    pub min: [f32; SLABS],
    /// The largest projection on each direction.
    pub max: [f32; SLABS],
}

impl Kdop {
    /// The empty k-DOP, the neutral element of [`merge`](Self::merge).
    pub const EMPTY: Self = Self { min: [f32::INFINITY; SLABS], max: [f32::NEG_INFINITY; SLABS] };

    /// The k-DOP around two.
    #[must_use]
    pub fn merge(&self, other: &Self) -> Self {
        let mut merged = *self;
        // Comparisons cost less than `f32::min`, which treats NaN alike from both sides.
        for slab in 0..SLABS {
            let (min, max) = (other.min[slab], other.max[slab]);
            merged.min[slab] = if min < merged.min[slab] { min } else { merged.min[slab] };
            merged.max[slab] = if max > merged.max[slab] { max } else { merged.max[slab] };
        }
        merged
    }

    /// Returns true if `point` is in the k-DOP, computed in f64. Points around which it is fitted
    /// are.
    pub fn contains(&self, point: Vec3) -> bool {
        let projections = project(point.as_dvec3().to_array());
        let ends = self.min.iter().zip(&self.max);
        ends.zip(projections).all(|((&min, &max), x)| f64::from(min) <= x && x <= f64::from(max))
    }

    /// The k-DOP of points whose projections have these ends.
    ///
    /// All directions except the axes grow by the rounding of a projection of the largest
    /// coordinates.
    pub(crate) fn from_ends(min: [f32; SLABS], max: [f32; SLABS]) -> Self {
        let mut kdop = Self { min, max };
        let magnitude = |axis: usize| min[axis].abs().max(max[axis].abs());
        let rounding = gamma(3) * (magnitude(0) + magnitude(1) + magnitude(2));
        for slab in 3..SLABS {
            kdop.min[slab] -= rounding;
            kdop.max[slab] += rounding;
        }
        kdop
    }
}
