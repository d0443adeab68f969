//! The nearest points of a triangle and a solid whose distance from a point is a closed form.
//!
//! The distance of a point from the solid is a convex function. Its least value over the triangle
//! is at a corner, at a point of the solid over the triangle, or along an edge.

use super::search::is_proved;
use super::simplex::thin_normal;
use super::support::SupportMap;
use super::{ConvexContact, DOUBTFUL};
use glamx::DVec3;

/// Steps along an edge at most; some ten are taken.
const STEPS: u32 = 60;

/// Slope of the squared distance that ends a search along an edge, as a share of the squared
/// distance. Directions are off by about as much.
const LEVEL: f64 = 1.0e-9;

/// Greatest such slope if rounding moves the slope by more than `LEVEL`: a tenth of the share that
/// a proof may leave open.
const NEARLY_LEVEL: f64 = 1.0e-8;

/// Rounding of points, some ten steps, as a share of the distance at which bodies touch.
const ROUNDING: f64 = 1.0e-15 / DOUBTFUL;

/// The part of an edge at which a search along it ends.
const PART: f64 = 1.0e-14;

/// A convex shape that holds the origin.
pub(super) trait Solid: SupportMap {
    /// The way from the shape to a point; zero inside.
    fn outside(&self, point: DVec3) -> DVec3;

    /// Places along an edge, as shares of the edge; any numbers. Near them the edge is nearest, or
    /// passes to another part of the surface.
    #[inline(always)]
    fn breaks(&self, _start: DVec3, _edge: DVec3) -> [f64; 5] {
        [f64::NAN; 5]
    }

    /// The point of an edge that is nearest, or one that is within `touching`. Any point of the
    /// edge if none is nearer than the square root of `least`. The slope of the squared distance
    /// rises along the edge.
    #[inline(always)]
    fn near_edge(&self, start: DVec3, edge: DVec3, touching: f64, least: f64) -> OffsetPoint {
        let rounding = ROUNDING * touching * edge.length();
        let at = |t: f64| {
            let near = OffsetPoint::of(self, start + edge * t);
            EdgePoint { t, near, slope: near.from_shape.dot(edge) }
        };
        let is_end = |EdgePoint { near, slope, .. }: &EdgePoint| {
            let level = (LEVEL * near.squared).max(rounding.min(NEARLY_LEVEL * near.squared));
            slope.abs() <= level || near.squared <= touching * touching
        };
        let (mut low, mut high) = (at(0.0), at(1.0));
        if low.slope >= 0.0 || is_end(&low) {
            return low.near;
        }
        if high.slope <= 0.0 || is_end(&high) {
            return high.near;
        }
        let mut guesses = self.breaks(start, edge).into_iter();
        let mut most = 1.0;
        for step in 0..=STEPS {
            if low.bound(&high) > least {
                break;
            }
            let is_between = |t: &f64| *t > low.t && *t < high.t;
            let halfway = 0.5 * (low.t + high.t);
            let t = guesses.find(is_between).unwrap_or_else(|| low.step(&high, step, most));
            if step % 3 == 0 {
                most = 0.5 * (high.t - low.t);
            }
            let middle = at(if is_between(&t) { t } else { halfway });
            if is_end(&middle) || high.t - low.t <= PART {
                return middle.near;
            }
            if middle.slope < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        if low.near.squared < high.near.squared { low.near } else { high.near }
    }
}

/// A point of an edge, and half the slope of the squared distance from the solid there.
struct EdgePoint {
    /// Share of the edge.
    t: f64,
    near: OffsetPoint,
    slope: f64,
}

impl EdgePoint {
    /// Returns the place of the next step between two points, in turns by the distance and by its
    /// square: one has a smooth minimum. A step halves the part of the edge if three have not made
    /// it shorter than `most`.
    #[inline(always)]
    fn step(&self, high: &Self, step: u32, most: f64) -> f64 {
        if step.is_multiple_of(3) && high.t - self.t > most {
            0.5 * (self.t + high.t)
        } else if step.is_multiple_of(2) {
            minimum(self.squared(), high.squared())
        } else {
            minimum(self.distance(), high.distance())
        }
    }

