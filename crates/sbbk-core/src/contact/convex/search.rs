//! The search for the point of the difference nearest to the origin.
//!
//! E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex
//! objects in three-dimensional space", 1988. The nearest point `v` of a simplex is never nearer
//! than the nearest point of the difference. No point of the difference is farther back along `v`
//! than its support point. If both agree, the distance is proved; if the support point is beyond
//! the margin, so is the shape.

use super::simplex::{self, Simplex, Step};
use super::support::{Difference, SupportMap, Vertex};
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Limit of simplices tried, for support maps that are not convex. Polytopes take few, cylinders
/// and cones some thirty. Higher: such shapes take longer. Lower: contacts lose digits.
const ROUNDS: u32 = 100;

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

/// Share of the size below which bodies touch if no plane at all separates them. Rounding hides the
/// nearest points of a needle that a segment runs through.
const UNPROVED: f64 = 5.0e-10;

/// True if a nearest point is proved, given its squared distance and the part of it that a support
/// plane leaves open.
#[inline(always)]
pub(super) fn is_proved<S: SupportMap>(squared: f64, open: f64, size: f64) -> bool {
    let rounding = (ROUNDING * size).powi(2);
    open <= PROVED[usize::from(S::IS_CURVED)] * squared || open * open <= rounding * squared
}

/// The end of a search.
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

/// A search for the nearest point.
pub(super) struct Search<'a, S> {
    pub difference: Difference<'a, S>,
    /// Leads from the triangle to a point in or near the shape.
    toward: DVec3,
    /// The support point of the shape opposite to `toward`.
    start: DVec3,
    /// Size of both.
    pub size: f64,
}

impl<'a, S: SupportMap> Search<'a, S> {
    #[inline(always)]
    pub fn new(triangle: &'a [DVec3; 3], shape: &'a S) -> Self {
        let [a, b, c] = *triangle;
        let extent = ((b - a).abs() + (c - a).abs()).element_sum();
        let difference = Difference { triangle, shape };
        let toward = toward_origin(&difference);
        let start = shape.support(-toward);
        Self { difference, toward, start, size: extent + start.abs().element_sum() }
    }

    /// True if a plane perpendicular to `toward` separates the bodies.
    #[inline(always)]
    pub fn starts_apart(&self) -> bool {
        let Self { difference, toward, start, .. } = self;
        difference.triangle.iter().all(|corner| (start - corner).dot(*toward) > 0.0)
    }

    #[inline(always)]
    pub fn run(&self, margin: f64) -> Outcome {
        let Self { difference, size, .. } = self;
        // Wider than the margin by more than rounding, so that the distance decides.
        let reach = margin.max(0.0) + BOUNDARY * size;
        let is_far =
            |bound: f64, squared: f64| bound > 0.0 && bound * bound > reach * reach * squared;
        let Some(mut simplex) = self.first(is_far) else { return Outcome::Far };
        let touching = (TOUCHING * size).powi(2);
        let mut stalls = 0;
        for _ in 0..ROUNDS {
            let Simplex { nearest, squared, .. } = simplex;
            if squared <= touching {
                return Outcome::Touching(simplex);
            }
            let new = difference.farthest(-nearest);
            let bound = nearest.dot(new.point);
            if is_far(bound, squared) {
                return Outcome::Far;
            }
            if is_proved::<S>(squared, squared - bound, *size) {
                return Outcome::Apart(simplex);
            }
            if simplex.vertices().iter().any(|v| v.point == new.point) {
                return self.stuck(simplex, new);
            }
            match simplex.add(new) {
                Step::Around(tetrahedron) => return Outcome::Crossing(tetrahedron),
                Step::Beside(next) if next.squared < squared => simplex = next,
                // The distance ties up to rounding, as near ties of a vertex and a face do. The
                // direction may still differ.
                Step::Beside(next) => {
                    stalls += 1;
                    let is_tied = next.squared <= squared * (1.0 + TIE);
                    if stalls > STALLS || !is_tied {
                        return self.stuck(simplex, new);
                    }
                    simplex = next;
                }
            }
        }
        Outcome::Apart(simplex)
    }

    /// The nearer one of two simplices to start with; `None` if a plane proves the bodies far
    /// apart.
    #[inline(always)]
    fn first(&self, is_far: impl Fn(f64, f64) -> bool) -> Option<Simplex> {
        let Self { difference, toward, start, .. } = self;
        // The triangle as seen from the point of the shape that reaches farthest back.
        let [a, b, c] = difference.at(*start);
        let bound = a.point.dot(*toward).min(b.point.dot(*toward)).min(c.point.dot(*toward));
        if is_far(bound, toward.length_squared()) {
            return None;
        }
        let simplex = simplex::side(a, b, c);
        // A second start along the normal of the triangle. If the shape rests on the triangle, this
        // is the contact; otherwise the support point saves two rounds.
        let [corner1, corner2, corner3] = *difference.triangle;
        let normal = (corner2 - corner1).cross(corner3 - corner1);
        let normal = if normal.dot(*toward) < 0.0 { -normal } else { normal };
        let [a, b, c] = difference.at(difference.shape.support(-normal));
        if is_far(a.point.dot(normal), normal.length_squared()) {
            return None;
        }
        Some(simplex.nearer(simplex::side(a, b, c)))
    }

    /// The end of a search that comes no nearer. Rounding can keep a search from the direction of
    /// bodies that nearly touch.
    #[cold]
    fn stuck(&self, simplex: Simplex, new: Vertex) -> Outcome {
        let [doubtful, nearly, unproved] =
            [DOUBTFUL, NEARLY, UNPROVED].map(|share| (share * self.size).powi(2));
        let (simplex, open) = least_open(&self.difference, simplex, new, self.size);
        let Simplex { squared, .. } = simplex;
        let is_open = open * open > doubtful * squared && squared <= nearly;
        let is_doubtful = is_open || open >= squared && squared <= unproved;
        if is_doubtful { Outcome::Touching(simplex) } else { Outcome::Apart(simplex) }
    }
}

/// Among the segments and vertices that are equally near up to rounding, the one for which a
/// support plane leaves least open, and how much. If distances tie, this picks the right direction.
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

/// Vector from the nearest point of the triangle to the origin, or the normal of a triangle that
/// holds the origin.
#[inline(always)]
fn toward_origin<S: SupportMap>(difference: &Difference<'_, S>) -> DVec3 {
    let [a, b, c] = difference.at(DVec3::ZERO);
    let nearest = simplex::side(a, b, c).nearest;
    if nearest != DVec3::ZERO {
        return nearest;
    }
    let [a, b, c] = *difference.triangle;
    let normal = (b - a).cross(c - a);
    if normal != DVec3::ZERO { normal } else { DVec3::Y }
}
