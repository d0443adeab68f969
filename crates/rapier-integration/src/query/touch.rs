use parry3d::math::{Real, Vector};
use parry3d::query::{ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::FoundPair;
use sbbk_core::traverse::Placement;

use crate::pair::{FoundTriangle, MeshPlace, PlacedPart};

/// Points of two parts that touch and their outward unit normals, each in its own frame.
#[derive(Copy, Clone)]
pub(crate) struct Touch {
    pub(super) points: [Vector; 2],
    pub(super) normals: [Vector; 2],
}

/// Two subshapes that a query found.
pub(super) struct Found {
    pub(super) subshapes: [u32; 2],
    pub(super) distance: Real,
    pub(super) is_touching: bool,
    pub(super) touch: Touch,
}

impl Touch {
    /// Returns the points at which two triangles touch.
    pub(super) fn of(pair: &FoundPair, placement: &Placement) -> Self {
        Self {
            points: [pair.point1(), pair.point2(placement)],
            normals: [pair.normal1(), pair.normal2(placement)],
        }
    }

    /// Returns the points at which a triangle and a convex shape touch.
    pub(super) fn of_triangle(
        found: &FoundTriangle,
        placed: &PlacedPart,
        mesh_place: MeshPlace,
    ) -> Self {
        Self {
            points: mesh_place.swap(found.points(placed)),
            normals: mesh_place.swap(found.normals(placed)),
        }
    }

    /// The impact of two subshapes.
    pub(super) fn hit(
        &self,
        [subshape1, subshape2]: [u32; 2],
        time: f64,
        status: ShapeCastStatus,
    ) -> ShapeCastHit {
        let Self { points: [witness1, witness2], normals: [normal1, normal2] } = *self;
        let time_of_impact = time as Real;
        ShapeCastHit {
            time_of_impact,
            witness1,
            witness2,
            normal1,
            normal2,
            status,
            subshape1,
            subshape2,
        }
    }
}

/// How a linear cast ends.
pub(super) fn status(is_penetrating: bool) -> ShapeCastStatus {
    if is_penetrating {
        ShapeCastStatus::PenetratingOrWithinTargetDist
    } else {
        ShapeCastStatus::Converged
    }
}
