//! Contacts of crossing triangles that lead out of solids.
//!
//! The least translation of two triangles may push one of them into the other body, or along a
//! surface that continues beyond the triangle. Here only axes that lead out of the solids count:
//! face normals, and products of edges that point outside of both. The contact is on the axis of
//! least overlap among these.

use super::TriangleContact;
use super::clip::{ManifoldPoints, clip_triangles};
use super::feature::Feature;
use super::touching::deepest;
use super::triangle::{NEAR_PARALLEL, NEXT, PREVIOUS, Triangle};
use arrayvec::ArrayVec;
use glamx::DVec3;
use std::ops::ControlFlow;

/// Sine of the angle by which an axis may lean into a solid. Higher: walls push up bodies that they
/// do not carry. Lower: an edge of a box that stands not quite upright no longer pushes up.
const LEAN: f64 = 0.05;

/// Sine of the angle between an edge and the plane of the other triangle above which the edge
/// determines the sign of the axis. Higher: more axes are tried. Lower: a nut jams on its bolt.
const STEEP: f64 = 0.55;

/// Share of the overlap that the deepest points must show. Higher: contacts are left to neighbours
/// that show more. Lower: contacts far from the end of the overlap.
const SHOWN: f64 = 0.9;

/// Vertices within this distance of the farthest one along an axis are equally far, in triangle
/// sizes. Higher: edges count as level. Lower: rounding picks a vertex.
const LEVEL: f64 = 1.0e-6;

/// Two overlapping triangles, and the axes along which they leave each other and the solids.
pub struct Outward<'t> {
    triangles: [Triangle<'t>; 2],
    /// Unit normals that lead out of solids.
    normals: [DVec3; 2],
    /// -1 for each normal that the winding has the other way, else 1.
    signs: [f64; 2],
    is_solid: [bool; 2],
    /// Squares of the least cosines between the normals and extremal directions.
    cones: [f64; 2],
}

/// Allowance for rounding of directions, in squares of sines.
const ROUNDING: f64 = 1.0e-6;

/// The gap along an axis, and the axis.
type OutwardAxis = (f64, DVec3);

