use parry3d::math::{Real, Vector};
use parry3d::query::{ShapeCastHit, ShapeCastStatus};
use sbbk_core::query::{FoundPair, PartPair};
use sbbk_core::traverse::Placement;

use crate::pair::{ConvexSearch, FoundTriangle, MeshPlace, PlacedPart};

/// Two subshapes that a query found.
#[derive(Copy, Clone)]
pub(super) struct Found {
    pub(super) subshapes: [u32; 2],
    /// The distance, or minus the depth.
    pub(super) distance: f64,
    pub(super) is_touching: bool,
    /// The points that are nearest or touch, each in its own frame.
    pub(super) points: [Vector; 2],
    /// The outward unit normals there, each in its own frame.
    pub(super) normals: [Vector; 2],
}

impl Found {
    /// Two triangles of meshes.
    pub(super) fn of_pair(pair: &FoundPair, placement: &Placement) -> Self {
        Self {
            subshapes: pair.name(),
            distance: pair.contact.distance,
            is_touching: pair.is_touching,
            points: [pair.point1(), pair.point2(placement)],
            normals: [pair.normal1(), pair.normal2(placement)],
        }
    }

    /// A triangle and a convex shape.
    pub(super) fn of_triangle(found: &FoundTriangle, search: &ConvexSearch<'_>) -> Self {
        Self::of_placed(found, search.mesh_place, &search.placed)
    }

    /// A triangle and a convex shape at another place.
    pub(super) fn of_placed(
        found: &FoundTriangle,
        mesh_place: MeshPlace,
        placed: &PlacedPart,
    ) -> Self {
        Self {
            subshapes: mesh_place.swap([found.triangle, 0]),
            distance: found.contact.distance,
            is_touching: found.is_touching,
            points: mesh_place.swap(found.points(placed)),
            normals: mesh_place.swap(found.normals(placed)),
        }
    }

    /// The impact at a time.
    pub(super) fn hit(&self, time: f64, status: ShapeCastStatus) -> ShapeCastHit {
        ShapeCastHit {
            time_of_impact: time as Real,
            witness1: self.points[0],
            witness2: self.points[1],
            normal1: self.normals[0],
            normal2: self.normals[1],
            status,
            subshape1: self.subshapes[0],
            subshape2: self.subshapes[1],
        }
    }
}

impl PartPair for Found {
    fn distance(&self) -> f64 {
        self.distance
    }

    fn name(&self) -> [u32; 2] {
        self.subshapes
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
