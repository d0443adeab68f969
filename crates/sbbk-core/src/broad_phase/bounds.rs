//! What the caller says about an object, and when two such bounds are a pair.

use glamx::Vec3;
use thiserror::Error;

use super::reach::Reach;

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
