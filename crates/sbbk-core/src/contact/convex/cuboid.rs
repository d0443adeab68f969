//! A triangle and a box around the origin, in closed form.
//!
//! The faces of the Minkowski difference belong to the faces of the box, to the triangle, and to
//! each edge of the triangle with an axis of the box. Bodies that cross are separated by the least
//! translation along one of these axes. The nearest points of bodies apart come from `solid.rs`.

use super::search::BOUNDARY;
use super::simplex::squared_distance;
use super::solid::{Gap, OffsetPoint, Solid, TriangleAndSolid};
use super::support::SupportMap;
use super::{ConvexContact, by_search};
use crate::contact::closest::{closest_on_lines, within_edge};
use glamx::DVec3;

/// A box around the origin, along the axes, given by its half lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuboidSupport(pub DVec3);

impl SupportMap for CuboidSupport {
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        self.0.copysign(direction)
    }

    fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
        let pair = TriangleAndSolid::new(triangle, self, self.0.element_sum());
        if !pair.size.is_finite() {
            return None;
        }
        let beyond = margin.max(0.0) + BOUNDARY * pair.size;
        let (of_box, facet) = pair.box_gap();
        if of_box.width > beyond {
            return None;
        }
        let doubtful = pair.doubtful();
        if of_box.width > doubtful
            && let BoxFacet::Box(axis) = facet
            && let Some(contact) = pair.over_face(axis, of_box.outward[axis])
        {
            return Some(contact);
        }
        let of_triangle = pair.triangle_gap();
        let mut widest = (of_box, facet);
        if let Some(gap) = of_triangle {
            if gap.width > beyond {
                return None;
            }
            if gap.width > of_box.width {
                widest = (gap, BoxFacet::Triangle);
            }
        }
        if widest.0.width <= doubtful {
            widest = pair.edge_gap(widest);
        }
        let contact = if widest.0.width < -doubtful {
            pair.penetration(&widest.0, widest.1)
        } else {
            pair.contact(&pair.nearest(of_triangle.as_ref(), beyond)?)
        };
        contact.or_else(|| by_search(triangle, self, f64::INFINITY))
    }
}

/// Least sine between an edge of the triangle and an axis of the box whose product is tried. The
/// face between them is narrower than this share of the edge.
const PARALLEL: f64 = 1.0e-12;

/// Distance by which a point may be off a body and count as on it, as a share of the size. If
/// features tie, the deepest corner may be beside the other body.
const ON_BODY: f64 = 1.0e-13;

/// The origin of an axis.
#[derive(Clone, Copy)]
enum BoxFacet {
    /// A face of the box, perpendicular to this axis.
    Box(usize),
    Triangle,
    /// An edge of the triangle, and the edges of the box along this axis.
    Edges(usize, usize),
}

impl Solid for CuboidSupport {
    #[inline(always)]
    fn outside(&self, point: DVec3) -> DVec3 {
        point - point.clamp(-self.0, self.0)
    }

    /// The slope is linear between the planes of the box's faces.
    #[inline(always)]
    fn near_edge(&self, start: DVec3, edge: DVec3, _: f64, _: f64) -> OffsetPoint {
        let half = self.0;
        let at = |t: f64| OffsetPoint::of(self, start + edge * t);
        let (mut low, mut high) = (0.0, 1.0);
        let (to_high, to_low) = (half - start, -half - start);
        for i in 0..3 {
            for t in [to_low[i] / edge[i], to_high[i] / edge[i]] {
                // False for NaN.
                if t > low && t < high {
                    if at(t).from_shape.dot(edge) < 0.0 {
                        low = t;
                    } else {
                        high = t;
                    }
                }
            }
        }
        // Between `low` and `high` the edge is beyond the same faces.
        let middle = at(0.5 * (low + high)).from_shape;
        let (mut down, mut up) = (0.0, 0.0);
        for i in 0..3 {
            if middle[i] != 0.0 {
                let face = half[i].copysign(middle[i]);
                down += (face - start[i]) * edge[i];
                up += edge[i] * edge[i];
            }
        }
        let t = if up > 0.0 { (down / up).clamp(low, high) } else { low };
        at(within_edge(t))
    }
}

