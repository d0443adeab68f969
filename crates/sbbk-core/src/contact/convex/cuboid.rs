//! A triangle and a box around the origin, in closed form.
//!
//! The faces of the difference of both are those of the box, the triangle, and one for each edge of
//! the triangle and axis of the box: along one of these axes the bodies that cross are parted by
//! the least translation, and bodies that are apart are seen to be so. How far these are apart is
//! found at the corners of the triangle, at a corner of the box over the triangle, or along an edge
//! of the triangle, where the distance from the box is a convex function with parts that are
//! parabolas.
//!
//! Every gap is measured with all three corners along an axis of any accuracy: a move by it parts
//! the bodies whatever rounding made of the axis.

use super::difference::Vertex;
use super::search::is_proved;
use super::simplex::{self, thin_normal};
use super::support::CuboidSupport;
use super::{ConvexContact, DOUBTFUL, by_search};
use crate::contact::closest::{crossing, within_edge};
use glamx::DVec3;

/// Least sine between an edge of the triangle and an axis of the box whose product is looked at:
/// the face that it bounds is narrower than this share of the edge.
const PARALLEL: f64 = 1.0e-12;

/// How far a point may be off a body, as a share of the size, and count as on it: where features
/// tie, the deepest corner need not be over the other body.
const ON_BODY: f64 = 1.0e-13;

/// Share of the size by which a gap must be beyond the margin to end the search.
const BOUNDARY: f64 = 1.0e-13;

/// What a direction that may part the bodies belongs to.
#[derive(Clone, Copy)]
enum Facet {
    /// Of the box, across this axis.
    Box(usize),
    Triangle,
    /// An edge of the triangle, and the edges of the box along this axis.
    Edges(usize, usize),
}

/// A gap of the bodies along a direction from the box to the triangle; negative if they overlap.
#[derive(Clone, Copy)]
struct Gap {
    width: f64,
    /// Unit vector.
    outward: DVec3,
    facet: Facet,
}

/// A point of the triangle and the way from the point of the box nearest to it.
#[derive(Clone, Copy)]
struct Near {
    point: DVec3,
    from_box: DVec3,
    squared: f64,
}

/// A triangle in the frame of a box.
struct Pair<'a> {
    triangle: &'a [DVec3; 3],
    edges: [DVec3; 3],
    half: DVec3,
    size: f64,
}

pub(super) fn cuboid_contact(
    triangle: &[DVec3; 3],
    half: DVec3,
    margin: f64,
) -> Option<ConvexContact> {
    let [a, b, c] = *triangle;
    let edges = [b - a, c - b, a - c];
    let size = (edges[0].abs() + edges[2].abs() + a.abs() + half).element_sum();
    if !size.is_finite() {
        return None;
    }
    let pair = Pair { triangle, edges, half, size };
    let beyond = margin.max(0.0) + BOUNDARY * size;
    let of_box = pair.box_gap();
    if of_box.width > beyond {
        return None;
    }
    let of_triangle = pair.triangle_gap();
    let mut widest = of_box;
    if let Some(gap) = of_triangle {
        if gap.width > beyond {
            return None;
        }
        if gap.width > widest.width {
            widest = gap;
        }
    }
    let doubtful = DOUBTFUL * size;
    if widest.width <= doubtful {
        widest = pair.edge_gap(widest);
    }
    if widest.width < -doubtful {
        if let Some(contact) = pair.crossing(&widest) {
            return Some(contact);
        }
    } else {
        let near = pair.nearest(of_triangle.as_ref());
        let is_apart = near.squared > doubtful * doubtful;
        if is_apart && is_proved::<CuboidSupport>(near.squared, pair.open(&near), size) {
            return Some(ConvexContact::apart(near.point, -near.from_box));
        }
    }
    by_search(triangle, &CuboidSupport(half), f64::INFINITY)
}

