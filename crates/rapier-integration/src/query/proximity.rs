//! Distance, closest points, intersection and the deepest contact.

use parry3d::math::{Pose, Real};
use parry3d::query::{ClosestPoints, Contact, ShapeDistance, ShapeIntersection};
use sbbk_core::query::{FoundPair, PartPair};
use sbbk_core::traverse::Placement;

use super::touch::Touch;
use super::trees::Trees;
use super::walk::MeshQuery;

impl MeshQuery<'_> {
    /// Returns true and one pair of touching triangles, if the surfaces of the meshes touch.
    pub(crate) fn intersection(&self, pos12: &Pose) -> ShapeIntersection {
        let placement = Placement::new(pos12);
        // Hashes of small meshes would take longer than most of these queries.
        answer(match Trees::of_registered(self.meshes.each_ref()) {
            Some(trees) => trees.meeting(placement),
            None => self.walk().meeting(placement),
        })
    }

    /// The distance; `Real::MAX` at a pose that is not finite, as Parry has it for shapes without
    /// parts.
    pub(crate) fn distance(&self, pos12: &Pose) -> ShapeDistance {
        match self.nearest(Placement::new(pos12), f64::INFINITY) {
            Some(pair) => {
                let distance = pair.contact.distance.max(0.0) as Real;
                ShapeDistance::new(distance).with_subshapes(pair.triangle1, pair.triangle2)
            }
            None => ShapeDistance::new(Real::MAX),
        }
    }

    /// The closest points, each in the frame of its mesh.
    pub(crate) fn closest_points(&self, pos12: &Pose, max_distance: Real) -> ClosestPoints {
        let placement = Placement::new(pos12);
        match self.nearest(placement, limit_of(max_distance)) {
            Some(pair) if pair.is_touching => ClosestPoints::Intersecting,
            Some(pair) => ClosestPoints::WithinMargin(pair.point1(), pair.point2(&placement)),
            None => ClosestPoints::Disjoint,
        }
    }

    /// The contact of the deepest pair of triangles or, where none cross, of the nearest.
    pub(crate) fn contact(&self, pos12: &Pose, prediction: Real) -> Option<Contact> {
        let placement = Placement::new(pos12);
        let limit = limit_of(prediction);
        let pair = match self.trees() {
            Some(trees) => trees.deepest(placement, limit),
            None => self.walk().deepest(placement, limit),
        }?;
        let distance = pair.contact.distance as Real;
        Some(Touch::of(&pair, &placement).contact(pair.name(), distance))
    }

    fn nearest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        match self.trees() {
            Some(trees) => trees.nearest(placement, limit),
            None => self.walk().nearest(placement, limit),
        }
    }
}

/// Returns a limit of Parry's in f64. Parry's largest number stands for no limit.
pub(super) fn limit_of(distance: Real) -> f64 {
    if distance == Real::MAX { f64::INFINITY } else { f64::from(distance) }
}

fn answer(meeting: Option<FoundPair>) -> ShapeIntersection {
    match meeting {
        Some(FoundPair { triangle1, triangle2, .. }) => {
            ShapeIntersection::new(true).with_subshapes(triangle1, triangle2)
        }
        None => ShapeIntersection::new(false),
    }
}
