//! SBBK's contacts beside stock's, where stock is right: triangles of about a unit, coordinates of
//! at most 20.

use rapier3d::math::{Real, Vector};
use rapier3d::parry::query::TrackedContact;
use rapier3d::parry::shape::{PackedFeatureId, TriMesh, Triangle};

use crate::support::{Manifold, Question, distance, sequence, triangles};

type Point = TrackedContact<()>;

/// What was compared.
pub struct Compared {
    /// Manifolds within the prediction distance.
    pub contacts: usize,
    /// Points of stock's that are not among ours and need not be.
    pub excused: usize,
}

/// Checks that an answer has stock's triangle pairs, in order, each with stock's contact.
pub fn check(query: &Question, found: &[Manifold]) -> Compared {
    // Both may hold points that are farther than the prediction distance; the solver ignores them.
    let within = |manifolds: &[Manifold]| -> Vec<Manifold> {
        manifolds.iter().filter(|m| distance(m) <= query.prediction).cloned().collect()
    };
    let [found, mut stock] = [within(found), within(&query.stock())];
    stock.sort_by_key(triangles);
    assert_eq!(sequence(&found), sequence(&stock));
    let excused = found.iter().zip(&stock).map(|(found, stock)| check_equal(query, found, stock));
    Compared { excused: excused.sum(), contacts: found.len() }
}

/// The longest edge of the larger triangle, in units.
fn triangle_size(query: &Question, manifold: &Manifold) -> Real {
    let longest = |(mesh, triangle): (&TriMesh, u32)| {
        let Triangle { a, b, c } = mesh.triangle(triangle);
        [a - b, b - c, c - a].map(Vector::length).into_iter().fold(0.0, Real::max)
    };
    query.meshes().into_iter().zip(triangles(manifold)).map(longest).fold(0.0, Real::max)
}

/// Depth, normal and points may differ from stock's by this share of the triangle size.
const TOLERANCE: Real = 1e-4;
/// How well stock knows the ends of a contact, in units: three times the step from one f32 to the
/// next at 20 units. The direction from one end to the other is then uncertain by as much, divided
/// by their distance.
const STOCK_ROUNDING: Real = 6e-6;

/// Checks that two manifolds of the same triangles are equal: least distance, normal, and the
/// points within the prediction distance as a set. The number of points of stock's that are
/// excused.
///
/// One point may be missing: the closest points as stock's GJK finds them. Where edges or faces are
/// nearly parallel the place of these is not well determined, and ours are at the end of the range.
/// It must be as close.
fn check_equal(query: &Question, found: &Manifold, stock: &Manifold) -> usize {
    let tolerance = TOLERANCE * triangle_size(query, found);
    let context = || format!("{found:?}\n{stock:?}");
    let off = (distance(found) - distance(stock)).abs();
    assert!(off <= tolerance, "distance is off by {off}: {}", context());

    let gap = distance(found);
    let uncertainty = if gap > 0.0 { STOCK_ROUNDING / gap } else { 0.0 };
    for [one, other] in [[found.local_n1, stock.local_n1], [found.local_n2, stock.local_n2]] {
        let off = (one - other).length();
        assert!(off <= TOLERANCE + uncertainty, "normal is off by {off}: {}", context());
    }

    let missing = |points: &[Point], others: &[Point]| -> Vec<Point> {
        let is_missing = |point: &&Point| {
            let is_same = |other: &Point| {
                let off1 = (point.local_p1 - other.local_p1).length();
                let off2 = (point.local_p2 - other.local_p2).length();
                off1.max(off2) <= tolerance
            };
            point.dist <= query.prediction && !others.iter().any(is_same)
        };
        points.iter().filter(is_missing).copied().collect()
    };
    let invented = missing(&found.points, &stock.points);
    assert!(invented.is_empty(), "stock does not have {invented:?}: {}", context());
    let missed = missing(&stock.points, &found.points);
    for point in &missed {
        let is_gjks = point.fid1 == PackedFeatureId::UNKNOWN;
        let is_as_close = (point.dist - gap).abs() <= tolerance;
        assert!(is_gjks && is_as_close, "{point:?} is missing: {}", context());
    }
    missed.len()
}
