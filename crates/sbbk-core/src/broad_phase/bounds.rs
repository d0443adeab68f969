//! What the caller says about an object, when two such bounds are a pair, and why the test of that
//! in `f32` misses nothing.
//!
//! **Boxes.** The gap on an axis is `min₂ − max₁`, so it is at most the margin `m` exactly when
//! `min₂ ≤ max₁ + m`. The margin therefore goes on the upper sides, once an object. Rounding is
//! monotonic and `min₂` is a float: `min₂ ≤ max₁ + m` implies `min₂ ≤ fl(max₁ + m)`. No slack is
//! needed, also where the sum overflows to infinity.
//!
//! **Spheres.** Let `D` be the distance of the centres, `S = r₁ + r₂ + m`, both in real
//! arithmetic, and `u = 2⁻²⁴`. Half the margin goes on each radius. Without underflow
//!
//! * `fl(D²) ≤ D² (1 + u)⁵`: difference, product and two sums, the difference counted twice;
//! * `s = fl(fl(r₁ + m/2) + fl(r₂ + m/2)) ≥ S (1 − u)²`, so `fl(s²) ≥ S² (1 − u)⁵`;
//! * `fl(fl(s² K) + A) ≥ S² K (1 − u)⁷` for any `A ≥ 0`.
//!
//! So `D ≤ S` passes `fl(D²) ≤ fl(fl(s² K) + A)` if `K ≥ (1 + u)⁵ / (1 − u)⁷ = 1 + 12 u + O(u²)`;
//! `K = 1 + 16 u` is the next float with room for the `O(u²)`. Underflow costs at most 2⁻¹⁵⁰ for
//! each of the three squares of `D²` and for `s²` and `s² K`, together less than 2⁻¹⁴⁷, and half a
//! subnormal margin at most 2⁻¹⁵⁰ on a radius; `A = 2⁻¹²⁶` covers them. Overflow is monotonic, and
//! `∞ ≤ ∞` passes. In the other direction a pair that passes has
//! `D ≤ S (1 + 16 u) + 2⁻⁶²`.

use glamx::Vec3;
use thiserror::Error;

/// Bounding sphere and axis-aligned bounding box of one object, in the world frame.
///
/// Each must contain the object; neither needs to contain the other, and a pair must pass both.
/// Round outward where they are computed: a broad phase takes these numbers as exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Centre of the sphere.
    pub centre: Vec3,
    /// Radius of the sphere, at least 0.
    pub radius: f32,
    /// Lower corner of the box.
    pub min: Vec3,
    /// Upper corner of the box, nowhere below `min`.
    pub max: Vec3,
}

/// Bounds that no object can have.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BoundsError {
    /// The centre has a coordinate that is NaN or infinite.
    #[error("sphere centre {centre} is not finite; check the pose of the object")]
    Centre {
        /// The centre given.
        centre: Vec3,
    },
    /// The radius is negative, NaN or infinite.
    #[error("sphere radius {radius} is not a finite number of at least 0")]
    Radius {
        /// The radius given.
        radius: f32,
    },
    /// A corner of the box has a coordinate that is NaN or infinite.
    #[error("box from {min} to {max} is not finite; check the pose of the object")]
    Corner {
        /// The lower corner given.
        min: Vec3,
        /// The upper corner given.
        max: Vec3,
    },
    /// The lower corner is above the upper one.
    #[error("box is inverted on axis {axis}: {min} is above {max}; swap its corners")]
    Inverted {
        /// The first such axis, 0 to 2.
        axis: usize,
        /// Lower bound given on that axis.
        min: f32,
        /// Upper bound given on that axis.
        max: f32,
    },
}

impl Bounds {
    /// Says what is wrong with these bounds, if anything is.
    pub fn validate(&self) -> Result<(), BoundsError> {
        let Self { centre, radius, min, max } = *self;
        if !centre.is_finite() {
            return Err(BoundsError::Centre { centre });
        }
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(BoundsError::Radius { radius });
        }
        if !(min.is_finite() && max.is_finite()) {
            return Err(BoundsError::Corner { min, max });
        }
        match (0..3).find(|&axis| min[axis] > max[axis]) {
            Some(axis) => Err(BoundsError::Inverted { axis, min: min[axis], max: max[axis] }),
            None => Ok(()),
        }
    }

    /// Whether two valid bounds are a pair: the gap between the spheres, and the gap between
    /// the boxes on each axis, are at most `margin` (finite, at least 0).
    ///
    /// This is the definition that [`BroadPhase`](super::BroadPhase) follows to the last bit. It
    /// never misses a pair by rounding; it takes spheres up to 2⁻²⁰ of their reach too far
    /// apart, where the reach is the sum of the radii and the margin.
    pub fn is_pair_with(&self, other: &Bounds, margin: f32) -> bool {
        Reach::new(self, margin).overlaps(&Reach::new(other, margin))
    }
}

/// `K` of the module's derivation: a relative slack on a squared distance. Lower misses pairs by
/// rounding; higher lets more pairs through.
pub(super) const RELATIVE_SLACK: f32 = 1.0 + 8.0 * f32::EPSILON;

/// `A` of the module's derivation: a squared length, 1e-19 units long. Lower misses pairs by
/// underflow; higher lets more pairs through.
pub(super) const ABSOLUTE_SLACK: f32 = f32::MIN_POSITIVE;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aabb {
    pub(super) min: [f32; 3],
    pub(super) max: [f32; 3],
}

impl Aabb {
    /// Contains nothing and overlaps no box of finite corners.
    pub(super) const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }
}

/// Bounds with the margin put in, so that a pair is a plain overlap, touching included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    pub(super) aabb: Aabb,
    pub(super) centre: [f32; 3],
    pub(super) radius: f32,
}

impl Reach {
    pub(super) fn new(bounds: &Bounds, margin: f32) -> Self {
        Self {
            aabb: Aabb {
                min: bounds.min.to_array(),
                max: bounds.max.to_array().map(|upper| upper + margin),
            },
            centre: bounds.centre.to_array(),
            radius: bounds.radius + 0.5 * margin,
        }
    }

    /// The scalar form; [`lanes`](super::lanes) holds the same expressions over eight objects.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let [x, y, z] = [0, 1, 2].map(|axis| self.centre[axis] - other.centre[axis]);
        let reach = self.radius + other.radius;
        let limit = reach * reach * RELATIVE_SLACK + ABSOLUTE_SLACK;
        self.aabb.overlaps(&other.aabb) && x * x + y * y + z * z <= limit
    }
}