    /// Returns a lower bound of the squared distance between two points. The distance is convex: it
    /// is above both tangents.
    #[inline(always)]
    fn bound(&self, high: &Self) -> f64 {
        let [fall, rise] = [-self.slope, high.slope];
        let way = 2.0 * fall * rise * (high.t - self.t);
        (self.near.squared * rise + high.near.squared * fall - way) / (fall + rise)
    }

    /// Returns the place, the squared distance there, and its slope.
    #[inline(always)]
    fn squared(&self) -> [f64; 3] {
        [self.t, self.near.squared, 2.0 * self.slope]
    }

    /// Returns the place, the distance there, and its slope.
    #[inline(always)]
    fn distance(&self) -> [f64; 3] {
        let distance = self.near.squared.sqrt();
        [self.t, distance, self.slope / distance]
    }
}

/// Returns the place of the minimum of a cubic function between two places, with values that fall
/// and rise there.
#[inline(always)]
fn minimum([low, at_low, fall]: [f64; 3], [high, at_high, rise]: [f64; 3]) -> f64 {
    let mean = rise + fall - 3.0 * (at_high - at_low) / (high - low);
    let root = (mean * mean - fall * rise).sqrt();
    high - (high - low) * (rise + root - mean) / (rise - fall + 2.0 * root)
}

/// A point of a triangle and the way to it from the nearest point of a solid.
#[derive(Clone, Copy)]
pub(super) struct OffsetPoint {
    pub point: DVec3,
    pub from_shape: DVec3,
    pub squared: f64,
}

impl OffsetPoint {
    #[inline(always)]
    pub fn of<S: Solid + ?Sized>(solid: &S, point: DVec3) -> Self {
        let from_shape = solid.outside(point);
        Self { point, from_shape, squared: from_shape.length_squared() }
    }
}

/// A gap of the bodies along a direction from the solid to the triangle; negative if they overlap.
/// The gap covers all three corners, so a move by it separates the bodies in spite of rounding of
/// the direction.
#[derive(Clone, Copy)]
pub(super) struct Gap {
    pub width: f64,
    /// Unit vector.
    pub outward: DVec3,
}

/// A triangle in the frame of a solid.
pub(super) struct TriangleAndSolid<'a, S> {
    pub triangle: &'a [DVec3; 3],
    pub edges: [DVec3; 3],
    pub solid: &'a S,
    /// Of both.
    pub size: f64,
}

impl<'a, S: Solid> TriangleAndSolid<'a, S> {
    #[inline(always)]
    pub fn new(triangle: &'a [DVec3; 3], solid: &'a S, solid_size: f64) -> Self {
        let [a, b, c] = *triangle;
        let edges = [b - a, c - b, a - c];
        let size = (edges[0].abs() + edges[2].abs() + a.abs()).element_sum() + solid_size;
        Self { triangle, edges, solid, size }
    }

    /// The distance below which rounding chooses what touches what.
    #[inline(always)]
    pub fn doubtful(&self) -> f64 {
        DOUBTFUL * self.size
    }

    /// The gap along the normal of the triangle that points away from the origin, which is the
    /// distance if the plane of the triangle separates the bodies. `None` for a triangle without
    /// area.
    #[inline(always)]
    pub fn triangle_gap(&self) -> Option<Gap> {
        let (normal, squared) = thin_normal(*self.triangle)?;
        let normal = normal / squared.sqrt();
        let [a, b, c] = self.triangle.map(|corner| corner.dot(normal));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let (low, outward) = if -high > low { (-high, -normal) } else { (low, normal) };
        Some(Gap { width: low - self.solid.support(outward).dot(outward), outward })
    }

