//! A mesh and a convex shape.

use parry3d::math::Vector;
use parry3d::query::ShapeCastHit;
use parry3d::query::details::ShapeCastOptions;

use super::found::{Found, status};
use super::moving::MovingConvex;
use super::nonlinear::NonlinearCast;
use crate::pair::{ConvexSearch, FoundCast, FoundTriangle, MeshPlace};

/// A mesh and a convex shape of a query.
pub(crate) struct ConvexQuery<'a> {
    pub(crate) search: ConvexSearch<'a>,
    pub(crate) mesh_place: MeshPlace,
}

impl ConvexQuery<'_> {
    /// Returns subshapes that touch, if any do.
    pub(super) fn touching(&self) -> Option<[u32; 2]> {
        Some(self.mesh_place.swap([self.search.touching()?, 0]))
    }

    /// Returns the nearest triangle. Its distance is not negative.
    pub(super) fn nearest(&self, limit: f64) -> Option<Found> {
        let found = self.found(&self.search.nearest(limit)?);
        Some(if found.is_touching { Found { distance: 0.0, ..found } } else { found })
    }

    /// Returns the deepest triangle or, where none crosses, the nearest.
    pub(super) fn deepest(&self, limit: f64) -> Option<Found> {
        Some(self.found(&self.search.deepest(limit)?))
    }

    pub(super) fn cast(
        &self,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let cast = self.search.cast(self.mesh_place, velocity12.as_dvec3(), options)?;
        let FoundCast { time, found, is_penetrating } = cast;
        Some(self.found(&found).hit(time, status(is_penetrating)))
    }

    pub(super) fn cast_nonlinear(self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        let found = MovingConvex::new(self.search, self.mesh_place, cast).first_impact()?;
        Some(cast.hit(found.time, &found.pair, found.has_converged))
    }

    fn found(&self, found: &FoundTriangle) -> Found {
        Found::of_triangle(found, &self.search.placed, self.mesh_place)
    }
}
