//! A mesh and a convex shape: distance, closest points, intersection and the deepest contact.

use parry3d::math::Real;
use parry3d::query::{ClosestPoints, Contact, ShapeDistance, ShapeIntersection};

use super::proximity::limit_of;
use crate::pair::{ConvexSearch, FoundTriangle, MeshPlace};

/// A mesh and a convex shape of which something is asked.
pub(crate) struct ConvexQuery<'a> {
    pub(crate) search: ConvexSearch<'a>,
    pub(crate) mesh_place: MeshPlace,
}

impl ConvexQuery<'_> {
    /// Whether the surface of the mesh meets the shape, and where.
    pub(crate) fn intersection(&self) -> ShapeIntersection {
        match self.search.meeting() {
            Some(found) => {
                let [one, two] = self.subshapes(&found);
                ShapeIntersection::new(true).with_subshapes(one, two)
            }
            None => ShapeIntersection::new(false),
        }
    }

    /// The distance; `Real::MAX` at a pose that is not finite, as Parry has it.
    pub(crate) fn distance(&self) -> ShapeDistance {
        match self.search.nearest(f64::INFINITY) {
            Some(found) => {
                let distance = if found.is_touching { 0.0 } else { found.distance() };
                let [one, two] = self.subshapes(&found);
                ShapeDistance::new(distance).with_subshapes(one, two)
            }
            None => ShapeDistance::new(Real::MAX),
        }
    }

    /// The closest points, each in the frame of its shape.
    pub(crate) fn closest_points(&self, max_distance: Real) -> ClosestPoints {
        match self.search.nearest(limit_of(max_distance)) {
            Some(found) if found.is_touching => ClosestPoints::Intersecting,
            Some(found) => {
                let [one, two] = self.mesh_place.swap(self.search.points(&found));
                ClosestPoints::WithinMargin(one, two)
            }
            None => ClosestPoints::Disjoint,
        }
    }

    /// The contact of the deepest triangle or, where none crosses, of the nearest.
    pub(crate) fn contact(&self, prediction: Real) -> Option<Contact> {
        let found = self.search.deepest(limit_of(prediction))?;
        let [point1, point2] = self.mesh_place.swap(self.search.points(&found));
        let [normal1, normal2] = self.mesh_place.swap(self.search.normals(&found));
        let mut contact = Contact::new(point1, point2, normal1, normal2, found.distance());
        [contact.subshape1, contact.subshape2] = self.subshapes(&found);
        Some(contact)
    }

    fn subshapes(&self, found: &FoundTriangle) -> [u32; 2] {
        self.mesh_place.swap([found.triangle, 0])
    }
}
