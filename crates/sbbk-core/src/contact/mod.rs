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
//! The triangles are apart exactly when a face normal or a cross product of two edges separates
//! them, so these eleven axes ([`axes`]) decide. The best axis also names the closest features,
//! if these are a vertex and a face or two edges; else a vertex is closest to a vertex or edge,
//! and the nine edge pairs ([`edges`]) find it. When triangles cross, the best axis is the least
//! translation. Only where neither is clear, since they touch or lie in one plane, all
//! features and all axes are tried ([`touching`]).
//!
//! From step to step the features rarely change. Four dot products prove that the ones of the
//! step before are still the closest ([`closest`]); no search is needed then.
//!
//! # Accuracy
//!
//! Arithmetic is f64; no tolerance has a unit. Distances and depths are exact to 1e-11 of the
//! larger triangle, as a rule to 1e-15. No fused multiply-add, no random order: equal input gives
//! equal bits on every machine.

mod axes;
mod clip;
mod closest;
mod edges;
mod feature;
mod generate;
mod sides;
mod touching;
mod triangle;

pub use clip::{MANIFOLD_CAPACITY, ManifoldPoint, ManifoldPoints, clip, push_closest};
pub use feature::{Feature, FeaturePair};
pub use generate::{TriangleContact, contact, contact_from, manifold};
