//! The search for the point of the difference nearest to the origin.
//!
//! E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex
//! objects in three-dimensional space", 1988. The nearest point `v` of a simplex is never nearer
//! than that of the difference; the difference is nowhere farther back along `v` than its support
//! point there. Where both meet, the distance is proved; where the support point is beyond the
//! margin, so is the shape.

use super::difference::{Difference, Vertex};
use super::simplex::{self, Simplex, Step};
use super::support::SupportMap;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Simplices tried at most. No contact of the tests takes half as many;
/// polytopes take few, cylinders and cones some thirty.
pub(super) const ROUNDS: u32 = 100;

/// Share of the distance that a proof may leave open, for polytopes and for curved shapes.
/// Directions are off by the root of twice that: of curved shapes by up to 0.03 degrees. With 1e-12
/// for these too, cylinders and cones took twice as long.
const PROVED: [f64; 2] = [1.0e-12, 1.0e-7];

/// Share of the size that rounding leaves open.
const ROUNDING: f64 = 1.0e-15;

/// Simplices that may be no nearer than the one before, and by how much they may be farther.
const STALLS: u32 = 4;
const TIE: f64 = 1.0e-14;

/// Share of the size by which a bound must be beyond the margin to end a search, or a closed form.
pub(super) const BOUNDARY: f64 = 1.0e-13;

/// Bodies whose distance is below this share of their size touch.
pub(super) const TOUCHING: f64 = 1.0e-12;

/// Bodies whose distance is below this share of their size may touch, if a proof leaves open more
/// than `DOUBTFUL` of the size.
const NEARLY: f64 = 1.0e-10;
const DOUBTFUL: f64 = 1.0e-11;

/// Those below this share of it touch if no plane at all parts them: a needle that a segment runs
/// through, whose nearest points rounding hides. (Found by fuzzing: a normal that was off by 6
/// degrees.)
const UNPROVED: f64 = 5.0e-10;

/// Whether it is proved that a nearest point is: its squared distance, and how much of that a
/// support plane leaves open.
#[inline(always)]
pub(super) fn is_proved<S: SupportMap>(squared: f64, open: f64, size: f64) -> bool {
    let rounding = (ROUNDING * size).powi(2);
    open <= PROVED[usize::from(S::IS_CURVED)] * squared || open * open <= rounding * squared
}

/// How a search ends.
pub(super) enum Outcome {
    /// Beyond the margin.
    Far,
    /// The nearest point.
    Apart(Simplex),
    /// The nearest point is the origin up to rounding.
    Touching(Simplex),
    /// A tetrahedron with the origin inside.
    Crossing([Vertex; 4]),
}

/// How a search ends and how many simplices it took.
pub(super) struct Search {
    pub outcome: Outcome,
    #[cfg_attr(not(test), expect(dead_code, reason = "a test watches it"))]
    pub rounds: u32,
}

