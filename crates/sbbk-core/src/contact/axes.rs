//! Separating axes: both face normals and the cross products of two edges.
//!
//! Along `n = e1 x e2`, or its opposite, the triangles can be closest or overlap least only if both
//! edges are in front. Then triangle 1 lies behind `e1` and triangle 2 beyond `e2`. With face
//! normals `n1` and `n2`, the third vertex of triangle 1 is at `-n1 . e2` from its edge. The third
//! vertex of triangle 2 is at `n2 . e1`. So the edge pair counts only if `n1 . e2` and `n2 . e1`
//! have the same sign, which is the sign of the axis. On each side one of three products differs in
//! sign from the other two, which leaves four or five pairs. (These pairs make the faces of the
//! Minkowski difference. A product of 0 stands for the axis of a face.) The gap is the distance
//! between the edges.
//!
//! S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996; D. Gregorius, "The Separating Axis Test
//! between Convex Polyhedra", 2013.

use super::closest::TIE;
use super::feature::{Feature, FeaturePair};
use super::triangle::{NEAR_PARALLEL, Triangle, perpendicular};
use crate::simd::bits;
use glamx::DVec3;

/// A unit axis from triangle 1 to triangle 2 and the gap between the shadows on it.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    /// Negative when the shadows overlap; minus infinity for no axis at all.
    pub gap: f64,
    pub normal: DVec3,
    /// [`FeaturePair`] as bits in a whole word. A byte beside padding would make each copy wait for
    /// its store.
    features: u64,
}

impl Axis {
    pub const NONE: Self = Self { gap: f64::NEG_INFINITY, normal: DVec3::ZERO, features: 0 };

    #[inline(always)]
    fn new(gap: f64, normal: DVec3, features: FeaturePair) -> Self {
        Self { gap, normal, features: features.to_bits().into() }
    }

    /// The features that give the axis: a face and the vertex nearest to it, or two edges.
    #[inline(always)]
    pub fn features(&self) -> FeaturePair {
        FeaturePair::from_bits(self.features as u8)
    }

    /// The better one of both directions of an axis, by all six vertices.
    pub fn along(t1: &Triangle, t2: &Triangle, normal: DVec3, features: FeaturePair) -> Self {
        let origin = t1.vertices[0];
        let ([min1, max1], [min2, max2]) = (t1.shadow(origin, normal), t2.shadow(origin, normal));
        let (up, down) = (min2 - max1, min1 - max2);
        let (gap, normal) = if up >= down { (up, normal) } else { (down, -normal) };
        Self::new(gap, normal, features)
    }
}

/// Both face normals as axes.
pub(super) struct FaceAxes {
    /// The one with the wider gap.
    pub best: Axis,
    /// The other one.
    pub other: Axis,
    /// Area vectors of both triangles, twice as long as the areas.
    normals: [DVec3; 2],
}

impl FaceAxes {
    #[inline(always)]
    pub fn new(t1: &Triangle, t2: &Triangle) -> Self {
        let [(normal1, area1), (normal2, area2)] = [t1.normal_and_area(), t2.normal_and_area()];
        let normals = [normal1 * area1, normal2 * area2];
        let (j, gap1, normal1) = nearest_vertex(t2.heights(t1.vertices[0], normal1), normal1);
        let (i, gap2, normal2) = nearest_vertex(t1.heights(t2.vertices[0], normal2), normal2);
        let features1 = FeaturePair::new(Feature::Face, Feature::Vertex(j));
        let features2 = FeaturePair::new(Feature::Vertex(i), Feature::Face);
        let axis1 = Axis::new(gap1, normal1, features1);
        let axis2 = Axis::new(gap2, -normal2, features2);
        let (best, other) = if gap2 > gap1 { (axis2, axis1) } else { (axis1, axis2) };
        Self { best, other, normals }
    }
}

