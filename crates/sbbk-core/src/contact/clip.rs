//! The contact points between two triangles that face each other along a normal.
//!
//! Seen along the normal, the overlap of two triangles is a polygon. Its corners are vertices of
//! one triangle inside the other, and crossings of two edges. The distance along the normal is
//! linear over the polygon, so it takes its extremes at the corners. One table of signs gives all
//! corners: the side of each edge of one triangle on which each vertex of the other lies.
//!
//! **Capacity.** Each triangle has three vertices. Among three signs around a triangle at most two
//! neighbours differ, so an edge crosses at most two edges. So there are at most six crossings and
//! twelve points, for any rounding of the signs. The closest points are the thirteenth.

use super::TriangleContact;
use super::closest::within_edge;
use super::feature::{Feature, FeaturePair};
use super::shadow_signs::{EdgeCrossing, ShadowSigns};
use super::triangle::{NEAR_PARALLEL, Triangle};
use crate::simd::bits;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Least sine between the normal and a triangle's plane at which points are projected to that
/// plane. Lower: points slide far along a triangle that is seen edge-on. Higher: steep triangles
/// lose points, and only their edges are left.
pub(super) const EDGE_ON: f64 = 1.0e-5;

/// Closest points within this fraction of the smaller triangle's size count as one point. Higher:
/// points are lost. Lower: points come twice.
const SAME_POINT: f64 = 1.0e-6;

/// Points that a manifold of two triangles can have.
pub(super) const MANIFOLD_CAPACITY: usize = 13;

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
    let signs = ShadowSigns::new(t1, t2, normal);
    let inside = signs.inside();
    for k in 0..2 {
        push_vertices([t1, t2], k, inside[k], normal, out);
    }
    for bit in bits(signs.crossings()) {
        out.push(crossing_point(t1, t2, &signs.crossing(bit), normal));
    }
}

#[inline(always)]
fn crossing_point(
    t1: &Triangle,
    t2: &Triangle,
    crossing: &EdgeCrossing,
    normal: DVec3,
) -> ManifoldPoint {
    let ([i, j], [along1, mut along2]) = (crossing.edges, crossing.along);
    let point1 = t1.vertices[i] + t1.edges[i] * along1;
    if crossing.area < NEAR_PARALLEL * t1.size * t2.size {
        along2 = along_in_line(point1, t2, j, normal);
    }
    let point2 = t2.vertices[j] + t2.edges[j] * along2;
    let distance = (point2 - point1).dot(normal);
    let features = FeaturePair::new(Feature::Edge(i as u8), Feature::Edge(j as u8));
    ManifoldPoint { point1, point2, distance, features }
}

/// Place on an edge that is closest to being in line with a point, as a fraction of the edge. Both
/// places of a crossing are uncertain if the edges are near parallel; this one fits the other.
#[cold]
fn along_in_line(point: DVec3, t: &Triangle, j: usize, normal: DVec3) -> f64 {
    let shadow = t.edges[j] - normal * t.edges[j].dot(normal);
    within_edge((point - t.vertices[j]).dot(shadow) / shadow.length_squared())
}

/// Adds the vertices of triangle `k` (0 or 1) whose bits are set. Each vertex gets the point in
/// line with it in the plane of the other triangle.
#[inline(always)]
fn push_vertices(
    triangles: [&Triangle; 2],
    k: usize,
    vertices: u32,
    normal: DVec3,
    out: &mut ManifoldPoints,
) {
    if vertices == 0 {
        return;
    }
    let (own, other) = (triangles[k], triangles[1 - k]);
    let face = other.area_vector();
    let (area_squared, cosine) = (face.length_squared(), face.dot(normal));
    if cosine * cosine <= EDGE_ON * EDGE_ON * area_squared {
        return;
    }
    let is_thin = other.is_thin(area_squared);
    let slope = face * (1.0 / cosine);
    for v in bits(vertices) {
        let vertex = own.vertices[v];
        let height = (vertex - other.vertices[0]).dot(slope);
        let foot = vertex - normal * height;
        if is_thin && !other.is_beside(foot) {
            continue;
        }
        let features = FeaturePair::new(Feature::Vertex(v as u8), Feature::Face);
        out.push(if k == 0 {
            ManifoldPoint { point1: vertex, point2: foot, distance: -height, features }
        } else {
            let features = features.swapped();
            ManifoldPoint { point1: foot, point2: vertex, distance: height, features }
        });
    }
}
