//! Triangles against a convex shape, a batch at a time: which come within the margin, and at least how far away
//! each of them is.
//!
//! Whatever direction `n` is chosen, the gap between the projections of a triangle and a shape on it, over `|n|`, is not more than
//! their distance. So each direction gives a lower bound, and the greatest counts. Tried over the lanes, in the shape's
//! frame, against its [`Outline`], a box with rounded edges:
//!
//! * the axes of the box, the normal of the triangle, the products of axes and edges: all that tells a box and a triangle
//!   apart that overlap or nearly do;
//! * for each edge the direction to the point of the box next to it: between corners and edges the axes above give a bound
//!   that is too low. For a ball this is the distance itself.
//!
//! Of what is left, shapes that only are somewhere in their outline (cones, polyhedra) are asked for their reach along
//! the triangle's normal.
//!
//! # Rounding
//!
//! In the shape's frame and relative to the middle of its outline, corners are at most `W = |t|∞ + 2·s·M` (`s` the
//! rotation's scale, `M` the tree's magnitude) and off by `γ_5·W`. A direction is used as computed. Projections lose `γ_3·|n|₁·W`,
//! the box's `γ_4·|n|₁·h`, and `|n|₁ <= √3·|n|`; with the difference below `γ_18·(W + h)·|n|`, and the quotient by `|n|`
//! loses `γ_6` of a distance that is at most `2·W + h`: in all below `γ_32·(W + h + r)`, which is taken off each bound.

use glamx::DVec3;
use wide::f32x4;

use super::lane::{Lane, V3, cross, dot, each, sub};
use super::lanes;
use crate::traverse::{Convex, Outline, Probe};
use crate::tree::LeafBatch;
use crate::volumes::rounding::gamma;

/// Squared length below which a direction is not used: its components may have lost digits to underflow.
const SHORTEST_SQUARED: f32 = 1e-30;

/// Tests leaves against a shape. Made once a query.
#[derive(Copy, Clone)]
pub struct ProbeTest<'a, S> {
    shape: &'a S,
    rows: [[f32; 3]; 3],
    /// From the middle of the outline, or the origin of the shape's frame.
    offset: [f32; 3],
    body: Body,
    is_exact: bool,
    centre: DVec3,
    margin: f32,
    rounding: f32,
}

#[derive(Copy, Clone)]
enum Body {
    RoundBox { half_lengths: [f32; 3], radius: f32 },
    HalfSpace { normal: [f32; 3] },
}

impl<'a, S: Convex> ProbeTest<'a, S> {
    /// For the pose and margin of `probe`.
    pub fn new<const AXES: usize>(probe: &Probe<'a, S, AXES>) -> Self {
        let (body, centre, is_exact, size) = match probe.outline {
            Outline::RoundBox { centre, half_lengths, radius, is_exact } => {
                // Rounded up, so that the body still contains the shape.
                let half_lengths = half_lengths.to_array().map(|x| (x as f32).next_up());
                let radius = (radius as f32).next_up();
                let size = half_lengths.into_iter().fold(radius, |sum, x| sum + x);
                (Body::RoundBox { half_lengths, radius }, centre, is_exact, size)
            }
            Outline::HalfSpace { normal } => {
                (Body::HalfSpace { normal: normal.as_vec3().to_array() }, DVec3::ZERO, true, 0.0)
            }
        };
        let rotation = probe.placement.rotation;
        let offset = probe.placement.translation - centre;
        let scale = rotation.row(0).length().max(1.0) as f32;
        let largest = offset.abs().max_element() as f32 + 2.0 * scale * probe.magnitude;
        Self {
            shape: probe.shape,
            rows: [0, 1, 2].map(|i| rotation.row(i).as_vec3().to_array()),
            offset: offset.as_vec3().to_array(),
            body,
            is_exact,
            centre,
            margin: (probe.margin as f32).next_up(),
            rounding: gamma(32) * (largest + size),
        }
    }

