//! Queries without manifolds, for a pair of meshes or a mesh and a convex shape.
//!
//! Two meshes that have trees are searched by these ([`meshes`]), all others by Parry's BVHs
//! ([`bvh_search`]). Intersection tests use trees of registered meshes alone. A mesh and a convex
//! shape use the BVH of the mesh. [`nonlinear`] and [`moving`] cast along the curves of rigid
//! motions.

mod bvh_search;
mod meshes;
mod moving;
mod nonlinear;

pub(crate) use meshes::MeshQuery;
pub(crate) use nonlinear::NonlinearCast;

use moving::MovingConvex;
use parry3d::math::{Real, Vector};
use parry3d::query::details::ShapeCastOptions;
use parry3d::query::{
    ClosestPoints, Contact, ShapeCastHit, ShapeCastStatus, ShapeDistance, ShapeIntersection,
};
use sbbk_core::query::{Cast, CastOptions, FoundPair, PartPair};
use sbbk_core::traverse::Placement;

use crate::pair::{ConvexSearch, FoundTriangle, MeshPlace, PlacedPart};

/// Two shapes at a pose.
#[allow(clippy::large_enum_variant, reason = "there is one at a time, on the stack")]
pub(crate) enum Query<'a> {
    Meshes(MeshQuery<'a>),
    Convex(ConvexSearch<'a>),
}

impl Query<'_> {
    /// Returns true and two subshapes, if the surfaces touch.
    pub(crate) fn intersection(self) -> ShapeIntersection {
        let touching = match self {
            Self::Meshes(query) => query.touching(),
            Self::Convex(search) => {
                search.first_within(0.0).map(|triangle| search.mesh_place.swap([triangle, 0]))
            }
        };
        let none = ShapeIntersection::new(false);
        touching.map_or(none, |[one, two]| ShapeIntersection::new(true).with_subshapes(one, two))
    }

    /// The distance; `Real::MAX` at a pose that is not finite, as Parry has it for shapes without
    /// parts.
    pub(crate) fn distance(self) -> ShapeDistance {
        let none = ShapeDistance::new(Real::MAX);
        self.nearest(f64::INFINITY).map_or(none, |Found { distance, subshapes, .. }| {
            ShapeDistance::new(distance as Real).with_subshapes(subshapes[0], subshapes[1])
        })
    }

    /// The closest points, each in the frame of its shape.
    pub(crate) fn closest_points(self, max_distance: Real) -> ClosestPoints {
        match self.nearest(limit_of(max_distance)) {
            Some(found) if found.is_touching => ClosestPoints::Intersecting,
            Some(Found { points, .. }) => ClosestPoints::WithinMargin(points[0], points[1]),
            None => ClosestPoints::Disjoint,
        }
    }

    /// The contact of the deepest subshapes or, where none cross, of the nearest.
    pub(crate) fn contact(self, prediction: Real) -> Option<Contact> {
        let limit = limit_of(prediction);
        let Found { subshapes, distance, points, normals, .. } = match self {
            Self::Meshes(query) => query.deepest(limit),
            Self::Convex(search) => {
                search.deepest(limit).map(|found| Found::of_triangle(&found, &search))
            }
        }?;
        let dist = distance as Real;
        let contact = Contact::new(points[0], points[1], normals[0], normals[1], dist);
        Some(Contact { subshape1: subshapes[0], subshape2: subshapes[1], ..contact })
    }

    /// The first impact of shape 2, which moves by `velocity12` in the frame of shape 1.
    pub(crate) fn cast(
        self,
        velocity12: Vector,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let options = CastOptions {
            max_time: options.max_time_of_impact,
            target_distance: options.target_distance.max(0.0),
            stop_at_penetration: options.stop_at_penetration,
        };
        match self {
            Self::Meshes(query) => query.cast(velocity12, options),
            Self::Convex(search) => {
                let Cast { time, pair, is_penetrating } =
                    search.cast(velocity12.as_dvec3(), options)?;
                Some(Found::of_triangle(&pair, &search).hit(time, status(is_penetrating)))
            }
        }
    }

    /// The first impact of both on their ways.
    pub(crate) fn cast_nonlinear(self, cast: &NonlinearCast<'_>) -> Option<ShapeCastHit> {
        match self {
            Self::Meshes(query) => query.cast_nonlinear(cast),
            Self::Convex(search) => {
                let found = MovingConvex::new(search, cast).first_impact()?;
                Some(cast.hit(found.time, &found.pair, found.has_converged))
            }
        }
    }

    /// Returns the nearest subshapes. Their distance is not negative.
    fn nearest(&self, limit: f64) -> Option<Found> {
        match self {
            Self::Meshes(query) => query.nearest(limit),
            Self::Convex(search) => {
                let found = Found::of_triangle(&search.nearest(limit)?, search);
                Some(if found.is_touching { Found { distance: 0.0, ..found } } else { found })
            }
        }
    }
}

/// Returns a limit of Parry's in f64. Parry's largest number stands for no limit.
fn limit_of(distance: Real) -> f64 {
    if distance == Real::MAX { f64::INFINITY } else { f64::from(distance) }
}

/// Two subshapes that a query found.
#[derive(Copy, Clone)]
struct Found {
    subshapes: [u32; 2],
    /// The distance, or minus the depth.
    distance: f64,
    is_touching: bool,
    /// The points that are nearest or touch, each in its own frame.
    points: [Vector; 2],
    /// The outward unit normals there, each in its own frame.
    normals: [Vector; 2],
}

impl Found {
    /// Two triangles of meshes.
    fn of_pair(pair: &FoundPair, placement: &Placement) -> Self {
        Self {
            subshapes: pair.name(),
            distance: pair.contact.distance,
            is_touching: pair.is_touching,
            points: [pair.point1(), pair.point2(placement)],
            normals: [pair.normal1(), pair.normal2(placement)],
        }
    }

    /// A triangle and a convex shape.
    fn of_triangle(found: &FoundTriangle, search: &ConvexSearch<'_>) -> Self {
        Self::of_placed(found, search.mesh_place, &search.placed)
    }

    /// A triangle and a convex shape at another place.
    fn of_placed(found: &FoundTriangle, mesh_place: MeshPlace, placed: &PlacedPart) -> Self {
        let FoundTriangle { triangle, contact, is_touching } = *found;
        let [in_mesh, in_shape] = placed.directions(contact.normal);
        let points = [placed.in_mesh(contact.on_triangle), contact.on_shape.as_vec3()];
        Self {
            subshapes: mesh_place.swap([triangle, 0]),
            distance: contact.distance,
            is_touching,
            points: mesh_place.swap(points),
            normals: mesh_place.swap([in_mesh, -in_shape]).map(|normal| normal.as_vec3()),
        }
    }

    /// The impact at a time.
    fn hit(&self, time: f64, status: ShapeCastStatus) -> ShapeCastHit {
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

/// End of a linear cast.
fn status(is_penetrating: bool) -> ShapeCastStatus {
    if is_penetrating {
        ShapeCastStatus::PenetratingOrWithinTargetDist
    } else {
        ShapeCastStatus::Converged
    }
}
