//! Lateral culling: rejects triangles that lie beside each other instead of over each other.
//!
//! The nearest points of two small triangles of bodies that face each other are mostly aslant. They
//! are no local minima where the surface bends less
//! ([`MinimumCones`](crate::surface::MinimumCones)), and need no exact test.
//!
//! Let `n` be the normal of a triangle, `m` the direction in its plane away from one of its edges,
//! and `g` the least distance of the other triangle beyond that edge. Let `h` be the greatest
//! distance of the other triangle from the plane. A segment between the triangles spans at least
//! `g` along `m` and at most `h` along `n`. It is no shorter than `g`, and the cosine of its angle
//! to `n` is at most `h / √(g² + h²)`.
//!
//! # Rounding
//!
//! Lengths are allowed `6·r` from [`separation`](super::separation). `m` may be any direction in
//! the plane. `n` is off by `4·r` times the longest edge over twice the area, or over the height.
//! Triangles lower than [`LEAST_HEIGHT`] times `r` are therefore kept. The product of edges loses
//! less than that, as `r` exceeds a millionth of its length. So `n` is off by less than 0.011 rad,
//! which [`SLOPE`] and [`UPRIGHT`] allow for.
//!
//! # Motion
//!
//! Seen from the other triangle, a point in the ball whose motion [`Slack`](crate::traverse::Slack)
//! bounds has moved by at most `travel`. A point of the other body, no farther from the ball than a
//! tenth of its radius, has moved by at most 1.2 times that. The reason: a rigid motion at `1.1·x`
//! is 1.1 times the motion at `x`, less a tenth of the motion at the centre. [`TRAVEL`] allows for
//! a quarter.

use wide::f32x4;

use crate::simd::{V3, cross, dot, each, largest, smallest, sub};

use super::separation::{Corners, LeafFrame, UNDERFLOW, from_corner};

const LEAST_HEIGHT: f32 = 400.0;
const SLOPE: f32 = 0.96;
const UPRIGHT: f32 = 0.02;
const TRAVEL: f32 = 1.25;

/// Triangles longer than this, in units of the reach, are kept untested. Higher: tests that reject
/// little; lower: more exact tests.
const FINE: f32 = 8.0;

/// Squared lengths of products below this are underflow.
const TINY: f32 = 1.0e-30;

/// Pairs of triangles that may be rejected. The nearest points lie on no face and are farther apart
/// than a distance. The way between them leans from the normal of one triangle by more than an
/// angle.
#[derive(Copy, Clone, Debug)]
pub struct LateralCulling {
    distance: f32,
    slope: f32,
    travel: f32,
    upright: f32,
    longest: f32,
}

impl LateralCulling {
    /// Finds pairs farther apart than `distance` that lean by more than the angle with this
    /// `cosine`, between 0.5 and 0.9.
    ///
    /// Holds while the shapes move by up to `travel`, for pairs no farther apart than `reach`. The
    /// reach must be at most a tenth of the radius of the ball whose motion is bounded.
    pub fn new(distance: f32, cosine: f32, reach: f32, travel: f32) -> Self {
        let slope = SLOPE * cosine / (1.0 - cosine * cosine).sqrt();
        Self {
            distance,
            slope,
            travel: TRAVEL * travel,
            upright: UPRIGHT * reach,
            longest: FINE * reach,
        }
    }

    /// Returns the lanes whose pairs may be rejected, as bits: those that lean from triangle 1, and
    /// from triangle 2.
    #[inline(always)]
    pub(super) fn beside(&self, frame: &LeafFrame, one: &Corners, two: &Corners) -> [u32; 2] {
        let extent = largest(sub(one.max, one.min));
        if extent.simd_gt(f32x4::splat(self.longest)).all() {
            return [0; 2];
        }
        let [one, two] = from_corner(one, two);
        let [weak1, strong1] = one_side(self, frame.rounding, &one, &two);
        let [weak2, strong2] = one_side(self, frame.rounding, &two, &one);
        [strong1 & weak2, weak1 & strong2].map(|lanes| lanes.to_bitmask())
    }
}

/// The lanes where the nearest point is not in the face of `own`, and the lanes where it also is
/// far and the direction to it leans.
#[inline(always)]
fn one_side(
    culling: &LateralCulling,
    rounding: f32,
    own: &[V3<f32x4>; 3],
    other: &[V3<f32x4>; 3],
) -> [f32x4; 2] {
    let edges = each(|i| sub(own[(i + 1) % 3], own[i]));
    let lengths2 = each(|i| dot(edges[i], edges[i]));
    let normal = cross(edges[0], edges[1]);
    let area2 = dot(normal, normal);
    let least_height = LEAST_HEIGHT * rounding;
    let least_area2 = f32x4::splat(least_height * least_height) * largest(lengths2);
    let is_sound = area2.simd_gt(least_area2.fast_max(f32x4::splat(TINY)));
    let scale = f32x4::ONE / area2.sqrt();
    let normal = normal.map(|x| x * scale);
    let height = largest(each(|i| {
        let height = dot(normal, sub(other[i], own[0]));
        height.fast_max(f32x4::splat(0.0) - height)
    }));
    let lost = culling.travel + 6.0 * rounding;
    let rise = (height + f32x4::splat(lost)) * f32x4::splat(1.0 / culling.slope);
    let least = [
        f32x4::splat(lost + culling.upright),
        rise.fast_max(f32x4::splat(culling.distance)) + f32x4::splat(lost),
    ];
    // Gaps beyond each edge, times the length of the edge.
    let mut is_beyond = [f32x4::splat(0.0).simd_gt(f32x4::splat(0.0)); 2];
    for (edge, length2) in edges.into_iter().zip(lengths2) {
        let out = cross(edge, normal);
        let along = |corners: &[V3<f32x4>; 3]| each(|i| dot(out, corners[i]));
        let gap = (smallest(along(other)) - largest(along(own))).fast_max(f32x4::splat(0.0));
        for (is_beyond, least) in is_beyond.iter_mut().zip(least) {
            let is_so = (gap * gap).simd_gt(length2 * least * least + f32x4::splat(UNDERFLOW));
            *is_beyond |= is_so;
        }
    }
    is_beyond.map(|is_beyond| is_beyond & is_sound)
}