impl Pair<'_> {
    /// The widest gap across a face of the box.
    #[inline(always)]
    fn box_gap(&self) -> Gap {
        let [a, b, c] = *self.triangle;
        let (above, below) = (a.min(b).min(c) - self.half, -self.half - a.max(b).max(c));
        let (mut axis, mut width, mut sign) = (0, f64::NEG_INFINITY, 1.0);
        for i in 0..3 {
            let (gap, side) = if below[i] > above[i] { (below[i], -1.0) } else { (above[i], 1.0) };
            if gap > width {
                (axis, width, sign) = (i, gap, side);
            }
        }
        Gap { width, outward: DVec3::AXES[axis] * sign, facet: Facet::Box(axis) }
    }

    /// The gap along the normal of the triangle.
    #[inline(always)]
    fn triangle_gap(&self) -> Option<Gap> {
        let (normal, squared) = thin_normal(*self.triangle)?;
        let [a, b, c] = self.triangle.map(|corner| corner.dot(normal));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let reach = normal.abs().dot(self.half);
        let scale = 1.0 / squared.sqrt();
        let (gap, side) = if -high > low { (-high - reach, -scale) } else { (low - reach, scale) };
        Some(Gap { width: gap * scale, outward: normal * side, facet: Facet::Triangle })
    }

    /// The widest of a gap and those along the products of an edge and an axis of the box.
    ///
    /// A point's height along the product of axis `i` and an edge is coordinate `i` of the product
    /// of edge and point. Gaps are compared by their squares, which saves eight roots.
    #[inline(always)]
    fn edge_gap(&self, widest: Gap) -> Gap {
        let mut best = widest;
        // Minus the square of a negative width: it rises with the width.
        let mut most = best.width * best.width.abs();
        for (j, edge) in self.edges.into_iter().enumerate() {
            let heights = self.triangle.map(|corner| edge.cross(corner));
            let low = heights[0].min(heights[1]).min(heights[2]);
            let high = heights[0].max(heights[1]).max(heights[2]);
            let long = edge.abs();
            let reach = DVec3::new(
                long.y * self.half.z + long.z * self.half.y,
                long.z * self.half.x + long.x * self.half.z,
                long.x * self.half.y + long.y * self.half.x,
            );
            let squares = edge * edge;
            let shortest = PARALLEL * PARALLEL * squares.element_sum();
            let (above, below) = (low - reach, -high - reach);
            for i in 0..3 {
                let squared = squares[(i + 1) % 3] + squares[(i + 2) % 3];
                let is_below = below[i] > above[i];
                let gap = if is_below { below[i] } else { above[i] };
                if squared > shortest && gap * gap.abs() > most * squared {
                    let scale = 1.0 / squared.sqrt();
                    let side = if is_below { -scale } else { scale };
                    let width = gap * scale;
                    let outward = DVec3::AXES[i].cross(edge) * side;
                    best = Gap { width, outward, facet: Facet::Edges(j, i) };
                    most = width * width.abs();
                }
            }
        }
        best
    }

    /// The contact of bodies that cross, parted best along a gap. None where no points are found.
    #[inline(always)]
    fn crossing(&self, gap: &Gap) -> Option<ConvexContact> {
        let Gap { width, outward, facet } = *gap;
        let guess = match facet {
            Facet::Box(axis) => self.corner_over_face(axis, outward[axis]),
            Facet::Triangle => {
                let over = self.half.copysign(outward) + outward * width;
                let [a, b, c] =
                    [0, 1, 2].map(|i| Vertex { point: over - self.triangle[i], corner: i });
                let near = simplex::face(a, b, c).squared;
                (near <= (ON_BODY * self.size).powi(2)).then_some(over)
            }
            Facet::Edges(edge, axis) => self.on_edge(edge, axis, gap),
        };
        let on_triangle = match guess {
            Some(point) => point,
            None => {
                // Features that lie in one plane: where they touch after the move.
                let shift = -outward * width;
                let moved = self.triangle.map(|corner| corner + shift);
                let moved = Pair { triangle: &moved, ..*self };
                let near = moved.nearest(moved.triangle_gap().as_ref());
                if near.squared > (DOUBTFUL * self.size).powi(2) {
                    return None;
                }
                near.point - shift
            }
        };
        Some(ConvexContact::new(on_triangle, -outward, width))
    }

    /// The deepest corner below a face of the box, if it is below the face.
    #[inline(always)]
    fn corner_over_face(&self, axis: usize, sign: f64) -> Option<DVec3> {
        let [mut deepest, b, c] = *self.triangle;
        for corner in [b, c] {
            if corner[axis] * sign < deepest[axis] * sign {
                deepest = corner;
            }
        }
        let outside = deepest.abs() - self.half;
        let slack = ON_BODY * self.size;
        let is_over = |i: usize| outside[(axis + i) % 3] <= slack;
        (is_over(1) && is_over(2)).then_some(deepest)
    }

    /// The point of an edge of the triangle nearest to the edge of the box along an axis that is
    /// farthest outward, if it is beside that edge and the deepest of the triangle. It need not be:
    /// a product of edges can be the normal of a face of the box.
    #[inline(always)]
    fn on_edge(&self, j: usize, axis: usize, gap: &Gap) -> Option<DVec3> {
        let Gap { width, outward, .. } = *gap;
        let (start, edge) = (self.triangle[j], self.edges[j]);
        let mut corner = self.half.copysign(outward);
        corner[axis] = 0.0;
        let along = DVec3::AXES[axis];
        let cross = edge.cross(along);
        let [s, t] = crossing(corner - start, edge, along, cross, cross.length_squared());
        let is_within = (0.0..=1.0).contains(&s) && t.abs() <= self.half[axis];
        let point = start + edge * s;
        let above = (point - corner).dot(outward) - width;
        (is_within && above <= ON_BODY * self.size).then_some(point)
    }

    /// The point of the triangle nearest to the box; of bodies that do not cross.
    #[inline(always)]
    fn nearest(&self, of_triangle: Option<&Gap>) -> Near {
        let [a, b, c] = self.triangle.map(|corner| self.near(corner));
        let mut nearest = a;
        for other in [b, c] {
            if other.squared < nearest.squared {
                nearest = other;
            }
        }
        // The distance from the box is a convex function: it rises toward the other corners.
        let from = nearest.point;
        if self.triangle.iter().all(|corner| (*corner - from).dot(nearest.from_box) >= 0.0) {
            return nearest;
        }
        if let Some(&Gap { width, outward, .. }) = of_triangle
            && width > -DOUBTFUL * self.size
        {
            let over = self.half.copysign(outward) + outward * width;
            let [p, q, r] = *self.triangle;
            let beside = [(p, q), (q, r), (r, p)]
                .map(|(start, end)| (end - start).cross(over - start).dot(outward));
            let is_over = beside.iter().all(|x| *x > 0.0) || beside.iter().all(|x| *x < 0.0);
            if is_over {
                return Near { point: over, from_box: outward * width, squared: width * width };
            }
        }
        for j in 0..3 {
            let other = self.near_edge(self.triangle[j], self.edges[j]);
            if other.squared < nearest.squared {
                nearest = other;
            }
        }
        nearest
    }

    /// By how much a corner of the triangle is nearer than a point, along the way to it from the
    /// box, times the length of that.
    fn open(&self, near: &Near) -> f64 {
        let [a, b, c] = self.triangle.map(|corner| (near.point - corner).dot(near.from_box));
        a.max(b).max(c)
    }

    #[inline(always)]
    fn near(&self, point: DVec3) -> Near {
        let from_box = point - point.clamp(-self.half, self.half);
        Near { point, from_box, squared: from_box.length_squared() }
    }

    /// The point of an edge that is nearest to the box. The slope of the squared distance rises
    /// along the edge, and is linear between the planes of the box's faces.
    #[inline(always)]
    fn near_edge(&self, start: DVec3, edge: DVec3) -> Near {
        let at = |t: f64| start + edge * t;
        let slope = |t: f64| self.near(at(t)).from_box.dot(edge);
        let (mut low, mut high) = (0.0, 1.0);
        let (to_high, to_low) = (self.half - start, -self.half - start);
        for i in 0..3 {
            for t in [to_low[i] / edge[i], to_high[i] / edge[i]] {
                // Not so for NaN.
                if t > low && t < high {
                    if slope(t) < 0.0 {
                        low = t;
                    } else {
                        high = t;
                    }
                }
            }
        }
        // Beyond these faces the edge is all the way.
        let middle = self.near(at(0.5 * (low + high))).from_box;
        let (mut down, mut up) = (0.0, 0.0);
        for i in 0..3 {
            if middle[i] != 0.0 {
                let face = self.half[i].copysign(middle[i]);
                down += (face - start[i]) * edge[i];
                up += edge[i] * edge[i];
            }
        }
        let t = if up > 0.0 { (down / up).clamp(low, high) } else { low };
        self.near(at(within_edge(t)))
    }
}
