//! The exact contact of a triangle and any convex shape.
//!
//! ```
//! use glamx::DVec3;
//! use sbbk_core::contact::convex::{CylinderSupport, SegmentSupport, convex_contact, round_contact};
//!
//! let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Z * 4.0].map(|v| v - DVec3::new(1.0, 1.1, 1.0));
//! let drum = CylinderSupport { half_height: 1.0, radius: 0.5 };
//! let contact = convex_contact(&floor, &drum, 0.2).expect("0.1 is within the margin");
//! assert!((contact.distance - 0.1).abs() < 1.0e-15 && contact.normal == DVec3::Y);
//!
//! let capsule = SegmentSupport([DVec3::Y, -DVec3::Y]);
//! let contact = round_contact(&floor, &capsule, 0.3, 0.2).expect("crosses by 0.2");
//! assert!((contact.distance + 0.2).abs() < 1.0e-15);
//! ```
//!
//! # How
//!
//! Balls, capsules, boxes, cylinders and cones have closed forms: nearest points of features for
//! bodies apart (`segment.rs`, `apart.rs`), and the least depth of the parts of the surface of the
//! Minkowski difference for bodies that cross (`segment.rs`, `cuboid.rs`, `curved.rs`). Triangles
//! have the contact of [two](crate::contact). Hulls of up to 128 points that cross have one by their
//! faces and edges (`faces.rs`, `hull_surface.rs`). Whatever other shape, and all poses in which rounding
//! chooses what touches what, is left to a search by support points:
//!
//! 1. The nearest point of a simplex of the Minkowski difference goes toward the origin until a
//!    support plane proves it nearest, or proves that the shape is beyond the margin (`search.rs`).
//!    The first simplex is the whole triangle, seen from the point of the shape that reaches
//!    farthest towards it, or farthest along its normal: for flat contacts that is the answer.
//! 2. If a simplex holds the origin, a polytope grows from it to the nearest part of the surface of
//!    the difference (`depth.rs`).
//!
//! The further points of a contact are those of [`clip_feature`].
//!
//! # Accuracy
//!
//! Arithmetic is f64; no tolerance has a unit. Distances of polytopes apart are exact up to
//! rounding, which is 1e-15 of the size of the pair, or of the coordinates in the shape's frame if
//! these are larger. Those of curved shapes are exact to 1e-7 of themselves, directions to 0.03
//! degrees. Depths are exact to 1e-10 of themselves, those of curved shapes to 1e-5. Bodies closer
//! than 1e-10 of their size may count as touching: their distance is off by less than that; needles a
//! billionth as wide as long, closer than 5e-10, by up to 1e-8 of their length. A contact is a function
//! of its arguments, bit for bit: no search starts from an earlier one.

mod apart;
mod clip;
mod cuboid;
mod curved;
mod depth;
mod difference;
mod faces;
mod feature;
mod half_space;
mod hull;
mod hull_surface;
mod lanes;
mod polytope;
mod search;
mod segment;
mod simplex;
mod support;

pub use clip::{FEATURE_CORNERS, FeaturePoint, FeaturePoints, clip_feature};
pub use cuboid::CuboidSupport;
pub use curved::{ConeSupport, CylinderSupport};
pub use feature::feature_at;
pub use half_space::half_space_contact;
pub use hull::HullPoints;
pub use segment::{PointSupport, SegmentSupport};
pub use support::{HullSupport, SupportMap, TriangleSupport};

use depth::{Depth, depth, touching};
use difference::{Difference, Vertex};
use glamx::DVec3;
use search::{Outcome, search};

/// How a triangle and a convex shape meet, in the shape's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexContact {
    /// The distance; when the bodies cross, minus the length of the least translation that parts
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

    /// Of bodies apart, from the point of the triangle and the way from there to the shape.
    #[inline(always)]
    fn apart(on_triangle: DVec3, difference: DVec3) -> Self {
        let distance = difference.length();
        Self::new(on_triangle, difference / distance, distance)
    }

    fn is_finite(&self) -> bool {
        (self.on_shape + self.normal).is_finite() && self.distance.is_finite()
    }
}

