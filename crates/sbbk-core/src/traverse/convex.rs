use glamx::{DVec3, Vec3};

/// A convex shape in a frame of its own.
pub trait Convex {
    /// At least the largest `direction·y` of all points `y` of the shape, and as close to it as
    /// rounding lets it; infinite where the shape has no end. `direction` is not zero and of any
    /// length.
    fn reach(&self, direction: DVec3) -> f64;

    /// A simple body that contains the shape.
    fn outline(&self) -> Outline;
}

/// A body around a convex shape, simple enough to be compared with triangles over SIMD lanes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Outline {
    /// A box along the axes of the shape's frame, rounded: all points within `radius` of the box. A
    /// ball has no half-lengths, a capsule has one.
    RoundBox {
        /// The middle of the box.
        centre: DVec3,
        /// Half of its sides.
        half_lengths: DVec3,
        /// How far around the box the body goes.
        radius: f64,
        /// Whether the body is the shape itself. Otherwise [`Convex::reach`] can tell triangles
        /// apart that the body meets, and is asked.
        is_exact: bool,
    },
    /// All points with `normal·y <= 0`; always the shape itself.
    HalfSpace {
        /// The outer side, of length 1.
        normal: DVec3,
    },
}

impl Outline {
    /// Half of the diagonal of the outline's box with its radius; infinite for a half-space.
    pub fn size(&self) -> f64 {
        match self {
            Self::RoundBox { half_lengths, radius, .. } => half_lengths.length() + radius,
            Self::HalfSpace { .. } => f64::INFINITY,
        }
    }
}

/// The convex hull of points.
impl<const COUNT: usize> Convex for [Vec3; COUNT] {
    fn reach(&self, direction: DVec3) -> f64 {
        self.iter().map(|x| direction.dot(x.as_dvec3())).fold(f64::NEG_INFINITY, f64::max)
    }

    fn outline(&self) -> Outline {
        let low = self.iter().fold(DVec3::INFINITY, |low, x| low.min(x.as_dvec3()));
        let high = self.iter().fold(DVec3::NEG_INFINITY, |high, x| high.max(x.as_dvec3()));
        Outline::RoundBox {
            centre: 0.5 * (low + high),
            half_lengths: 0.5 * (high - low),
            radius: 0.0,
            is_exact: false,
        }
    }
}