    /// Calls `found(lane, distance)` for the triangles that no direction shows to be beyond the margin, with a distance that
    /// is not more than the true one; negative where they overlap.
    #[inline]
    pub fn survivors(&self, batch: &LeafBatch, mut found: impl FnMut(usize, f64)) {
        let corners = self.placed(&lanes(&batch.corners, f32x4::new));
        let distances = match &self.body {
            Body::RoundBox { half_lengths, radius } => {
                let margin = self.margin + radius + self.rounding;
                box_distances(&corners, half_lengths, margin) - f32x4::splat(*radius)
            }
            Body::HalfSpace { normal } => {
                let [a, b, c] = each(|i| dot(corners[i], each(|axis| f32x4::splat(normal[axis]))));
                a.smaller(b).smaller(c)
            }
        };
        let distances = distances - f32x4::splat(self.rounding);
        let used = (1 << batch.count()) - 1;
        let mut near = distances.simd_le(f32x4::splat(self.margin)).to_bitmask() & used;
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            let mut distance = f64::from(distances.to_array()[lane]);
            if !self.is_exact {
                let corners = corners.map(|c| DVec3::from_array(c.map(|x| f64::from(x.to_array()[lane]))));
                distance = distance.max(self.gap_along_normal(corners));
            }
            if distance <= f64::from(self.margin) {
                found(lane, distance);
            }
        }
    }

    /// The corners in the shape's frame, from the middle of its outline.
    #[inline(always)]
    fn placed(&self, corners: &[V3<f32x4>; 3]) -> [V3<f32x4>; 3] {
        each(|corner| {
            each(|i| {
                let row = each(|j| f32x4::splat(self.rows[i][j]));
                dot(row, corners[corner]) + f32x4::splat(self.offset[i])
            })
        })
    }

    /// A bound from the normal of a triangle, corners as of [`placed`](Self::placed). Not larger than anything if there is
    /// no normal.
    fn gap_along_normal(&self, [a, b, c]: [DVec3; 3]) -> f64 {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal == DVec3::ZERO {
            return f64::NEG_INFINITY;
        }
        // Away from the middle of the shape.
        let normal = if normal.dot(a) < 0.0 { -normal } else { normal };
        let lowest = [a, b, c].into_iter().map(|x| normal.dot(x)).fold(f64::INFINITY, f64::min);
        lowest + normal.dot(self.centre) - self.shape.reach(normal) - f64::from(self.rounding)
    }
}

/// Lower bounds of the distances of triangles to a box around the origin, without rounding. Not all directions are
/// tried once all bounds are beyond `margin`.
#[inline(always)]
fn box_distances(corners: &[V3<f32x4>; 3], half_lengths: &[f32; 3], margin: f32) -> f32x4 {
    let half = each(|axis| f32x4::splat(half_lengths[axis]));
    let [a, b, c] = corners;
    let along = |axis: usize| {
        let low = a[axis].smaller(b[axis]).smaller(c[axis]);
        let high = a[axis].larger(b[axis]).larger(c[axis]);
        low.larger(f32x4::splat(0.0) - high) - half[axis]
    };
    let mut bound = along(0).larger(along(1)).larger(along(2));
    let is_far = |bound: f32x4| bound.simd_le(f32x4::splat(margin)).to_bitmask() == 0;
    if is_far(bound) {
        return bound;
    }
    let edges = each(|i| sub(corners[(i + 1) % 3], corners[i]));
    bound = better(bound, cross(edges[0], edges[1]), corners, &half);
    if is_far(bound) {
        return bound;
    }
    for (i, edge) in edges.into_iter().enumerate() {
        bound = better(bound, to_edge(corners[i], edge, &half), corners, &half);
    }
    if is_far(bound) {
        return bound;
    }
    let zero = f32x4::splat(0.0);
    for axis in (0..3).filter(|&axis| half_lengths[axis] > 0.0) {
        let unit = each(|i| if i == axis { f32x4::splat(1.0) } else { zero });
        for edge in edges {
            bound = better(bound, cross(unit, edge), corners, &half);
        }
    }
    bound
}

/// The greater of a bound and that along a direction.
#[inline(always)]
fn better(bound: f32x4, n: V3<f32x4>, corners: &[V3<f32x4>; 3], half: &V3<f32x4>) -> f32x4 {
    let [a, b, c] = each(|i| dot(n, corners[i]));
    let low = a.smaller(b).smaller(c);
    let high = a.larger(b).larger(c);
    let reach = dot(each(|axis| n[axis].abs()), *half);
    let squared = dot(n, n);
    let gap = low.larger(f32x4::splat(0.0) - high) - reach;
    let distance = gap / squared.sqrt();
    let is_usable = squared.simd_gt(f32x4::splat(SHORTEST_SQUARED)) & distance.simd_gt(bound);
    is_usable.select(distance, bound)
}

/// From the box to a point of an edge that is close to it: two steps of alternating projection.
#[inline(always)]
fn to_edge(start: V3<f32x4>, edge: V3<f32x4>, half: &V3<f32x4>) -> V3<f32x4> {
    let clamped = |x: f32x4, low: f32x4, high: f32x4| x.larger(low).smaller(high);
    let in_box = |x: V3<f32x4>| each(|i| clamped(x[i], f32x4::splat(0.0) - half[i], half[i]));
    let point_at = |t: f32x4| each(|i| start[i] + edge[i] * t);
    let target = in_box(point_at(f32x4::splat(0.5)));
    let (zero, one) = (f32x4::splat(0.0), f32x4::splat(1.0));
    // Not a number for an edge without length: the comparisons of `clamped` make it 0.
    let t = clamped(dot(sub(target, start), edge) / dot(edge, edge), zero, one);
    let point = point_at(t);
    sub(point, in_box(point))
}