/// The contact of a triangle with a convex shape at a distance of at most `margin`; crossing ones
/// have a negative distance.
///
/// The corners are in the shape's frame, whose origin should be in or near the shape: the search
/// starts toward it. The triangle may be a segment or a point, and the shape may be flat. None
/// when a coordinate is not finite. Coordinates and their differences between 1e-38 and 1e38 are
/// safe from overflow.
///
/// Within the margin about 100 ns for a ball, capsule, triangle or cuboid, 300 for a cylinder or
/// cone and 400 for a small hull; when crossing as much, 1 µs for a cylinder or cone, and half of that
/// or more for a hull. Of other support maps, crossing ones take 2 µs or more.
pub fn convex_contact<S: SupportMap>(
    triangle: &[DVec3; 3],
    shape: &S,
    margin: f64,
) -> Option<ConvexContact> {
    find(triangle, shape, margin).filter(|contact| contact.distance <= margin)
}

/// As [`convex_contact`] for a shape with a rounded border: all that is within `radius` of a core.
/// A ball has a point as its core, a capsule a segment.
pub fn round_contact<S: SupportMap>(
    triangle: &[DVec3; 3],
    core: &S,
    radius: f64,
    margin: f64,
) -> Option<ConvexContact> {
    let ConvexContact { distance, normal, on_triangle, .. } =
        find(triangle, core, margin + radius)?;
    let contact = ConvexContact::new(on_triangle, normal, distance - radius);
    (contact.distance <= margin).then_some(contact)
}

/// Whether a triangle and a convex shape cross, or are at most `reach` apart, by search: where a
/// [`convex_contact`] would measure how deep they cross, that is not asked.
pub fn convex_touches<S: SupportMap>(triangle: &[DVec3; 3], shape: &S, reach: f64) -> bool {
    let [a, b, c] = *triangle;
    let is_finite = (a.abs() + b.abs() + c.abs()).element_sum().is_finite();
    let difference = Difference { triangle, shape };
    is_finite
        && match Start::new(&difference).search(&difference, reach).outcome {
            Outcome::Far => false,
            Outcome::Apart(simplex) => simplex.squared <= reach * reach,
            Outcome::Touching(_) | Outcome::Crossing(_) => true,
        }
}

/// Closed forms answer for bodies that are apart, or cross, by more than this share of their size.
/// For others, where rounding chooses what touches what, the search does.
const DOUBTFUL: f64 = 1.0e-10;

/// The contact; may be none if farther than the margin.
#[inline(always)]
fn find<S: SupportMap>(triangle: &[DVec3; 3], shape: &S, margin: f64) -> Option<ConvexContact> {
    let [a, b, c] = *triangle;
    // Finite, unless they are huge, exactly if all coordinates are.
    if !(a.abs() + b.abs() + c.abs()).element_sum().is_finite() {
        return None;
    }
    shape.contact(triangle, margin).filter(ConvexContact::is_finite)
}

/// The contact by support points alone; none if farther than the margin by more than rounding.
#[inline(never)]
fn by_search<S: SupportMap>(
    triangle: &[DVec3; 3],
    shape: &S,
    margin: f64,
) -> Option<ConvexContact> {
    let difference = Difference { triangle, shape };
    let start = Start::new(&difference);
    if !start.parts(triangle)
        && let Some(contact) = shape.crossing(triangle, start.size)
    {
        return Some(contact);
    }
    let size = start.size;
    match start.search(&difference, margin).outcome {
        Outcome::Far => None,
        Outcome::Apart(simplex) => {
            let distance = simplex.squared.sqrt();
            let on_triangle = simplex.on_triangle(triangle);
            Some(ConvexContact::new(on_triangle, simplex.nearest / distance, distance))
        }
        Outcome::Crossing(tetrahedron) => depth(&difference, tetrahedron, size).map(crossing),
        Outcome::Touching(simplex) => touching(&difference, &simplex, size).map(crossing),
    }
}