    /// The nearest point of bodies that do not cross. `None` if they are surely farther apart than
    /// `beyond`.
    #[inline(always)]
    pub fn nearest(&self, of_triangle: Option<&Gap>, beyond: f64) -> Option<OffsetPoint> {
        if let Some(&Gap { width, outward }) = of_triangle
            && width > -self.doubtful()
        {
            let over = self.solid.support(outward) + outward * width;
            if self.is_over(over, outward) {
                let from_shape = outward * width;
                return Some(OffsetPoint { point: over, from_shape, squared: width * width });
            }
        }
        let [a, b, c] = self.triangle.map(|corner| OffsetPoint::of(self.solid, corner));
        let mut nearest = a;
        for other in [b, c] {
            if other.squared < nearest.squared {
                nearest = other;
            }
        }
        for j in 0..3 {
            // A plane through this point, perpendicular to its offset, proves it nearest if no
            // corner is on the near side. An edge with no end on the near side is no nearer.
            let [a, b, c] = self.nearer(&nearest);
            let open = a.max(b).max(c);
            if open <= 0.0 {
                break;
            }
            if self.is_beyond(&nearest, open, beyond) {
                return None;
            }
            let ends = [[a, b], [b, c], [c, a]][j];
            if ends[0] <= 0.0 && ends[1] <= 0.0 {
                continue;
            }
            let (start, edge) = (self.triangle[j], self.edges[j]);
            let other = self.solid.near_edge(start, edge, self.doubtful(), nearest.squared);
            if other.squared < nearest.squared {
                nearest = other;
            }
        }
        Some(nearest)
    }

    /// True if the plane perpendicular to the offset of a point proves that the bodies are farther
    /// apart than `beyond`. This needs the support point: near the slope of a cone, the offset is
    /// no exact normal.
    #[inline(always)]
    fn is_beyond(&self, near: &OffsetPoint, open: f64, beyond: f64) -> bool {
        let is_farther = |bound: f64| bound > 0.0 && bound * bound > beyond * beyond * near.squared;
        is_farther(near.squared - open) && {
            let [a, b, c] = self.triangle.map(|corner| corner.dot(near.from_shape));
            let reach = self.solid.support(near.from_shape).dot(near.from_shape);
            is_farther(a.min(b).min(c) - reach)
        }
    }

    /// True if a point of the triangle's plane is inside it.
    #[inline(always)]
    pub fn is_over(&self, point: DVec3, normal: DVec3) -> bool {
        let beside = [0, 1, 2].map(|i| self.edges[i].cross(point - self.triangle[i]).dot(normal));
        beside.iter().all(|x| *x > 0.0) || beside.iter().all(|x| *x < 0.0)
    }

    /// Height by which each corner is nearer than a point along the offset of the point, times the
    /// length of the offset.
    #[inline(always)]
    fn nearer(&self, near: &OffsetPoint) -> [f64; 3] {
        let [a, b, c] = *self.triangle;
        [a, b, c].map(|corner| (near.point - corner).dot(near.from_shape))
    }

    /// The contact at the nearest point. `None` if the bodies touch, or if rounding may have picked
    /// the wrong one of several places.
    #[inline(always)]
    pub fn contact(&self, near: &OffsetPoint) -> Option<ConvexContact> {
        let [a, b, c] = self.nearer(near);
        let is_apart = near.squared > self.doubtful() * self.doubtful()
            && is_proved::<S>(near.squared, a.max(b).max(c), self.size);
        is_apart.then(|| ConvexContact::apart(near.point, -near.from_shape))
    }

    /// The point of the triangle that touches the solid after it has moved along a gap.
    #[inline(never)]
    pub fn touching_after(&self, gap: &Gap) -> Option<DVec3> {
        let moved = self.triangle.map(|corner| corner - gap.outward * gap.width);
        let pair = TriangleAndSolid { triangle: &moved, ..*self };
        let near = pair.nearest(pair.triangle_gap().as_ref(), f64::INFINITY)?;
        let is_touching = near.squared <= self.doubtful() * self.doubtful();
        is_touching.then_some(near.point + gap.outward * gap.width)
    }
}