impl<'t> Outward<'t> {
    /// `outward` has the signs with which the normals lead out of solids; `None` for triangles of
    /// sheets. `cones` has squares of the least cosines between the normals and extremal
    /// directions.
    pub fn new(triangles: [&'t [DVec3; 3]; 2], outward: [Option<f64>; 2], cones: [f64; 2]) -> Self {
        let triangles = triangles.map(Triangle::new);
        let normal = |i: usize| triangles[i].area_vector().normalize_or_zero();
        let signs = outward.map(|sign| sign.unwrap_or(1.0));
        let normals = [0, 1].map(|i| signs[i] * normal(i));
        let is_solid = outward.map(|sign| sign.is_some());
        Self { triangles, normals, signs, is_solid, cones }
    }

    /// Returns the contact along the extremal axis of least overlap.
    ///
    /// `is_extremal` returns true if no neighbour of a feature of triangle 1 (0) or 2 (1) is
    /// farther in a direction. The deepest points give the distance; if these show less than the
    /// overlap, there is no contact.
    pub fn extremal(
        &self,
        is_extremal: impl Fn(usize, Feature, DVec3) -> bool,
    ) -> Option<TriangleContact> {
        let (gap, normal) = self.extremal_axis(is_extremal)?;
        let contact = along(self.triangles.each_ref(), normal)?;
        (contact.distance <= SHOWN * gap).then_some(contact)
    }

    /// Returns the contact along the outward axis of least overlap, if a contact with that normal
    /// `may_count`. Extremal axes come first.
    ///
    /// See [`extremal`](Self::extremal) for `is_extremal`.
    pub fn least(
        &self,
        is_extremal: impl Fn(usize, Feature, DVec3) -> bool,
        may_count: impl Fn(DVec3) -> bool,
    ) -> Option<TriangleContact> {
        let mut widest = None;
        self.for_each(false, |direction, _| {
            let (gap, axis) = self.axis(direction);
            if may_count(axis) {
                widest = Some(widest.map_or(gap, |known: f64| known.max(gap)));
            }
            ControlFlow::Continue(())
        });
        let widest = widest?;
        let extremal = self.extremal_axis(is_extremal);
        let (_, normal) = extremal.or_else(|| self.least_axis(widest))?;
        may_count(normal).then(|| along(self.triangles.each_ref(), normal))?
    }

    /// Returns true if no axis is in both cones.
    fn are_cones_apart(&self) -> bool {
        let ([normal1, normal2], [square1, square2]) = (self.normals, self.cones);
        // The cosine of the sum of both angles.
        let least = (square1 * square2).sqrt() - ((1.0 - square1) * (1.0 - square2)).sqrt();
        normal1.dot(normal2).abs() < least
    }

    /// Returns true unless an edge is perpendicular to no direction of a cone.
    fn may_cross(&self, cone: usize, edge: DVec3) -> bool {
        let height = edge.dot(self.normals[cone]);
        height * height <= (1.0 - self.cones[cone] + ROUNDING) * edge.length_squared()
    }

    /// Returns the extremal axis of least overlap.
    fn extremal_axis(
        &self,
        is_extremal: impl Fn(usize, Feature, DVec3) -> bool,
    ) -> Option<OutwardAxis> {
        if self.are_cones_apart() {
            return None;
        }
        let mut axes = ArrayVec::<OutwardAxis, 22>::new();
        self.for_each(true, |direction, heights| {
            let square = direction.length_squared();
            // Before the division: most directions end here.
            if (0..2).all(|i| heights[i] * heights[i] >= self.cones[i] * square) {
                axes.push(self.axis(direction));
            }
            ControlFlow::Continue(())
        });
        axes.sort_unstable_by(|(a, _), (b, _)| b.total_cmp(a));
        axes.into_iter().find(|(_, axis)| {
            let ways = [*axis, -*axis];
            (0..2).all(|i| is_extremal(i, farthest(&self.triangles[i], ways[i]), ways[i]))
        })
    }

    /// Returns the outward axis of least overlap. Returns `None` if that is less than the overlap
    /// of a gap, `widest`.
    fn least_axis(&self, widest: f64) -> Option<OutwardAxis> {
        let mut least: Option<OutwardAxis> = None;
        self.for_each(false, |direction, _| {
            let axis = self.axis(direction);
            least = least.filter(|known| known.0 >= axis.0).or(Some(axis));
            if axis.0 > widest { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        least.filter(|least| least.0 <= widest)
    }

    /// Returns the gap along a direction of any length, and the axis.
    fn axis(&self, direction: DVec3) -> OutwardAxis {
        let [t1, t2] = &self.triangles;
        let axis = direction.normalize();
        let ([_, max1], [min2, _]) = (t1.shadow(DVec3::ZERO, axis), t2.shadow(DVec3::ZERO, axis));
        (min2 - max1, axis)
    }

    /// Calls `visit` with each direction that leads out of the solids, of any length, and its
    /// heights along both normals, until `visit` breaks. With `in_cones`, may leave out directions
    /// beyond one of the cones.
    fn for_each(&self, in_cones: bool, mut visit: impl FnMut(DVec3, [f64; 2]) -> ControlFlow<()>) {
        let [normal1, normal2] = self.normals;
        let mut consider = |direction: DVec3| {
            let heights = [direction.dot(normal1), -direction.dot(normal2)];
            let most = LEAN * LEAN * direction.length_squared();
            let is_out = |i: usize| {
                !self.is_solid[i] || heights[i] >= 0.0 || heights[i] * heights[i] <= most
            };
            if is_out(0) && is_out(1) {
                visit(direction, heights)
            } else {
                ControlFlow::Continue(())
            }
        };
        for normal in [normal1, normal2] {
            if normal != DVec3::ZERO
                && (consider(normal).is_break() || consider(-normal).is_break())
            {
                return;
            }
        }
        self.for_each_product(in_cones, consider);
    }

    /// Calls `consider` with the products of edges whose signs lead out of both triangles, until
    /// `consider` breaks.
    #[inline(always)]
    fn for_each_product(&self, in_cones: bool, mut consider: impl FnMut(DVec3) -> ControlFlow<()>) {
        let [t1, t2] = &self.triangles;
        let [normal1, normal2] = self.normals;
        let may_count = |edge: DVec3| !in_cones || (0..2).all(|i| self.may_cross(i, edge));
        let [may_count1, may_count2] = [t1, t2].map(|t| t.edges.map(may_count));
        // Edges run around the normals, against the winding if these do.
        let [sign1, sign2] = self.signs;
        let (slopes1, slopes2) = (slopes(t1, sign1 * normal2), slopes(t2, sign2 * normal1));
        for (i, j) in (0..9).map(|pair| (pair / 3, pair % 3)) {
            // Both edges have the sign of the axis if they are in front (see `axes.rs`).
            let (slope1, slope2) = (slopes1[i], slopes2[j]);
            if !(may_count1[i] && may_count2[j]) || slope1 * slope2 < 0.0 {
                continue;
            }
            let (e1, e2) = (sign1 * t1.edges[i], sign2 * t2.edges[j]);
            let cross = e1.cross(e2);
            let least = NEAR_PARALLEL * NEAR_PARALLEL * e1.length_squared() * e2.length_squared();
            if cross.length_squared() <= least {
                continue;
            }
            let sign = slope1 + slope2;
            if sign >= 0.0 && consider(cross).is_break()
                || sign <= 0.0 && consider(-cross).is_break()
            {
                return;
            }
        }
    }
}

/// Returns the contact of overlapping triangles along a unit axis by which triangle 2 leaves
/// triangle 1. `None` if no points are in line with the axis.
pub fn contact_along(triangles: [&[DVec3; 3]; 2], axis: DVec3) -> Option<TriangleContact> {
    along(triangles.map(Triangle::new).each_ref(), axis)
}

fn along([t1, t2]: [&Triangle<'_>; 2], axis: DVec3) -> Option<TriangleContact> {
    let mut points = ManifoldPoints::new();
    clip_triangles(t1, t2, axis, &mut points);
    let contact = deepest(&points, axis)?;
    Some(TriangleContact { features: contact.features.crossing(), ..contact })
}

/// Returns signs with which edges run through a plane; 0 if nearly parallel.
fn slopes(t: &Triangle, normal: DVec3) -> [f64; 3] {
    t.edges.map(|edge| {
        let slope = edge.dot(normal);
        if slope * slope <= STEEP * STEEP * edge.length_squared() { 0.0 } else { slope.signum() }
    })
}

/// The feature that is farthest along an axis.
fn farthest(t: &Triangle, axis: DVec3) -> Feature {
    let heights = t.heights(t.vertices[0], axis);
    let top = heights[0].max(heights[1]).max(heights[2]);
    let is_top = heights.map(|height| height >= top - LEVEL * t.size);
    let first = (0..3).find(|&i| is_top[i] && !is_top[PREVIOUS[i]]);
    match first {
        None => Feature::Face,
        Some(i) if is_top[NEXT[i]] => Feature::Edge(i as u8),
        Some(i) => Feature::Vertex(i as u8),
    }
}