/// Where a search starts.
struct Start {
    /// From the triangle to somewhere in or near the shape.
    toward: DVec3,
    /// The point of the shape that reaches farthest back along that.
    point: DVec3,
    /// Of both.
    size: f64,
}

impl Start {
    #[inline(always)]
    fn new<S: SupportMap>(difference: &Difference<S>) -> Self {
        let [a, b, c] = *difference.triangle;
        let extent = ((b - a).abs() + (c - a).abs()).element_sum();
        let toward = toward_origin(difference, difference.triangle);
        let point = difference.shape.support(-toward);
        Self { toward, point, size: extent + point.abs().element_sum() }
    }

    /// Whether a plane across the way parts the bodies.
    #[inline(always)]
    fn parts(&self, triangle: &[DVec3; 3]) -> bool {
        triangle.iter().all(|corner| (self.point - corner).dot(self.toward) > 0.0)
    }

    #[inline(always)]
    fn search<S: SupportMap>(&self, difference: &Difference<S>, margin: f64) -> search::Search {
        search(difference, self.toward, self.point, margin, self.size)
    }
}

fn crossing(Depth { outward, depth, on_triangle, .. }: Depth) -> ConvexContact {
    ConvexContact::new(on_triangle, -outward, -depth)
}

/// From the nearest point of the triangle to the origin, or across a triangle that holds it.
#[inline(always)]
fn toward_origin<S: SupportMap>(difference: &Difference<S>, triangle: &[DVec3; 3]) -> DVec3 {
    let [a, b, c]: [Vertex; 3] = difference.at(DVec3::ZERO);
    let nearest = simplex::side(a, b, c).nearest;
    if nearest != DVec3::ZERO {
        return nearest;
    }
    let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if normal != DVec3::ZERO { normal } else { DVec3::Y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Rounds of the search and of the polytope, where one is needed.
    fn rounds<S: SupportMap>(triangle: &[DVec3; 3], shape: &S) -> (u32, u32) {
        let difference = Difference { triangle, shape };
        let toward = toward_origin(&difference, triangle);
        let start = shape.support(-toward);
        let size = start.length() + triangle[1].distance(triangle[0]);
        let found = search(&difference, toward, start, f64::INFINITY, size);
        let depth = match found.outcome {
            Outcome::Far | Outcome::Apart(_) => None,
            Outcome::Crossing(tetrahedron) => depth(&difference, tetrahedron, size),
            Outcome::Touching(simplex) => touching(&difference, &simplex, size),
        };
        (found.rounds, depth.map_or(0, |depth| depth.rounds))
    }

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from_array)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        /// The limits of both loops are there for support maps that lie: no contact is cut short.
        /// Would catch a search that creeps or goes round in circles.
        #[test]
        fn limits_are_never_reached(
            corners in prop::array::uniform3(point()),
            at in point(),
            points in prop::collection::vec(point(), 4..30),
            half_height in 0.02..1.0,
            radius in 0.02..1.0,
            scale in -5.0..3.0_f64,
        ) {
            let triangle = corners.map(|c| at + c * scale.exp());
            let all = [
                rounds(&triangle, &CuboidSupport(DVec3::new(half_height, radius, 0.5))),
                rounds(&triangle, &HullSupport(&points)),
                rounds(&triangle, &CylinderSupport { half_height, radius }),
                rounds(&triangle, &ConeSupport { half_height, radius }),
            ];
            for (search, growth) in all {
                prop_assert!(search < search::ROUNDS / 2, "{all:?}");
                prop_assert!((growth as usize) < polytope::VERTICES / 2, "{all:?}");
            }
        }
    }
}
