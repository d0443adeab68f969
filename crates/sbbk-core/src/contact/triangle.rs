//! A triangle with its edges, and a polygon of a shape.

use super::feature::Feature;
use glamx::DVec3;

/// Two directions whose angle (its sine) is below this are handled with care: their cross
/// product is off by 1e-16 over the sine. Higher: more pairs take the careful way, which costs
/// 20 ns. Lower: axes lose digits.
pub(super) const NEAR_PARALLEL: f64 = 1.0e-3;

/// A triangle, its edges (edge `i` from vertex `i` to the next) and its extent.
#[derive(Clone, Copy)]
pub(super) struct Triangle<'a> {
    pub vertices: &'a [DVec3; 3],
    pub edges: [DVec3; 3],
    /// Unit of all tolerances: between one and four times the longest edge. Infinite or NaN if any
    /// coordinate is.
    pub size: f64,
}

impl<'a> Triangle<'a> {
    #[inline(always)]
    pub fn new(vertices: &'a [DVec3; 3]) -> Self {
        let [a, b, c] = *vertices;
        let edges = [b - a, c - b, a - c];
        let size = (edges[0].abs() + edges[2].abs()).element_sum();
        Self { vertices, edges, size }
    }

    /// The vertex that is not on edge `i`, seen from vertex `i`.
    #[inline(always)]
    pub fn opposite(&self, i: usize) -> DVec3 {
        -self.edges[PREVIOUS[i]]
    }

    /// Unit normal; zero for a triangle without area.
    #[inline(always)]
    pub fn normal(&self) -> DVec3 {
        self.normal_and_area().0
    }

    /// Unit normal and twice the area.
    #[inline(always)]
    pub fn normal_and_area(&self) -> (DVec3, f64) {
        let normal = self.area_vector();
        let area = normal.length();
        if area > 0.0 { (normal * (1.0 / area), area) } else { (DVec3::ZERO, 0.0) }
    }

    /// The normal, as long as twice the area.
    #[inline(always)]
    pub fn area_vector(&self) -> DVec3 {
        let [a, b, _] = self.edges;
        let normal = a.cross(b);
        let lengths = a.length_squared() * b.length_squared();
        if normal.length_squared() > NEAR_PARALLEL * NEAR_PARALLEL * lengths {
            normal
        } else {
            self.thin_area_vector()
        }
    }

    #[cold]
    fn thin_area_vector(&self) -> DVec3 {
        let i = self.longest_edge();
        let [longest, next, last] = [i, NEXT[i], PREVIOUS[i]].map(|i| self.edges[i]);
        let shorter = if next.length_squared() < last.length_squared() { next } else { -last };
        let area = longest.cross(shorter).length();
        perpendicular(longest, shorter).map_or(DVec3::ZERO, |normal| normal * area)
    }

    /// True if a feature lies in a plane that faces a direction, up to `slack`, and the rest of the
    /// triangle is behind it by at least `win`.
    #[inline(always)]
    pub fn is_behind(&self, feature: Feature, direction: DVec3, slack: f64, win: f64) -> bool {
        let i = feature.vertex();
        let next = self.edges[i].dot(direction);
        let previous = -self.edges[PREVIOUS[i]].dot(direction);
        match feature {
            Feature::Vertex(_) => next < -win && previous < -win,
            Feature::Edge(_) => next.abs() <= slack && previous < -win,
            Feature::Face => next.abs() <= slack && previous.abs() <= slack,
        }
    }

    /// True if a point of a feature is farther than some distance from the border of the feature.
    /// False for thin triangles.
    #[inline(always)]
    pub fn is_well_inside(&self, feature: Feature, point: DVec3, border_squared: f64) -> bool {
        match feature {
            Feature::Vertex(_) => true,
            Feature::Edge(_) => {
                let i = feature.vertex();
                let far = |v: usize| (point - self.vertices[v]).length_squared() > border_squared;
                far(i) && far(NEXT[i])
            }
            Feature::Face => {
                let normal = self.area_vector();
                let area_squared = normal.length_squared();
                // Twice the area beside an edge is the distance from it times its length.
                let far = |i: usize| {
                    let beside = self.edges[i].cross(point - self.vertices[i]).dot(normal);
                    let least = border_squared * self.edges[i].length_squared() * area_squared;
                    beside > 0.0 && beside * beside > least
                };
                far(0) && far(1) && far(2) && !self.is_thin(area_squared)
            }
        }
    }

    /// True if rounding may move the ends of a triangle, by 1e-16 of its length over its aspect.
    /// Takes the square of twice the area.
    #[inline(always)]
    pub fn is_thin(&self, area_squared: f64) -> bool {
        let thin = NEAR_PARALLEL * self.size * self.size;
        area_squared < thin * thin
    }

    /// True if a point lies between the ends of the longest edge.
    #[cold]
    pub fn is_beside(&self, point: DVec3) -> bool {
        let i = self.longest_edge();
        let along = (point - self.vertices[i]).dot(self.edges[i]);
        (0.0..=self.edges[i].length_squared()).contains(&along)
    }

    /// Index of the longest edge.
    pub fn longest_edge(&self) -> usize {
        let lengths = self.edges.map(DVec3::length_squared);
        let longer = usize::from(lengths[1] > lengths[0]);
        if lengths[2] > lengths[longer] { 2 } else { longer }
    }

    /// `(v - origin) . axis` of each vertex.
    #[inline(always)]
    pub fn heights(&self, origin: DVec3, axis: DVec3) -> [f64; 3] {
        let [a, b, c] = *self.vertices;
        [(a - origin).dot(axis), (b - origin).dot(axis), (c - origin).dot(axis)]
    }

    /// The least and the greatest of the heights.
    #[inline(always)]
    pub fn shadow(&self, origin: DVec3, axis: DVec3) -> [f64; 2] {
        let [a, b, c] = self.heights(origin, axis);
        [a.min(b).min(c), a.max(b).max(c)]
    }
}

/// Corners of a polygon at most.
pub(super) const MOST_CORNERS: usize = 4;

/// A plane polygon of up to four corners, or a segment.
pub(super) struct Polygon<'a> {
    pub corners: &'a [DVec3],
    /// The first three corners. A segment has no face.
    pub face: Option<Triangle<'a>>,
    /// Like [`Triangle::size`].
    pub size: f64,
    /// Distance, in sizes, by which a vertex may be off an edge and count as on it.
    pub tie: f64,
}

/// The vertex or edge after each one.
pub(super) const NEXT: [usize; 3] = [1, 2, 0];

/// The vertex or edge before each one.
pub(super) const PREVIOUS: [usize; 3] = [2, 0, 1];

/// The unit vector perpendicular to two nearly parallel directions, exactly so to the first. `None`
/// if they are parallel to the last digit.
#[cold]
pub(super) fn perpendicular(u: DVec3, v: DVec3) -> Option<DVec3> {
    let (u, v) = (u.try_normalize()?, v.try_normalize()?);
    let mut normal = u.cross(v).try_normalize()?;
    for _ in 0..2 {
        normal = (normal - u * u.dot(normal)).try_normalize()?;
    }
    Some(normal)
}
