//! The exact contact of a triangle and any convex shape.
//!
//! ```
//! use glamx::DVec3;
//! use sbbk_core::contact::convex::{CylinderSupport, SegmentSupport, convex_contact};
//!
//! let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Z * 4.0].map(|v| v - DVec3::new(1.0, 1.1, 1.0));
//! let drum = CylinderSupport { half_height: 1.0, radius: 0.5 };
//! let contact = convex_contact(&floor, &drum, 0.2).expect("0.1 is within the margin");
//! assert!((contact.distance - 0.1).abs() < 1.0e-15 && contact.normal == DVec3::Y);
//!
//! // A capsule is all within its radius of a segment.
//! let (segment, radius) = (SegmentSupport([DVec3::Y, -DVec3::Y]), 0.3);
//! let contact = convex_contact(&floor, &segment, 0.2 + radius).expect("crosses by 0.2");
//! assert!((contact.distance - radius + 0.2).abs() < 1.0e-15);
//! ```
//!
//! # How
//!
//! Balls, capsules, boxes, cylinders and cones have closed forms. For bodies apart these are
//! nearest points of features (`segment.rs`, `solid.rs`). For bodies that cross they are the least
//! depth among the parts of the surface of the Minkowski difference (`segment.rs`, `cuboid.rs`,
//! `curved.rs`). Triangles use the contact of [two triangles](mod@crate::contact). Hulls of up to
//! 128 points that cross have a closed form by faces and edges (`faces.rs`, `hull_surface.rs`).
//! Other shapes, and poses in which rounding determines the features, use a search by support
//! points:
//!
//! 1. A simplex of the Minkowski difference approaches the origin until a support plane proves its
//!    nearest point, or proves the shape beyond the margin (`search.rs`). The first simplex is the
//!    whole triangle, which is right for flat contacts.
//! 2. If a simplex holds the origin, a polytope grows from it to the nearest part of the surface of
//!    the difference (`depth.rs`).
//!
//! [`clip_feature`] computes the other points of a contact.
//!
//! # Accuracy
//!
//! Arithmetic is f64; no tolerance has a unit. Errors of distances and depths:
//!
//! * polytopes apart: 1e-15 of the size of the pair, or of the coordinates if these are larger;
//! * curved shapes apart: 1e-7 of the distance, and 0.03 degrees in the normal;
//! * depths: 1e-10 of the depth, 1e-5 for curved shapes;
//! * bodies closer than 1e-10 of their size may count as touching; needles a billionth as wide as
//!   long are off by up to 1e-8 of their length.
//!
//! A contact is a function of its arguments, bit for bit: no search starts from an earlier one.

mod clip;
mod cuboid;
mod curved;
mod depth;
mod faces;
mod feature;
mod hull;
mod hull_flips;
mod hull_surface;
mod lanes;
mod polytope;
mod rim;
mod search;
mod segment;
mod simplex;
mod solid;
mod support;

pub use clip::{FeaturePoint, FeaturePoints, clip_feature};
pub use cuboid::CuboidSupport;
pub use curved::{ConeSupport, CylinderSupport, TurnedSupport};
pub use feature::feature_at;
pub use hull::HullPoints;
pub use segment::{PointSupport, SegmentSupport};
pub use support::{SupportMap, TriangleSupport};

use depth::{crossing_contact, touching_contact};
use glamx::DVec3;
use search::{Outcome, Search};

/// The contact of a triangle and a convex shape, in the frame of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexContact {
    /// The distance; if the bodies cross, minus the length of the least translation that separates
    /// them.
    pub distance: f64,
    /// Unit vector from the triangle to the shape: the direction in which the shape moves away.
    pub normal: DVec3,
    /// The point on the triangle.
    pub on_triangle: DVec3,
    /// The point on the shape: `on_triangle + distance * normal`.
    pub on_shape: DVec3,
}

impl ConvexContact {
    #[inline(always)]
    fn new(on_triangle: DVec3, normal: DVec3, distance: f64) -> Self {
        Self { distance, normal, on_triangle, on_shape: on_triangle + normal * distance }
    }

