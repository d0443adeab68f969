//! The contact points between a triangle and another one, or a feature of a shape, that face each
//! other along a normal.
//!
//! Seen along the normal, the overlap of two triangles is a polygon. Its corners are vertices of
//! one triangle inside the other, and crossings of two edges. The distance along the normal is
//! linear over the polygon, so it takes its extremes at the corners. One table of signs gives all
//! corners: the side of each edge of one triangle on which each vertex of the other lies.
//! Features of two to four corners overlap triangles in the same way.
//!
//! **Capacity.** Each triangle has three vertices. Among three signs around a triangle at most two
//! neighbours differ, so an edge crosses at most two edges. So there are at most six crossings and
//! twelve points, for any rounding of the signs. The closest points are the thirteenth.

use super::TriangleContact;
use super::closest::{TIE, within_edge};
use super::feature::{Feature, FeaturePair};
use super::shadow_signs::{EdgeCrossing, ShadowSigns};
use super::triangle::{NEAR_PARALLEL, Polygon, Triangle};
use crate::simd::bits;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Least sine between the normal and a triangle's plane at which points are projected to that
/// plane. Lower: points slide far along a triangle that is seen edge-on. Higher: steep triangles
/// lose points, and only their edges are left.
const EDGE_ON: f64 = 1.0e-5;

/// Closest points within this fraction of the smaller triangle's size count as one point. Higher:
/// points are lost. Lower: points come twice.
const SAME_POINT: f64 = 1.0e-6;

/// Points that a manifold of two triangles can have.
const MANIFOLD_CAPACITY: usize = 13;

/// The contact points of two triangles.
pub type ManifoldPoints = ArrayVec<ManifoldPoint, MANIFOLD_CAPACITY>;

/// A point on each triangle, both on one line along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldPoint {
    /// The point on triangle 1.
    pub point1: DVec3,
    /// The point on triangle 2, in the same frame.
    pub point2: DVec3,
    /// From point 1 to point 2 along the normal; negative when triangle 2 is behind triangle 1.
    pub distance: f64,
    /// The features that meet: a vertex and a face, or two edges. The closest points, added by
    /// [`push_closest`], may have any features. Unique among the points of a manifold, and stable
    /// while the triangles slide.
    pub features: FeaturePair,
}

/// Fills `out` with the corners of the overlap of both triangles, seen along `normal`, a unit
/// vector from triangle 1 to triangle 2. The order is: vertices of triangle 1, vertices of triangle
/// 2, edge crossings. Points at all distances are kept; the caller drops those beyond its margin.
/// `out` is empty if the triangles do not overlap in this view.
pub fn clip(t1: &[DVec3; 3], t2: &[DVec3; 3], normal: DVec3, out: &mut ManifoldPoints) {
    clip_triangles(&Triangle::new(t1), &Triangle::new(t2), normal, out);
}

/// Adds the closest points of `contact` unless the manifold already has them, by place or by
/// features.
pub fn push_closest(
    t1: &[DVec3; 3],
    t2: &[DVec3; 3],
    contact: &TriangleContact,
    out: &mut ManifoldPoints,
) {
    let [size1, size2] = [t1, t2].map(|t| Triangle::new(t).size);
    let reach = SAME_POINT * if size1 < size2 { size1 } else { size2 };
    let is_same = |a: DVec3, b: DVec3| (a - b).length_squared() <= reach * reach;
    let TriangleContact { point1, point2, distance, .. } = *contact;
    let features = FeaturePair::new(contact.features.feature1(), contact.features.feature2());
    let is_known = |p: &ManifoldPoint| {
        p.features == features || is_same(p.point1, point1) && is_same(p.point2, point2)
    };
    if !out.iter().any(is_known) {
        out.push(ManifoldPoint { point1, point2, distance, features });
    }
}

