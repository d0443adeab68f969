//! Separating axes: both face normals and the nine cross products of two edges.
//!
//! On the axis `n = e1 x e2` triangle 1 casts the shadow `[0, a]`, where 0 is the edge and `a`
//! the opposite vertex, and triangle 2 `[d, d + b]`, with `d` from edge to edge:
//!
//! ```text
//! a = -n1 . e2,    b = n2 . e1,    d = w . n
//! ```
//!
//! where `n1` and `n2` are the face normals, as long as twice the areas, and `w` leads from the
//! start of one edge to that of the other. So six products serve all `a` and `b`. Three axes,
//! one edge of triangle 1 against all of triangle 2, go through the SIMD lanes at once.
//!
//! S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996.

use super::closest::TIE;
use super::feature::{Feature, FeaturePair};
use super::lanes::{self, Lanes};
use super::triangle::{NEAR_PARALLEL, Triangle, perpendicular};
use glamx::DVec3;
use wide::f64x4;

/// A unit axis from triangle 1 to triangle 2 and the gap between the shadows on it.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    /// Negative when the shadows overlap; minus infinity for no axis at all.
    pub gap: f64,
    pub normal: DVec3,
    pub features: FeaturePair,
}

impl Axis {
    pub const NONE: Self = Self {
        gap: f64::NEG_INFINITY,
        normal: DVec3::ZERO,
        features: FeaturePair::new(Feature::Face, Feature::Face),
    };

    /// The better one of both directions of an axis, by all six vertices.
    pub fn along(t1: &Triangle, t2: &Triangle, normal: DVec3, features: FeaturePair) -> Self {
        let origin = t1.vertices[0];
        let ([min1, max1], [min2, max2]) = (t1.shadow(origin, normal), t2.shadow(origin, normal));
        let (up, down) = (min2 - max1, min1 - max2);
        let (gap, normal) = if up >= down { (up, normal) } else { (down, -normal) };
        Self { gap, normal, features }
    }
}

/// Both face normals as axes.
pub(super) struct FaceAxes {
    /// The one with the wider gap.
    pub best: Axis,
    /// The other one.
    pub other: Axis,
    /// Of both triangles, as long as twice their areas.
    normals: [DVec3; 2],
}

impl FaceAxes {
    #[inline(always)]
    pub fn new(t1: &Triangle, t2: &Triangle) -> Self {
        let [(normal1, area1), (normal2, area2)] = [t1.normal_and_area(), t2.normal_and_area()];
        let normals = [normal1 * area1, normal2 * area2];
        let (j, gap1, normal1) = nearest(t2.heights(t1.vertices[0], normal1), normal1);
        let (i, gap2, normal2) = nearest(t1.heights(t2.vertices[0], normal2), normal2);
        let features1 = FeaturePair::new(Feature::Face, Feature::Vertex(j));
        let features2 = FeaturePair::new(Feature::Vertex(i), Feature::Face);
        let axis1 = Axis { gap: gap1, normal: normal1, features: features1 };
        let axis2 = Axis { gap: gap2, normal: -normal2, features: features2 };
        let (best, other) = if gap2 > gap1 { (axis2, axis1) } else { (axis1, axis2) };
        Self { best, other, normals }
    }
}

/// The vertex nearest to a plane, how far in front of it all vertices are, and from which side.
/// A triangle without area is no plane.
#[inline(always)]
fn nearest([a, b, c]: [f64; 3], normal: DVec3) -> (u8, f64, DVec3) {
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
    let (edges2, starts2) = (Lanes::new(&t2.edges), Lanes::new(t2.vertices));
    let a = -edges2.dot(Lanes::splat(faces.normals[0]));
    let (zero, close) = (f64x4::ZERO, f64x4::splat(NEAR_PARALLEL * NEAR_PARALLEL));
    let (a_low, a_high, lengths2) =
        (a.fast_min(zero), a.fast_max(zero), edges2.dot(edges2) * close);
    let bar = faces.best.gap + TIE * (t1.size + t2.size);
    let (mut best, mut rows) = (f64x4::splat(bar), zero);
    let mut parallel = 0;
    for i in 0..3 {
        let edge1 = Lanes::splat(t1.edges[i]);
        let normal = edge1.cross(edges2);
        let area = normal.dot(normal);
        let d = (starts2 - Lanes::splat(t1.vertices[i])).dot(normal);
        let b = faces.normals[1].dot(t1.edges[i]);
        let up = d + f64x4::splat(b.min(0.0)) - a_high;
        let down = a_low - d - f64x4::splat(b.max(0.0));
        let gap = up.fast_max(down) / area.sqrt();
        let is_clear = area.simd_ge(lengths2 * f64x4::splat(t1.edges[i].length_squared()));
        let better = gap.simd_gt(best) & is_clear;
        best = better.select(gap, best);
        rows = better.select(f64x4::splat(i as f64), rows);
        parallel |= (!is_clear.to_bitmask() & lanes::USED) << (3 * i);
    }
    let [x, y, z, _] = best.to_array();
    let (j, gap) = if y > x { (1, y) } else { (0, x) };
    let (j, gap) = if z > gap { (2, z) } else { (j, gap) };
    let i = rows.to_array()[j] as usize;
    let axis = if gap > bar { edge_axis(t1, i, t2, j) } else { faces.best };
    if parallel == 0 { axis } else { best_with_parallel(t1, t2, axis, parallel) }
}

/// The better one of `best` and those edge pairs whose bit `3 i + j` is set.
#[cold]
fn best_with_parallel(t1: &Triangle, t2: &Triangle, best: Axis, pairs: u32) -> Axis {
    let slack = TIE * (t1.size + t2.size);
    (0..9).filter(|pair| pairs & (1 << pair) != 0).fold(best, |best, pair| {
        let axis = near_parallel(t1, pair / 3, t2, pair % 3);
        if axis.gap > best.gap + slack { axis } else { best }
    })
}

fn edge_axis(t1: &Triangle, i: usize, t2: &Triangle, j: usize) -> Axis {
    let cross = t1.edges[i].cross(t2.edges[j]);
    let d = (t2.vertices[j] - t1.vertices[i]).dot(cross);
    let (a, b) = (t1.opposite(i).dot(cross), t2.opposite(j).dot(cross));
    let up = d + b.min(0.0) - a.max(0.0);
    let down = a.min(0.0) - d - b.max(0.0);
    let scale = 1.0 / cross.length();
    let (gap, scale) = if up >= down { (up * scale, scale) } else { (down * scale, -scale) };
    Axis { gap, normal: cross * scale, features: edge_pair(i, j) }
}

fn edge_pair(i: usize, j: usize) -> FeaturePair {
    FeaturePair::new(Feature::Edge(i as u8), Feature::Edge(j as u8))
}

fn near_parallel(t1: &Triangle, i: usize, t2: &Triangle, j: usize) -> Axis {
    perpendicular(t1.edges[i], t2.edges[j])
        .map_or(Axis::NONE, |normal| Axis::along(t1, t2, normal, edge_pair(i, j)))
}
