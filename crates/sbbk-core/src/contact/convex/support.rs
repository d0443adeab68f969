//! Support maps: all that a search needs to know of a convex shape, and of its Minkowski difference
//! with a triangle.

use super::{ConvexContact, by_search};
use crate::contact::contact as triangle_contact;
use glamx::DVec3;

/// A convex shape, in its own frame.
pub trait SupportMap {
    /// True if its surface is curved anywhere. A search for the nearest point then converges
    /// without end and stops earlier, see [the accuracy](super).
    const IS_CURVED: bool = false;

    /// The farthest point along `direction`, which has any length but zero; any of them where
    /// several are farthest. Exact up to rounding.
    fn support(&self, direction: DVec3) -> DVec3;

    /// The contact with a triangle of finite coordinates. May be none if that is beyond `margin`.
    /// By [search](super), unless there is a closed form.
    #[inline(always)]
    fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact>
    where
        Self: Sized,
    {
        by_search(triangle, self, margin)
    }

    /// The contact with a triangle that crosses the shape, if there is a faster way than the
    /// [search](super). `None` if the triangle may not cross the shape. `size` is the size of both.
    #[inline(always)]
    fn penetration(&self, _triangle: &[DVec3; 3], _size: f64) -> Option<ConvexContact> {
        None
    }
}

impl<F: Fn(DVec3) -> DVec3> SupportMap for F {
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        self(direction)
    }
}

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleSupport(pub [DVec3; 3]);

impl SupportMap for TriangleSupport {
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        self.0[lowest(&self.0, -direction)]
    }

    /// Uses the contact of [two triangles](mod@crate::contact) if both have an area.
    #[inline(always)]
    fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
        if !(is_wide(triangle) && is_wide(&self.0)) {
            return by_search(triangle, self, margin);
        }
        let contact = triangle_contact(triangle, &self.0, margin)?;
        Some(ConvexContact::new(contact.point1, contact.normal, contact.distance))
    }
}

/// Least width of a triangle, as a share of its length, for the contact of two triangles. Lower:
/// needles lose digits. Higher: more triangles take the search.
const WIDE: f64 = 1.0e-6;

#[inline(always)]
fn is_wide([a, b, c]: &[DVec3; 3]) -> bool {
    let (ab, ac) = (*b - *a, *c - *a);
    let longest = ab.length_squared().max(ac.length_squared());
    ab.cross(ac).length_squared() > WIDE * WIDE * longest * longest
}

/// Index of the corner of a triangle that is least far along a direction.
#[inline(always)]
pub(super) fn lowest([a, b, c]: &[DVec3; 3], direction: DVec3) -> usize {
    let [b, c] = [(*b - *a).dot(direction), (*c - *a).dot(direction)];
    let (i, least) = if b < 0.0 { (1, b) } else { (0, 0.0) };
    if c < least { 2 } else { i }
}

/// The Minkowski difference of a convex shape and a triangle: the points `s - t` of points `s` of
/// the shape and `t` of the triangle. The bodies cross where the difference holds the origin. If
/// they are apart, the point nearest to the origin leads from one to the other.
pub(super) struct Difference<'a, S> {
    pub triangle: &'a [DVec3; 3],
    pub shape: &'a S,
}

/// A point of the difference, and the corner of the triangle that it starts from.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub point: DVec3,
    pub corner: usize,
}

impl<S: SupportMap> Difference<'_, S> {
    /// The farthest point along a direction.
    #[inline(always)]
    pub fn farthest(&self, direction: DVec3) -> Vertex {
        let corner = lowest(self.triangle, direction);
        Vertex { point: self.shape.support(direction) - self.triangle[corner], corner }
    }

    /// The three vertices that end in one point of the shape.
    #[inline(always)]
    pub fn at(&self, point: DVec3) -> [Vertex; 3] {
        [0, 1, 2].map(|corner| Vertex { point: point - self.triangle[corner], corner })
    }
}
