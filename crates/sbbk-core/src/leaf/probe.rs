//! Triangles against a convex shape, a batch at a time: which come within the margin, and at least
//! how far away each of them is.
//!
//! Whatever direction `n` is chosen, the gap between the projections of a triangle and a shape on
//! it, over `|n|`, is not more than their distance. So each direction gives a lower bound, and the
//! greatest counts. Tried over the lanes, in the shape's frame, against its [`Outline`], a box with
//! rounded edges:
//!
//! * the axes of the box (the gaps along them add up as sides of a box do), the normal of the
//!   triangle, the products of axes and edges: all that tells a box and a triangle apart that
//!   overlap or nearly do;
//! * for each edge the direction to the point of the box next to it: between corners and edges the
//!   axes above give a bound that is too low. For a ball this is the distance itself.
//!
//! Of what is left, shapes that only are somewhere in their outline (cones, polyhedra) are asked
//! for their reach along the triangle's normal.
//!
//! # Rounding
//!
//! In the shape's frame and relative to the middle of its outline, corners are at most `W = |t|∞ +
//! 2·s·M` (`s` the rotation's scale, `M` the tree's magnitude) and off by `γ_5·W`. A direction is
//! used as computed. Projections lose `γ_3·|n|₁·W`, the box's `γ_4·|n|₁·h`, and `|n|₁ <= √3·|n|`;
//! with the difference below `γ_18·(W + h)·|n|`, and the quotient by `|n|` loses `γ_6` of a
//! distance that is at most `2·W + h`: in all below `γ_32·(W + h + radius)`, which is taken off
//! each bound.

use glamx::{DVec3, Vec3};
use wide::f32x4;

use super::used;
use crate::simd::{V3, cross, dot, each, each_bit, largest, smallest, sub};
use crate::traverse::{Convex, Outline, Probe};
use crate::tree::LeafBatch;
use crate::volumes::rounding::gamma;

/// Squared length below which a direction is not used: its components may have lost digits to
/// underflow.
const SHORTEST_SQUARED: f32 = 1e-30;

/// The largest coordinate of which products of four, times 192, do not overflow: the squared length
/// of the product of two edges.
const LARGEST: f32 = 1e9;

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
    /// No further direction is tried where bounds are beyond this; minus infinity where coordinates
    /// are so large that products of them overflow.
    enough: f32,
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
        let (body, centre, is_exact, size, radius) = match probe.outline {
            Outline::RoundBox { centre, half_lengths, radius, is_exact } => {
                // Rounded up, so that the body still contains the shape.
                let half_lengths = each(|i| (half_lengths[i] as f32).next_up());
                let radius = (radius as f32).next_up();
                let size = half_lengths.into_iter().fold(radius, |sum, x| sum + x);
                (Body::RoundBox { half_lengths, radius }, centre, is_exact, size, radius)
            }
            Outline::HalfSpace { normal } => {
                let body = Body::HalfSpace { normal: normal.as_vec3().to_array() };
                (body, DVec3::ZERO, true, 0.0, 0.0)
            }
        };
        let rotation = probe.placement.rotation;
        let offset = probe.placement.translation - centre;
        let scale = rotation.row(0).length().max(1.0) as f32;
        let largest = offset.abs().max_element() as f32 + 2.0 * scale * probe.magnitude;
        let rounding = gamma(32) * (largest + size);
        let margin = (probe.margin as f32).next_up();
        let enough =
            if largest <= LARGEST { margin + radius + rounding } else { f32::NEG_INFINITY };
        Self {
            shape: probe.shape,
            rows: each(|i| rotation.row(i).as_vec3().to_array()),
            offset: offset.as_vec3().to_array(),
            body,
            is_exact,
            centre,
            margin,
            enough,
            rounding,
        }
    }

    /// Calls `found(lane, distance, axis)` for the triangles that no direction shows to be beyond
    /// the margin, with a distance that is not more than the true one, negative where they overlap,
    /// and the direction in the shape's frame, from the shape to the triangle and of any length,
    /// that shows it; zero if there is none.
    #[inline]
    pub fn survivors(&self, batch: &LeafBatch, mut found: impl FnMut(usize, f64, Vec3)) {
        let corners = self.placed(&batch.lanes());
        let best = match &self.body {
            Body::RoundBox { half_lengths, radius } => {
                let best = box_distances(&corners, half_lengths, self.enough);
                Best { distance: best.distance - f32x4::splat(*radius), ..best }
            }
            Body::HalfSpace { normal } => {
                let axis = each(|i| f32x4::splat(normal[i]));
                Best { distance: smallest(each(|i| dot(corners[i], axis))), axis }
            }
        };
        let distances = best.distance - f32x4::splat(self.rounding);
        let near = distances.simd_le(f32x4::splat(self.margin)).to_bitmask() & used(batch);
        each_bit(near, |lane| {
            let of_lane = |v: V3<f32x4>| Vec3::from_array(each(|i| v[i].to_array()[lane]));
            let mut distance = f64::from(distances.to_array()[lane]);
            let mut axis = of_lane(best.axis);
            if !self.is_exact {
                let corners = each(|i| of_lane(corners[i]).as_dvec3());
                let [a, b, c] = corners;
                for direction in [axis.as_dvec3(), (b - a).cross(c - a)] {
                    // Away from the middle of the shape.
                    let direction = direction.normalize_or_zero() * direction.dot(a).signum();
                    let gap = self.gap_along(direction, &corners);
                    if gap > distance {
                        (distance, axis) = (gap, direction.as_vec3());
                    }
                }
            }
            if distance <= f64::from(self.margin) {
                found(lane, distance, axis);
            }
        });
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

    /// A bound from a direction of length 1, corners as of [`placed`](Self::placed). Minus infinity
    /// if there is no direction.
    fn gap_along(&self, direction: DVec3, corners: &[DVec3; 3]) -> f64 {
        if direction == DVec3::ZERO {
            return f64::NEG_INFINITY;
        }
        let along = corners.iter().map(|x| direction.dot(*x));
        let lowest = along.fold(f64::INFINITY, f64::min) + direction.dot(self.centre);
        lowest - self.shape.reach(direction) - f64::from(self.rounding)
    }
}