pub(super) fn clip_triangles(
    t1: &Triangle,
    t2: &Triangle,
    normal: DVec3,
    out: &mut ManifoldPoints,
) {
    out.clear();
    let polygon = Polygon { corners: t2.vertices, face: Some(*t2), size: t2.size, tie: TIE };
    clip_polygon(t1, &polygon, normal, |[point1, point2], distance, [feature1, feature2]| {
        let features = FeaturePair::new(feature1, feature2);
        out.push(ManifoldPoint { point1, point2, distance, features });
    });
}

/// Calls `found` with the corners of the overlap of a triangle and a polygon, seen along `normal`.
/// Each has its points on both, the distance between these, and its features.
#[inline(always)]
pub(super) fn clip_polygon(
    t: &Triangle,
    polygon: &Polygon,
    normal: DVec3,
    mut found: impl FnMut([DVec3; 2], f64, [Feature; 2]),
) {
    let corners = polygon.corners;
    let signs = ShadowSigns::new(t, polygon, normal);
    let [of_triangle, of_polygon] = signs.inside();
    if let Some(face) = &polygon.face {
        let may_be_thin = corners.len() == 3;
        for_feet(t.vertices, of_triangle, (face, may_be_thin), normal, |v, foot, height| {
            let features = [Feature::Vertex(v as u8), Feature::Face];
            found([t.vertices[v], foot], -height, features);
        });
    }
    for_feet(corners, of_polygon, (t, true), normal, |v, foot, height| {
        found([foot, corners[v]], height, [Feature::Face, Feature::Vertex(v as u8)]);
    });
    for bit in bits(signs.crossings()) {
        let crossing = signs.crossing(bit);
        let features = crossing.edges.map(|edge| Feature::Edge(edge as u8));
        let points @ [point1, point2] = crossing_points(t, polygon, &crossing, normal);
        found(points, (point2 - point1).dot(normal), features);
    }
}

/// Returns the points of both edges at a crossing.
#[inline(always)]
fn crossing_points(
    t: &Triangle,
    &Polygon { corners, size, .. }: &Polygon,
    crossing: &EdgeCrossing,
    normal: DVec3,
) -> [DVec3; 2] {
    let ([i, j], [along1, mut along2]) = (crossing.edges, crossing.along);
    let point1 = t.vertices[i] + t.edges[i] * along1;
    let (start, end) = (corners[j], *corners.get(j + 1).unwrap_or(&corners[0]));
    let edge = end - start;
    if crossing.area < NEAR_PARALLEL * t.size * size {
        along2 = along_in_line(point1 - start, edge, normal);
    }
    [point1, start + edge * along2]
}

/// Place on an edge that is closest to being in line with a point, as a fraction of the edge. Both
/// places of a crossing are uncertain if the edges are near parallel; this one fits the other. The
/// point is seen from the start of the edge.
#[cold]
fn along_in_line(point: DVec3, edge: DVec3, normal: DVec3) -> f64 {
    let shadow = edge - normal * edge.dot(normal);
    within_edge(point.dot(shadow) / shadow.length_squared())
}

/// Calls `found` with the vertices whose bits are set, their feet in the plane of a face along
/// `normal`, and their heights. `may_be_thin`: false for a face that is a part of a polygon.
#[inline(always)]
fn for_feet(
    vertices: &[DVec3],
    inside: u32,
    (face, may_be_thin): (&Triangle, bool),
    normal: DVec3,
    mut found: impl FnMut(usize, DVec3, f64),
) {
    if inside == 0 {
        return;
    }
    let area = face.area_vector();
    let (area_squared, cosine) = (area.length_squared(), area.dot(normal));
    if cosine * cosine <= EDGE_ON * EDGE_ON * area_squared {
        return;
    }
    let is_thin = may_be_thin && face.is_thin(area_squared);
    let slope = area * (1.0 / cosine);
    for v in bits(inside) {
        let height = (vertices[v] - face.vertices[0]).dot(slope);
        let foot = vertices[v] - normal * height;
        if !is_thin || face.is_beside(foot) {
            found(v, foot, height);
        }
    }
}