impl TriangleAndSolid<'_, CuboidSupport> {
    /// The widest gap across a face of the box.
    #[inline(always)]
    fn box_gap(&self) -> (Gap, BoxFacet) {
        let ([a, b, c], half) = (*self.triangle, self.solid.0);
        let (above, below) = (a.min(b).min(c) - half, -half - a.max(b).max(c));
        let (mut axis, mut width, mut sign) = (0, f64::NEG_INFINITY, 1.0);
        for i in 0..3 {
            let (gap, side) = if below[i] > above[i] { (below[i], -1.0) } else { (above[i], 1.0) };
            if gap > width {
                (axis, width, sign) = (i, gap, side);
            }
        }
        (Gap { width, outward: DVec3::AXES[axis] * sign }, BoxFacet::Box(axis))
    }

    /// The contact of a triangle that is apart and over the inside of a face of the box: its lowest
    /// corner. Most triangles near a floor end here.
    #[inline(always)]
    fn over_face(&self, axis: usize, sign: f64) -> Option<ConvexContact> {
        let [a, b, c] = *self.triangle;
        let inside = self.solid.0 - a.abs().max(b.abs()).max(c.abs());
        let is_over = |i: usize| inside[(axis + i) % 3] > 10.0 * self.doubtful();
        if !(is_over(1) && is_over(2)) {
            return None;
        }
        let lowest = self.lowest(axis, sign);
        Some(ConvexContact::apart(lowest, -self.solid.outside(lowest)))
    }

    /// The first of the corners that are lowest along an axis.
    #[inline(always)]
    fn lowest(&self, axis: usize, sign: f64) -> DVec3 {
        let [mut lowest, b, c] = *self.triangle;
        for corner in [b, c] {
            if corner[axis] * sign < lowest[axis] * sign {
                lowest = corner;
            }
        }
        lowest
    }

    /// The widest of a gap and those along the products of an edge and an axis of the box.
    ///
    /// A point's height along the product of axis `i` and an edge is coordinate `i` of the product
    /// of edge and point. Gaps are compared by their squares, which saves eight roots.
    #[inline(always)]
    fn edge_gap(&self, widest: (Gap, BoxFacet)) -> (Gap, BoxFacet) {
        let (mut best, half) = (widest, self.solid.0);
        // Minus the square of a negative width: it rises with the width.
        let mut most = best.0.width * best.0.width.abs();
        for (j, edge) in self.edges.into_iter().enumerate() {
            let heights = self.triangle.map(|corner| edge.cross(corner));
            let low = heights[0].min(heights[1]).min(heights[2]);
            let high = heights[0].max(heights[1]).max(heights[2]);
            let long = edge.abs();
            let reach = DVec3::new(
                long.y * half.z + long.z * half.y,
                long.z * half.x + long.x * half.z,
                long.x * half.y + long.y * half.x,
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
                    best = (Gap { width, outward }, BoxFacet::Edges(j, i));
                    most = width * width.abs();
                }
            }
        }
        best
    }

    /// The contact of bodies that cross, separated best along the gap of a facet. `None` if no
    /// points are found.
    #[inline(always)]
    fn penetration(&self, gap: &Gap, facet: BoxFacet) -> Option<ConvexContact> {
        let Gap { width, outward } = *gap;
        let guess = match facet {
            BoxFacet::Box(axis) => self.corner_over_face(axis, outward[axis]),
            BoxFacet::Triangle => {
                let over = self.solid.0.copysign(outward) + outward * width;
                let near = squared_distance(self.triangle, over);
                (near <= (ON_BODY * self.size).powi(2)).then_some(over)
            }
            BoxFacet::Edges(edge, axis) => self.on_edge(edge, axis, gap),
        };
        // The fallback serves features in one plane.
        let on_triangle = guess.or_else(|| self.touching_after(gap))?;
        Some(ConvexContact::new(on_triangle, -outward, width))
    }

    /// The deepest corner below a face of the box, if it is below the face.
    #[inline(always)]
    fn corner_over_face(&self, axis: usize, sign: f64) -> Option<DVec3> {
        let deepest = self.lowest(axis, sign);
        let outside = deepest.abs() - self.solid.0;
        let slack = ON_BODY * self.size;
        let is_over = |i: usize| outside[(axis + i) % 3] <= slack;
        (is_over(1) && is_over(2)).then_some(deepest)
    }

    /// The point of an edge of the triangle nearest to the outermost edge of the box along an axis.
    /// `None` if the point is beside that edge, or is not the deepest of the triangle: a product of
    /// edges can be the normal of a face of the box.
    #[inline(always)]
    fn on_edge(&self, j: usize, axis: usize, gap: &Gap) -> Option<DVec3> {
        let Gap { width, outward } = *gap;
        let (start, edge) = (self.triangle[j], self.edges[j]);
        let mut corner = self.solid.0.copysign(outward);
        corner[axis] = 0.0;
        let [s, t] = closest_on_lines(corner - start, edge, DVec3::AXES[axis]);
        let is_within = (0.0..=1.0).contains(&s) && t.abs() <= self.solid.0[axis];
        let point = start + edge * s;
        let above = (point - corner).dot(outward) - width;
        (is_within && above <= ON_BODY * self.size).then_some(point)
    }
}
