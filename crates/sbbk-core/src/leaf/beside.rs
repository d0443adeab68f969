//! Triangles that lie beside each other rather than over each other.
//!
//! The nearest points of two small triangles of two bodies that face each other are mostly aslant:
//! of a contact of two heads of 70,000 triangles, nine pairs in ten. A caller that has no use for
//! these is spared them before the exact test.
//!
//! Let `n` be the normal of a triangle, `m` the direction along its plane away from one of its edges,
//! `g` the least distance of the other triangle beyond that edge, and `h` the greatest height of the
//! other triangle over the plane or under it. A segment from the one to the other goes at least `g`
//! along `m` and at most `h` along `n`: it is no shorter than `g`, and the cosine of its angle to `n` is
//! at most `h / √(g² + h²)`.
//!
//! # Rounding
//!
//! Lengths are allowed `6·r`, as in [`separation`](super::separation). `m` may be any direction along
//! the plane. `n` is off by `4·r` times the longest edge over twice the area, or over the height: a
//! triangle lower than [`LEAST_HEIGHT`] times `r` is beside nothing. As `r` is more than a millionth of
//! its length, what the product of edges loses is less than that. So `n` is off by less than 0.011 rad,
//! for which [`SLOPE`] and [`UPRIGHT`] make up.
//!
//! # Motion
//!
//! A point of the one triangle, as seen from the other, has moved by at most `travel` since, if it
//! belongs to the ball that [`Slack`](crate::traverse::Slack) has bounded the motion of. If it belongs
//! to the other body, and is no farther from the ball than a tenth of its radius, by at most
//! 1.2 times that: what a rigid motion does at `1.1·x` is 1.1 times what it does at `x`, less a tenth of
//! what it does at the centre. [`TRAVEL`] allows for a quarter.

use wide::f32x4;

use crate::simd::{V3, cross, dot, each, largest, smallest, sub};

use super::separation::{Corners, LeafFrame, UNDERFLOW, from_corner};

const LEAST_HEIGHT: f32 = 400.0;
const SLOPE: f32 = 0.96;
const UPRIGHT: f32 = 0.02;
const TRAVEL: f32 = 1.25;

/// Triangles that are longer than this many times the reach are not looked at: few of those near
/// each other are beside each other, and to find these takes as long as they do. (With 2, a pile of heads of
/// 70,688 triangles, five times as long as the reach, takes 1.1 times as long.)
const FINE: f32 = 8.0;

/// Squares of lengths of products that are less than this are lost to underflow.
const TINY: f32 = 1.0e-30;

/// Which pairs of triangles are of no use to a caller: those apart whose nearest points are no points
/// of a face, farther from each other than a distance, and along a direction that leans from the
/// normals of one of them, up or down, by more than an angle.
#[derive(Copy, Clone, Debug)]
pub struct Beside {
    distance: f32,
    slope: f32,
    travel: f32,
    upright: f32,
    longest: f32,
}

impl Beside {
    /// For pairs farther apart than `distance`, and the `cosine` of the least angle, between 0.5 and
    /// 0.9: now, and while the shapes move by up to `travel`, as far as they are no farther apart than
    /// `reach`. That must be at most a tenth of the radius of the ball whose motion is bounded.
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
}

/// Which triangles are beside each other, lane by lane.
#[inline(always)]
pub(super) fn beside(beside: &Beside, frame: &LeafFrame, one: &Corners, two: &Corners) -> f32x4 {
    let no = f32x4::splat(0.0).simd_gt(f32x4::splat(0.0));
    let extent = largest(sub(one.max, one.min));
    if extent.simd_gt(f32x4::splat(beside.longest)).all() {
        return no;
    }
    let [one, two] = from_corner(one, two);
    let [weak1, strong1] = beside_one(beside, frame.rounding, &one, &two);
    let [weak2, strong2] = beside_one(beside, frame.rounding, &two, &one);
    (weak1 & strong2) | (strong1 & weak2)
}

/// Whether the other triangle is beside `own`: so that the nearest point is not in the face of `own`;
/// and so that it is far, and the direction to it leans.
#[inline(always)]
fn beside_one(
    beside: &Beside,
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
    let lost = beside.travel + 6.0 * rounding;
    let rise = (height + f32x4::splat(lost)) * f32x4::splat(1.0 / beside.slope);
    let least = [
        f32x4::splat(lost + beside.upright),
        rise.fast_max(f32x4::splat(beside.distance)) + f32x4::splat(lost),
    ];
    // Of the gaps beyond each edge, times the length of the edge.
    let mut is_beyond = [f32x4::splat(0.0).simd_gt(f32x4::splat(0.0)); 2];
    for (edge, length2) in edges.into_iter().zip(lengths2) {
        let out = cross(edge, normal);
        let along = |corners: &[V3<f32x4>; 3]| each(|i| dot(out, corners[i]));
        let gap = (smallest(along(other)) - largest(along(own))).fast_max(f32x4::splat(0.0));
        for (is_beyond, least) in is_beyond.iter_mut().zip(least) {
            let is_so = (gap * gap).simd_gt(length2 * least * least + f32x4::splat(UNDERFLOW));
            *is_beyond = *is_beyond | is_so;
        }
    }
    is_beyond.map(|is_beyond| is_beyond & is_sound)
}