    /// The contact of bodies apart, by the vector from a point of the triangle to the shape.
    #[inline(always)]
    fn apart(on_triangle: DVec3, difference: DVec3) -> Self {
        let distance = difference.length();
        Self::new(on_triangle, difference / distance, distance)
    }

    fn is_finite(&self) -> bool {
        (self.on_shape + self.normal).is_finite() && self.distance.is_finite()
    }
}

/// Returns the contact of a triangle with a convex shape at a distance of at most `margin`.
/// Crossing bodies have a negative distance.
///
/// The corners are in the shape's frame, whose origin should be in or near the shape, as the search
/// starts toward it. The triangle may be a segment or a point, and the shape may be flat. Returns
/// `None` if a coordinate is not finite. Coordinates and their differences between 1e-38 and 1e38
/// are safe from overflow.
///
/// Takes about 100 ns for a ball, capsule, triangle or cuboid, 300 for a cylinder or cone, 400 for
/// a small hull. Crossing cylinders and cones take 1 µs, other support maps 2 µs or more.
pub fn convex_contact<S: SupportMap>(
    triangle: &[DVec3; 3],
    shape: &S,
    margin: f64,
) -> Option<ConvexContact> {
    let [a, b, c] = *triangle;
    // The sum is finite if all coordinates are, unless they are huge.
    if !(a.abs() + b.abs() + c.abs()).element_sum().is_finite() {
        return None;
    }
    let contact = shape.contact(triangle, margin)?;
    (contact.distance <= margin && contact.is_finite()).then_some(contact)
}

/// Returns the contact of a triangle with the half-space below the plane through the origin with
/// this unit normal, at the lowest corner. `None` beyond the margin, or if a number is not finite.
pub fn half_space_contact(
    triangle: &[DVec3; 3],
    normal: DVec3,
    margin: f64,
) -> Option<ConvexContact> {
    let [mut lowest, b, c] = triangle.map(|corner| (corner.dot(normal), corner));
    let sum = lowest.0 + b.0 + c.0;
    for other in [b, c] {
        if other.0 < lowest.0 {
            lowest = other;
        }
    }
    let (distance, on_triangle) = lowest;
    let contact = ConvexContact::new(on_triangle, -normal, distance);
    (sum.is_finite() && contact.is_finite() && distance <= margin).then_some(contact)
}

/// Returns true if a triangle and a convex shape cross or are at most `reach` apart. Faster than
/// [`convex_contact`] for bodies that cross, as it measures no depth.
pub fn convex_touches<S: SupportMap>(triangle: &[DVec3; 3], shape: &S, reach: f64) -> bool {
    let [a, b, c] = *triangle;
    let is_finite = (a.abs() + b.abs() + c.abs()).element_sum().is_finite();
    is_finite
        && match Search::new(triangle, shape).run(reach) {
            Outcome::Far => false,
            Outcome::Apart(simplex) => simplex.squared <= reach * reach,
            Outcome::Touching(_) | Outcome::Crossing(_) => true,
        }
}

/// Least distance or depth for closed forms, as a share of the size of the bodies. Below it
/// rounding determines the features. Higher: more contacts take the search. Lower: closed forms
/// lose digits.
const DOUBTFUL: f64 = 1.0e-10;

/// The contact by support points alone; `None` if clearly farther than the margin.
#[inline(never)]
fn by_search<S: SupportMap>(
    triangle: &[DVec3; 3],
    shape: &S,
    margin: f64,
) -> Option<ConvexContact> {
    let search = Search::new(triangle, shape);
    let Search { difference, size, .. } = &search;
    if !search.starts_apart()
        && let Some(contact) = shape.penetration(triangle, *size)
    {
        return Some(contact);
    }
    match search.run(margin) {
        Outcome::Far => None,
        Outcome::Apart(simplex) => {
            let distance = simplex.squared.sqrt();
            let on_triangle = simplex.on_triangle(triangle);
            Some(ConvexContact::new(on_triangle, simplex.nearest / distance, distance))
        }
        Outcome::Crossing(tetrahedron) => crossing_contact(difference, tetrahedron, *size),
        Outcome::Touching(simplex) => touching_contact(difference, &simplex, *size),
    }
}
