//! The exact contact of two triangles: closest points when apart, least translation when they
//! cross, and the points of a manifold.
//!
//! ```
//! use glamx::DVec3;
//! use sbbk_core::contact::{ManifoldPoints, clip, contact, contact_from, push_closest};
//!
//! let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
//! let lid = floor.map(|v| v + DVec3::new(0.5, 0.5, 0.1));
//! let first = contact(&floor, &lid, 0.2).expect("0.1 is within the margin");
//! assert!((first.distance - 0.1).abs() < 1.0e-15 && first.normal == DVec3::Z);
//!
//! let mut points = ManifoldPoints::new();
//! clip(&floor, &lid, first.normal, &mut points);
//! push_closest(&floor, &lid, &first, &mut points);
//! assert_eq!(points.len(), 3);
//!
//! // The next step starts from the features of this one.
//! assert_eq!(contact_from(&floor, &lid, 0.2, first.features), Some(first));
//! ```
//!
//! # How
//!
//! 1. The two edges that face each other are tried first (`edges.rs`): four dot products prove,
//!    or not, that nothing is closer than their closest points. This settles most small
//!    triangles, which are near by a vertex or edge.
//! 2. If a face separates the triangles, its nearest vertex is closest if it lies over the face;
//!    else the walk over edge pairs goes on.
//! 3. If no face does, the cross products of edges decide (`axes.rs`). The best of all axes
//!    either separates the triangles and names the closest edges, or it is the least translation
//!    of triangles that cross.
//! 4. If neither is clear, the triangles touch or lie in one plane. Then all features and axes are
//!    tried (`touching.rs`).
//!
//! From step to step the features rarely change. The proof of the first step, made for the
//! features of the step before (`closest.rs`), then replaces the search.
//!
//! # Accuracy
//!
//! Arithmetic is f64; no tolerance has a unit. Distances and depths are exact to 1e-10 of the
//! larger triangle, as a rule to 1e-15. No fused multiply-add, no random order: equal input gives
//! equal bits on every machine.

mod axes;
mod clip;
mod closest;
pub mod convex;
mod edges;
mod feature;
mod generate;
mod penetration;
mod shadow_signs;
mod touching;
mod triangle;

pub use clip::{ManifoldPoint, ManifoldPoints, clip, push_closest};
pub use feature::{Feature, FeaturePair};
pub use generate::{contact, contact_from};
pub use penetration::{Outward, contact_along};

use closest::Closest;
use glamx::DVec3;

/// The contact of two triangles: closest points if apart, least translation that separates them if
/// they cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleContact {
    /// Unit vector from triangle 1 to triangle 2.
    pub normal: DVec3,
    /// The distance; when the triangles cross, minus the depth, which is how far triangle 2 must
    /// move along the normal to touch triangle 1 only.
    pub distance: f64,
    /// The point on triangle 1.
    pub point1: DVec3,
    /// The point on triangle 2: `point1 + distance * normal`, up to rounding.
    pub point2: DVec3,
    /// What meets.
    pub features: FeaturePair,
}

impl TriangleContact {
    fn new(features: FeaturePair, closest: Closest) -> Self {
        let Closest { point1, point2, normal, distance } = closest;
        Self { normal, distance, point1, point2, features }
    }
}