/// `toward` leads from the triangle to somewhere in or near the shape; `start` is the point of the
/// shape that reaches farthest back along it; `size` is that of the pair.
#[inline(always)]
pub(super) fn search<S: SupportMap>(
    difference: &Difference<S>,
    toward: DVec3,
    start: DVec3,
    margin: f64,
    size: f64,
) -> Search {
    let end = |outcome, rounds| Search { outcome, rounds };
    let [doubtful, nearly, unproved] =
        [DOUBTFUL, NEARLY, UNPROVED].map(|share| (share * size).powi(2));
    // Rounding can keep a search from the direction of bodies that nearly touch.
    let stuck = |simplex: Simplex, new: Vertex, rounds| {
        let (simplex, open) = least_open(difference, simplex, new, size);
        let Simplex { squared, .. } = simplex;
        let is_open = open * open > doubtful * squared && squared <= nearly;
        let is_doubtful = is_open || open >= squared && squared <= unproved;
        end(if is_doubtful { Outcome::Touching(simplex) } else { Outcome::Apart(simplex) }, rounds)
    };
    // Wider than the margin by more than rounding, so that the distance decides.
    let reach = margin.max(0.0) + BOUNDARY * size;
    let reach_squared = reach * reach;
    let is_far = |bound: f64, squared: f64| bound > 0.0 && bound * bound > reach_squared * squared;

    // The triangle as seen from the point of the shape that reaches farthest back.
    let [a, b, c] = difference.at(start);
    let bound = a.point.dot(toward).min(b.point.dot(toward)).min(c.point.dot(toward));
    if is_far(bound, toward.length_squared()) {
        return end(Outcome::Far, 0);
    }
    let mut simplex = simplex::side(a, b, c);
    // The same along the normal of the triangle: where a shape rests on it, that is the answer,
    // and its support point is worth two rounds of any other contact.
    let [corner1, corner2, corner3] = *difference.triangle;
    let normal = (corner2 - corner1).cross(corner3 - corner1);
    let normal = if normal.dot(toward) < 0.0 { -normal } else { normal };
    let [a, b, c] = difference.at(difference.shape.support(-normal));
    if is_far(a.point.dot(normal), normal.length_squared()) {
        return end(Outcome::Far, 0);
    }
    let flat = simplex::side(a, b, c);
    if flat.squared < simplex.squared {
        simplex = flat;
    }
    let touching = (TOUCHING * size).powi(2);
    let mut stalls = 0;
    for rounds in 1..=ROUNDS {
        let Simplex { nearest, squared, .. } = simplex;
        if squared <= touching {
            return end(Outcome::Touching(simplex), rounds);
        }
        let new = difference.farthest(-nearest);
        let bound = nearest.dot(new.point);
        if is_far(bound, squared) {
            return end(Outcome::Far, rounds);
        }
        let open = squared - bound;
        let is_known = simplex.vertices().iter().any(|v| v.point == new.point);
        if is_proved::<S>(squared, open, size) {
            return end(Outcome::Apart(simplex), rounds);
        }
        if is_known {
            return stuck(simplex, new, rounds);
        }
        match simplex.add(new) {
            Step::Around(tetrahedron) => return end(Outcome::Crossing(tetrahedron), rounds),
            Step::Beside(next) if next.squared < squared => simplex = next,
            // As near up to rounding, as where a vertex and a face nearly tie: the direction may
            // still be another one.
            Step::Beside(next) => {
                stalls += 1;
                let is_tied = next.squared <= squared * (1.0 + TIE);
                if stalls > STALLS || !is_tied {
                    return stuck(simplex, new, rounds);
                }
                simplex = next;
            }
        }
    }
    end(Outcome::Apart(simplex), ROUNDS)
}

/// Of the segments and vertices of a simplex and of a further vertex that are as near, up to rounding,
/// the one of which a support plane leaves least open, and how much: where distances tie, that tells
/// which direction is right. (The two long edges of a needle, seen from beside its tip; found by
/// fuzzing.)
#[cold]
fn least_open<S: SupportMap>(
    difference: &Difference<S>,
    simplex: Simplex,
    new: Vertex,
    size: f64,
) -> (Simplex, f64) {
    let open = |simplex: &Simplex| {
        let farthest = difference.farthest(-simplex.nearest).point;
        simplex.squared - simplex.nearest.dot(farthest)
    };
    let as_near = (simplex.squared.sqrt() + ROUNDING * size).powi(2);
    let vertices: ArrayVec<Vertex, 4> = simplex.vertices().iter().copied().chain([new]).collect();
    let mut least = (simplex, open(&simplex));
    for (i, &a) in vertices.iter().enumerate() {
        for &b in &vertices[..i] {
            let other = simplex::segment(a, b);
            let other = (other, open(&other));
            if other.0.squared <= as_near && other.1 < least.1 {
                least = other;
            }
        }
    }
    least
}