/// The vertex nearest to a plane, how far in front of it all vertices are, and from which side.
/// A triangle without area is no plane.
#[inline(always)]
fn nearest_vertex([a, b, c]: [f64; 3], normal: DVec3) -> (u8, f64, DVec3) {
    let (i, low) = least([a, b, c]);
    let (j, high) = least([-a, -b, -c]);
    if normal == DVec3::ZERO {
        (0, f64::NEG_INFINITY, normal)
    } else if low >= high {
        (i, low, normal)
    } else {
        (j, high, -normal)
    }
}

#[inline(always)]
fn least([a, b, c]: [f64; 3]) -> (u8, f64) {
    let (i, least) = if b < a { (1, b) } else { (0, a) };
    if c < least { (2, c) } else { (i, least) }
}

/// The best of both face normals and the nine edge pairs; at a tie a face.
pub(super) fn best_axis(t1: &Triangle, t2: &Triangle, faces: &FaceAxes) -> Axis {
    let slack = TIE * (t1.size + t2.size);
    let [lengths1, lengths2] = [squared_lengths(t1), squared_lengths(t2)];
    let [behind1, behind2] = [behind(t1, faces.normals[1]), behind(t2, faces.normals[0])];
    let (mut widest, mut winner, mut parallel) = (faces.best.gap + slack, None, 0_u32);
    for pair in bits(matching(behind1, behind2)) {
        let (i, j) = (pair / 3, pair % 3);
        let cross = t1.edges[i].cross(t2.edges[j]);
        let area = cross.length_squared();
        if area < NEAR_PARALLEL * NEAR_PARALLEL * lengths1[i] * lengths2[j] {
            parallel |= 1 << pair;
            continue;
        }
        let d = (t2.vertices[j] - t1.vertices[i]).dot(cross);
        let gap = if behind1 >> i & 1 == 0 { d } else { -d } / area.sqrt();
        if gap > widest {
            (widest, winner) = (gap, Some((i, j)));
        }
    }
    let best = winner.map_or(faces.best, |(i, j)| edge_axis(t1, i, t2, j, behind1 >> i & 1 != 0));
    bits(parallel).fold(best, |best, pair| {
        let axis = near_parallel(t1, pair / 3, t2, pair % 3);
        if axis.gap > best.gap + slack { axis } else { best }
    })
}

/// Mask of the edges that run against a direction.
#[inline(always)]
fn behind(t: &Triangle, direction: DVec3) -> u32 {
    let bit = |i: usize| u32::from(t.edges[i].dot(direction) < 0.0) << i;
    bit(0) | bit(1) | bit(2)
}

/// Mask of the pairs, with bit `3 i + j`, in which both edges have the same bit.
#[inline(always)]
fn matching(bits1: u32, bits2: u32) -> u32 {
    let row = |i: u32| ((bits1 >> i & 1).wrapping_sub(1) ^ bits2) & 0b111;
    row(0) | row(1) << 3 | row(2) << 6
}

#[inline(always)]
fn squared_lengths(t: &Triangle) -> [f64; 3] {
    let [a, b, c] = t.edges;
    [a.length_squared(), b.length_squared(), c.length_squared()]
}

#[inline(always)]
fn edge_axis(t1: &Triangle, i: usize, t2: &Triangle, j: usize, is_reversed: bool) -> Axis {
    let cross = t1.edges[i].cross(t2.edges[j]);
    let normal = cross * (if is_reversed { -1.0 } else { 1.0 } / cross.length());
    let gap = (t2.vertices[j] - t1.vertices[i]).dot(normal);
    Axis::new(gap, normal, edge_pair(i, j))
}

fn edge_pair(i: usize, j: usize) -> FeaturePair {
    FeaturePair::new(Feature::Edge(i as u8), Feature::Edge(j as u8))
}

fn near_parallel(t1: &Triangle, i: usize, t2: &Triangle, j: usize) -> Axis {
    perpendicular(t1.edges[i], t2.edges[j])
        .map_or(Axis::NONE, |normal| Axis::along(t1, t2, normal, edge_pair(i, j)))
}
