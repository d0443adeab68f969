//! A triangle and a point or a segment, in closed form: the cores of balls and capsules.

use super::search::{BOUNDARY, is_proved};
use super::simplex::{self, Simplex, thin_normal};
use super::support::{Difference, SupportMap};
use super::{ConvexContact, DOUBTFUL, by_search};
use crate::contact::closest::{closest_on_lines, within_edge};
use crate::contact::triangle::NEAR_PARALLEL;
use glamx::DVec3;

/// A point; the core of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSupport(pub DVec3);

impl SupportMap for PointSupport {
    #[inline(always)]
    fn support(&self, _: DVec3) -> DVec3 {
        self.0
    }

    /// A point on the triangle is parted from it along the triangle's normal, on whose side it
    /// counts as being.
    #[inline(always)]
    fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
        let point = self.0;
        let size = size(triangle, point);
        let nearest = from_end(triangle, point);
        let beyond = margin.max(0.0) + BOUNDARY * size;
        if nearest.squared > beyond * beyond {
            return None;
        }
        let near = PointPair::of(&nearest, triangle);
        if let Some(contact) = near.contact(triangle, &[point; 2], size) {
            return Some(contact);
        }
        let touches = nearest.squared <= (DOUBTFUL * size).powi(2) && nearest.vertices().len() == 3;
        let Some((normal, squared)) = thin_normal(*triangle).filter(|_| touches) else {
            return by_search(triangle, self, f64::INFINITY);
        };
        let normal = normal / squared.sqrt();
        let height = (point - triangle[0]).dot(normal);
        Some(ConvexContact::new(point - normal * height, normal, height))
    }
}

/// A segment, given by its ends; the core of a capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentSupport(pub [DVec3; 2]);

impl SupportMap for SegmentSupport {
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        let [a, b] = self.0;
        if (b - a).dot(direction) > 0.0 { b } else { a }
    }

    /// The distance from the triangle is a convex function along the segment. If it rises from an
    /// end on, that end is nearest. Otherwise the nearest point is between the ends and near an
    /// edge, or the segment crosses.
    fn contact(&self, triangle: &[DVec3; 3], _: f64) -> Option<ConvexContact> {
        let [p, q] = self.0;
        let along = q - p;
        let size = size(triangle, p) + along.abs().element_sum();
        let doubtful = (DOUBTFUL * size).powi(2);
        let from_p = from_end(triangle, p);
        let from_q = from_end(triangle, q);
        let (rises_to_q, rises_to_p) =
            (along.dot(from_p.nearest) >= 0.0, along.dot(from_q.nearest) <= 0.0);
        let nearer = if from_q.squared < from_p.squared { from_q } else { from_p };
        let mut nearest = PointPair::of(&nearer, triangle);
        if !(rises_to_q || rises_to_p) {
            match penetration(triangle, &self.0) {
                Some(contact) if contact.distance * contact.distance > doubtful => {
                    return Some(contact);
                }
                Some(_) => return by_search(triangle, self, f64::INFINITY),
                None => {}
            }
            for i in 0..3 {
                let other = from_edge(triangle[i], triangle[(i + 1) % 3], p, along);
                if other.squared < nearest.squared {
                    nearest = other;
                }
            }
        }
        nearest
            .contact(triangle, &self.0, size)
            .or_else(|| by_search(triangle, self, f64::INFINITY))
    }
}

/// Least sine between an edge and a segment that cross for the closed form. A depth beside the edge
/// is off by 1e-16 of the size over the sine. The closed form requires ten times that.
const SKEW: f64 = 1.0e-5;

/// A point of the triangle and the way from there to a point of the segment.
#[derive(Clone, Copy)]
struct PointPair {
    on_triangle: DVec3,
    difference: DVec3,
    /// Squared length of `difference`.
    squared: f64,
}

impl PointPair {
    #[inline(always)]
    fn new(on_triangle: DVec3, difference: DVec3) -> Self {
        Self { on_triangle, difference, squared: difference.length_squared() }
    }

    #[inline(always)]
    fn of(end: &Simplex, triangle: &[DVec3; 3]) -> Self {
        Self::new(end.on_triangle(triangle), end.nearest)
    }

