//! A mesh and a convex shape: distance, closest points, intersection, the deepest contact and casts.

use parry3d::math::{Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{ClosestPoints, Contact, ShapeCastHit, ShapeDistance, ShapeIntersection};

use super::moving::MovingConvex;
use super::nonlinear::NonlinearCast;
use super::proximity::limit_of;
use super::touch::{Touch, status};
use crate::pair::{ConvexSearch, FoundCast, FoundTriangle, MeshPlace};

/// A mesh and a convex shape of a query.
pub(crate) struct ConvexQuery<'a> {
    pub(crate) search: ConvexSearch<'a>,
    pub(crate) mesh_place: MeshPlace,
}

impl ConvexQuery<'_> {
    /// Returns true and one triangle, if the surface of the mesh touches the shape.
    pub(crate) fn intersection(&self) -> ShapeIntersection {
        match self.search.touching() {
            Some(triangle) => {
                let [one, two] = self.subshapes(triangle);
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
                let [one, two] = self.subshapes(found.triangle);
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
                let [one, two] = self.mesh_place.swap(found.points(&self.search.placed));
                ClosestPoints::WithinMargin(one, two)
            }
            None => ClosestPoints::Disjoint,
        }
    }

    /// The contact of the deepest triangle or, where none crosses, of the nearest.
    pub(crate) fn contact(&self, prediction: Real) -> Option<Contact> {
        let found = self.search.deepest(limit_of(prediction))?;
        Some(self.touch(&found).contact(self.subshapes(found.triangle), found.distance()))
    }

    /// The first impact of shape 2, moving by `velocity12` in the frame of shape 1.
    pub(crate) fn cast(
        &self,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let cast = self.search.cast(self.mesh_place, velocity12.as_dvec3(), options)?;
        let FoundCast { time, found, is_penetrating } = cast;
        let subshapes = self.subshapes(found.triangle);
        Some(self.touch(&found).hit(subshapes, time, status(is_penetrating)))
    }

    /// The first impact of both on their ways.
    pub(crate) fn cast_nonlinear(self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = MovingConvex::new(self.search, self.mesh_place, cast).first_impact()?;
        Some(cast.hit(&found, &found.pair.touch))
    }

    fn touch(&self, found: &FoundTriangle) -> Touch {
        Touch {
            points: self.mesh_place.swap(found.points(&self.search.placed)),
            normals: self.mesh_place.swap(found.normals(&self.search.placed)),
        }
    }

    fn subshapes(&self, triangle: u32) -> [u32; 2] {
        self.mesh_place.swap([triangle, 0])
    }
}
