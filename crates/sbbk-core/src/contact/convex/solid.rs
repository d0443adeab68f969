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
const LEVEL: f64 = 1.0e-12;

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

    /// A guess of the place along an edge where the solid is nearest, as a share of the edge; any
    /// number.
    #[inline(always)]
    fn likely(&self, _start: DVec3, _edge: DVec3) -> f64 {
        0.5
    }

    /// The point of an edge that is nearest, or one that is within `touching`. The slope of the
    /// squared distance rises along the edge.
    #[inline(always)]
    fn near_edge(&self, start: DVec3, edge: DVec3, touching: f64) -> OffsetPoint {
        let rounding = ROUNDING * touching * edge.length();
        let at = |t: f64| {
            let near = OffsetPoint::of(self, start + edge * t);
            (near, near.from_shape.dot(edge))
        };
        let is_end = |near: &OffsetPoint, slope: f64| {
            let level = (LEVEL * near.squared).max(rounding.min(NEARLY_LEVEL * near.squared));
            slope.abs() <= level || near.squared <= touching * touching
        };
        let ((first, mut low_slope), (last, mut high_slope)) = (at(0.0), at(1.0));
        if low_slope >= 0.0 || is_end(&first, low_slope) {
            return first;
        }
        if high_slope <= 0.0 || is_end(&last, high_slope) {
            return last;
        }
        // First a guess. Then the rule of false position; an end that stays counts half. Every third
        // step is half the way: where the edge touches, the slope rises from nothing.
        let (mut low, mut high, mut side) = (0.0, 1.0, 0);
        let mut nearest = if first.squared < last.squared { first } else { last };
        for step in 0..=STEPS {
            let t = if step == 0 {
                let likely = self.likely(start, edge);
                // Also not a number.
                let is_between = likely > low && likely < high;
                if !is_between {
                    continue;
                }
                likely
            } else if step % 3 == 0 {
                0.5 * (low + high)
            } else {
                high - high_slope * (high - low) / (high_slope - low_slope)
            };
            let (near, slope) = at(t);
            nearest = near;
            if is_end(&near, slope) || !(high - low > PART && t > low && t < high) {
                break;
            }
            if slope < 0.0 {
                (low, low_slope) = (t, slope);
                if side < 0 {
                    high_slope *= 0.5;
                }
                side = -1;
            } else {
                (high, high_slope) = (t, slope);
                if side > 0 {
                    low_slope *= 0.5;
                }
                side = 1;
            }
        }
        nearest
    }
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
        let [a, b, c] = [
            OffsetPoint::of(self.solid, self.triangle[0]),
            OffsetPoint::of(self.solid, self.triangle[1]),
            OffsetPoint::of(self.solid, self.triangle[2]),
        ];
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
            let other = self.solid.near_edge(start, edge, self.doubtful());
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

    /// Greatest value of [`nearer`](Self::nearer).
    #[inline(always)]
    fn open(&self, near: &OffsetPoint) -> f64 {
        let [a, b, c] = self.nearer(near);
        a.max(b).max(c)
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
        let is_apart = near.squared > self.doubtful() * self.doubtful()
            && is_proved::<S>(near.squared, self.open(near), self.size);
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
