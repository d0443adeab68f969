use parry3d::math::{Real, Vector};
use parry3d::query::{Contact, ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::FoundPair;
use sbbk_core::traverse::Placement;

/// Points of two parts that touch and their outward unit normals, each in its own frame.
#[derive(Copy, Clone)]
pub(crate) struct Touch {
    pub(super) points: [Vector; 2],
    pub(super) normals: [Vector; 2],
}

impl Touch {
    /// Returns the points at which two triangles touch.
    pub(super) fn of(pair: &FoundPair, placement: &Placement) -> Self {
        Self {
            points: [pair.point1(), pair.point2(placement)],
            normals: [pair.normal1(), pair.normal2(placement)],
        }
    }

    /// The contact of two subshapes.
    pub(super) fn contact(&self, [subshape1, subshape2]: [u32; 2], distance: Real) -> Contact {
        let Self { points: [point1, point2], normals: [normal1, normal2] } = *self;
        let contact = Contact::new(point1, point2, normal1, normal2, distance);
        Contact { subshape1, subshape2, ..contact }
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
