//! Remembers how far a mesh was outside another one, which spares most queries a test.

use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

/// Share of an f32 distance that is a lower bound of the exact one.
const SURE: f64 = 0.99;

/// Last result of the test whether the smaller mesh is inside the larger one.
#[derive(Clone, Debug, Default)]
pub(crate) enum InsideTest {
    #[default]
    Unknown,
    /// The larger mesh is no solid.
    NoSolid,
    /// A point of the smaller mesh was at least this far outside at this placement of the smaller mesh.
    Outside(Placement, f64),
}

impl InsideTest {
    /// A point is `distance` outside at a placement of the smaller mesh.
    pub(super) fn outside(placement: &Placement, distance: f32) -> Self {
        Self::Outside(*placement, SURE * f64::from(distance))
    }

    /// Returns true if a mesh with points in `ball` cannot have come inside.
    pub(super) fn is_outside(&self, ball: Sphere, placement: &Placement) -> bool {
        match self {
            Self::Unknown => false,
            Self::NoSolid => true,
            Self::Outside(before, distance) => {
                placement.motion_bound(before, ball.centre, ball.radius) < *distance
            }
        }
    }
}