    /// The contact of bodies of a given size. `None` if rounding may have chosen the point: the
    /// bodies touch, or several places tie.
    #[inline(always)]
    fn contact(
        &self,
        &[a, b, c]: &[DVec3; 3],
        &[p, q]: &[DVec3; 2],
        size: f64,
    ) -> Option<ConvexContact> {
        let Self { on_triangle, difference, squared } = *self;
        if squared <= (DOUBTFUL * size).powi(2) {
            return None;
        }
        let along = |x: DVec3| (x - on_triangle).dot(difference);
        let reach = along(p).min(along(q)) - along(a).max(along(b)).max(along(c));
        let is_proved = is_proved::<SegmentSupport>(squared, squared - reach, size);
        is_proved.then(|| ConvexContact::apart(on_triangle, difference))
    }
}

#[inline(always)]
fn size(&[a, b, c]: &[DVec3; 3], point: DVec3) -> f64 {
    ((b - a).abs() + (c - a).abs() + a.abs() + point.abs()).element_sum()
}

/// The point of the triangle nearest to a point, and the way from one to the other.
#[inline(always)]
fn from_end(triangle: &[DVec3; 3], end: DVec3) -> Simplex {
    let [a, b, c] = Difference { triangle, shape: &PointSupport(end) }.at(end);
    simplex::face(a, b, c)
}

/// Closest points of an edge from `v` to `w` and a segment from `p`. Near parallel lines make the
/// place uncertain, but the distance hardly varies there: it is off by 1e-16 of the size.
#[inline(always)]
fn from_edge(v: DVec3, w: DVec3, p: DVec3, along: DVec3) -> PointPair {
    let (edge, between) = (w - v, p - v);
    let cross = edge.cross(along);
    let area = cross.length_squared();
    let [s, t] = closest_on_lines(between, edge, along);
    let is_within = |x: f64| x > 0.0 && x < 1.0;
    let lengths = edge.length_squared() * along.length_squared();
    if is_within(s) && is_within(t) && area > NEAR_PARALLEL * NEAR_PARALLEL * lengths {
        return PointPair::new(v + edge * s, cross * (between.dot(cross) / area));
    }
    let s = within_edge(s);
    let t = within_edge((edge * s - between).dot(along) / along.length_squared());
    let s = within_edge((between + along * t).dot(edge) / edge.length_squared());
    PointPair::new(v + edge * s, between + along * t - edge * s)
}

/// The least translation that separates a triangle and a segment through it. Their difference is a
/// prism with the triangle as base and a side for each edge. `None` if they do not clearly cross.
#[inline(always)]
fn penetration(triangle: &[DVec3; 3], &[p, q]: &[DVec3; 2]) -> Option<ConvexContact> {
    let along = q - p;
    let (normal, squared) = thin_normal(*triangle)?;
    let [below, above] = [p, q].map(|end| (end - triangle[0]).dot(normal));
    let is_through = below < 0.0 && above > 0.0 || below > 0.0 && above < 0.0;
    if !is_through {
        return None;
    }
    let unit = normal / squared.sqrt();
    let [height, end] = if below.abs() < above.abs() { [below, 0.0] } else { [above, 1.0] };
    // The end that comes out first, as it moves back to the side of the other end.
    let outward = if height < 0.0 { unit } else { -unit };
    let depth = height.abs() / squared.sqrt();
    let mut least = ConvexContact::new(p + along * end + outward * depth, outward, -depth);
    let sides = [0, 1, 2].map(|i| {
        let (v, edge) = (triangle[i], triangle[(i + 1) % 3] - triangle[i]);
        let cross = edge.cross(along);
        (v, edge, cross, (p - v).dot(cross))
    });
    let is_inside = sides.iter().all(|side| side.3 > 0.0) || sides.iter().all(|side| side.3 < 0.0);
    if !is_inside {
        return None;
    }
    for (v, edge, cross, volume) in sides {
        let area = cross.length_squared();
        if area <= SKEW * SKEW * edge.length_squared() * along.length_squared() {
            return Some(ConvexContact { distance: 0.0, ..least });
        }
        if volume * volume < area * (least.distance * least.distance) {
            let scale = 1.0 / area.sqrt();
            let outward = cross * if volume > 0.0 { -scale } else { scale };
            let [s, _] = closest_on_lines(p - v, edge, along);
            let on_triangle = v + edge * within_edge(s);
            least = ConvexContact::new(on_triangle, outward, -volume.abs() * scale);
        }
    }
    Some(least)
}
