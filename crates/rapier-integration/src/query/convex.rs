//! A mesh and a convex shape.

use parry3d::math::{Real, Vector};
use parry3d::query::ShapeCastHit;
use parry3d::query::details::ShapeCastOptions;

use super::moving::MovingConvex;
use super::nonlinear::NonlinearCast;
use super::touch::{Found, Touch, status};
use crate::pair::{ConvexSearch, FoundCast, FoundTriangle, MeshPlace};

/// A mesh and a convex shape of a query.
pub(crate) struct ConvexQuery<'a> {
    pub(crate) search: ConvexSearch<'a>,
    pub(crate) mesh_place: MeshPlace,
}

impl ConvexQuery<'_> {
    /// Returns subshapes that touch, if any do.
    pub(super) fn touching(&self) -> Option<[u32; 2]> {
        Some(self.subshapes(self.search.touching()?))
    }

    /// Returns the nearest triangle. Its distance is not negative.
    pub(super) fn nearest(&self, limit: f64) -> Option<Found> {
        let found = self.search.nearest(limit)?;
        Some(self.found(&found, if found.is_touching { 0.0 } else { found.distance() }))
    }

    /// Returns the deepest triangle or, where none crosses, the nearest.
    pub(super) fn deepest(&self, limit: f64) -> Option<Found> {
        let found = self.search.deepest(limit)?;
        Some(self.found(&found, found.distance()))
    }

    pub(super) fn cast(
        &self,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let cast = self.search.cast(self.mesh_place, velocity12.as_dvec3(), options)?;
        let FoundCast { time, found, is_penetrating } = cast;
        let subshapes = self.subshapes(found.triangle);
        Some(self.touch(&found).hit(subshapes, time, status(is_penetrating)))
    }

    pub(super) fn cast_nonlinear(self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = MovingConvex::new(self.search, self.mesh_place, cast).first_impact()?;
        Some(cast.hit(&found, &found.pair.touch))
    }

    fn found(&self, found: &FoundTriangle, distance: Real) -> Found {
        let (subshapes, is_touching) = (self.subshapes(found.triangle), found.is_touching);
        Found { subshapes, distance, is_touching, touch: self.touch(found) }
    }

    fn touch(&self, found: &FoundTriangle) -> Touch {
        Touch::of_triangle(found, &self.search.placed, self.mesh_place)
    }

    fn subshapes(&self, triangle: u32) -> [u32; 2] {
        self.mesh_place.swap([triangle, 0])
    }
}