/// The greatest bounds so far and the directions that gave them, from the box to the triangle.
#[derive(Copy, Clone)]
struct Best {
    distance: f32x4,
    axis: V3<f32x4>,
}

impl Best {
    /// None of the four is within `enough`.
    #[inline(always)]
    fn is_beyond(&self, enough: f32) -> bool {
        self.distance.simd_le(f32x4::splat(enough)).to_bitmask() == 0
    }

    /// With the gap along a direction.
    #[inline(always)]
    fn with(self, n: V3<f32x4>, corners: &[V3<f32x4>; 3], half: &V3<f32x4>) -> Self {
        let along = each(|i| dot(n, corners[i]));
        let (low, below) = (smallest(along), f32x4::ZERO - largest(along));
        let squared = dot(n, n);
        let gap = low.fast_max(below) - dot(each(|axis| n[axis].abs()), *half);
        let distance = gap / squared.sqrt();
        // Where this is so, the triangle is on the other side.
        let is_opposite = below.simd_gt(low);
        let is_better =
            squared.simd_gt(f32x4::splat(SHORTEST_SQUARED)) & distance.simd_gt(self.distance);
        Self {
            distance: is_better.select(distance, self.distance),
            axis: each(|i| {
                let toward = is_opposite.select(f32x4::ZERO - n[i], n[i]);
                is_better.select(toward, self.axis[i])
            }),
        }
    }
}

/// Lower bounds of the distances of triangles to a box around the origin, without rounding. Not all
/// directions are tried once all bounds are beyond `enough`.
#[inline(always)]
fn box_distances(corners: &[V3<f32x4>; 3], half_lengths: &[f32; 3], enough: f32) -> Best {
    let half = each(|axis| f32x4::splat(half_lengths[axis]));
    let mut best = along_axes(corners, &half);
    if best.is_beyond(enough) {
        return best;
    }
    let edges = each(|i| sub(corners[(i + 1) % 3], corners[i]));
    best = best.with(cross(edges[0], edges[1]), corners, &half);
    if best.is_beyond(enough) {
        return best;
    }
    for (start, edge) in corners.iter().zip(edges) {
        best = best.with(to_edge(*start, edge, &half), corners, &half);
    }
    if best.is_beyond(enough) {
        return best;
    }
    for axis in (0..3).filter(|&axis| half_lengths[axis] > 0.0) {
        let unit = each(|i| f32x4::splat(if i == axis { 1.0 } else { 0.0 }));
        for edge in edges {
            best = best.with(cross(unit, edge), corners, &half);
        }
    }
    best
}

/// The gaps along the axes of the box add up as the sides of a box do; where there is none, the
/// least overlap counts.
#[inline(always)]
fn along_axes(corners: &[V3<f32x4>; 3], half: &V3<f32x4>) -> Best {
    let zero = f32x4::ZERO;
    let along = |axis: usize| each(|corner| corners[corner][axis]);
    let low = each(|i| smallest(along(i)) - half[i]);
    let high = each(|i| zero - largest(along(i)) - half[i]);
    let gap = largest(each(|i| low[i].fast_max(high[i])));
    // At most one of the two is positive.
    let axis = each(|i| low[i].fast_max(zero) - high[i].fast_max(zero));
    // Gaps above the root of `f32::MAX` are taken for less.
    let squares = dot(axis, axis).fast_min(f32x4::splat(f32::MAX));
    Best { distance: gap.simd_gt(zero).select(squares.sqrt(), gap), axis }
}

/// From the box to a point of an edge that is close to it: two steps of alternating projection.
#[inline(always)]
fn to_edge(start: V3<f32x4>, edge: V3<f32x4>, half: &V3<f32x4>) -> V3<f32x4> {
    let clamped = |x: f32x4, low: f32x4, high: f32x4| x.fast_max(low).fast_min(high);
    let in_box = |x: V3<f32x4>| each(|i| clamped(x[i], f32x4::splat(0.0) - half[i], half[i]));
    let point_at = |t: f32x4| each(|i| start[i] + edge[i] * t);
    let target = in_box(point_at(f32x4::splat(0.5)));
    let (zero, one) = (f32x4::splat(0.0), f32x4::splat(1.0));
    // Not a number for an edge without length: the comparisons of `clamped` make it 0.
    let t = clamped(dot(sub(target, start), edge) / dot(edge, edge), zero, one);
    let point = point_at(t);
    sub(point, in_box(point))
}
