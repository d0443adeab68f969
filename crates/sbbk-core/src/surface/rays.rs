//! Rays and the triangles that they meet.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use glamx::DVec3;

use super::triangle::area_vector;

/// Triangles that rays can meet.
pub trait RayTriangles {
    /// Number of triangles.
    fn count(&self) -> u32;

    /// The corners of a triangle.
    fn corners(&self, triangle: u32) -> [DVec3; 3];

    /// The least and the greatest coordinates.
    fn bounds(&self) -> [DVec3; 2];

    /// Calls `visit` with all triangles that may come within `slack` of a triangle, until it
    /// breaks.
    fn near(&self, triangle: u32, slack: f64, visit: &mut dyn FnMut(u32) -> ControlFlow<()>);

    /// Calls `visit` with all triangles that the ray from `start` may meet, until it breaks.
    fn along(&self, start: DVec3, direction: DVec3, visit: &mut dyn FnMut(u32) -> ControlFlow<()>);
}

/// Triangles that a ray meets at most. A triangle whose rays meet more counts as a face. Higher:
/// meshes of many layers take longer. Lower: walls within such meshes have contacts.
pub(super) const MOST_HITS: usize = 100;

/// Share of a length below which two places of a ray are one.
pub(super) const TIE: f64 = 1.0e-9;

/// Number `i` of a sequence of low discrepancy in one of three dimensions.
pub(super) fn sequence(i: f64, dimension: usize) -> f64 {
    // Powers of the root of x⁴ = x + 1.
    const STEPS: [f64; 3] =
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_9];
    (0.5 + i * STEPS[dimension]).fract()
}

/// Direction `i` of a sequence, whose third coordinate is at least `least`.
pub(super) fn direction(i: f64, least: f64) -> [f64; 3] {
    let [u, v] = [1, 2].map(|dimension| sequence(i, dimension));
    let height = least + (1.0 - least) * v;
    let (sin, cos) = (TAU * u).sin_cos();
    let flat = (1.0 - height * height).max(0.0).sqrt();
    [flat * cos, flat * sin, height]
}

/// Returns the direction whose line through a point has the shortest part within bounds.
pub(super) fn shortest(
    ways: impl Iterator<Item = DVec3>,
    start: DVec3,
    bounds: [DVec3; 2],
) -> Option<DVec3> {
    let [low, high] = bounds.map(|corner| corner - start);
    let length = |way: DVec3| {
        let [one, other] = [low, high].map(|corner| corner / way);
        one.max(other).min_element() - one.min(other).max_element()
    };
    ways.min_by(|&a, &b| length(a).total_cmp(&length(b)))
}

/// A triangle that a ray meets.
pub(super) struct Hit {
    pub(super) length: f64,
    /// 1 if the ray leaves through the front, -1 if it enters.
    pub(super) sign: i8,
    pub(super) triangle: u32,
    /// True within a triangle of a closed component. Rays count all such hits, also where faces are
    /// flush.
    pub(super) is_exact: bool,
}

/// Hits of a ray.
pub(super) type Hits = ArrayVec<Hit, MOST_HITS>;

/// Times that a ray leaves the surface less times that it enters.
pub(super) fn winding<'a>(hits: impl Iterator<Item = &'a Hit>) -> i32 {
    let hits = hits.map(|hit| (hit.length, hit.sign, hit.is_exact));
    crossings(hits).map(|(_, sign)| sign).sum()
}

/// Returns the length and the sign of each hit, the nearest first. Triangles at one place count
/// once unless the hits are exact: doubles, and the two at an edge. Others have sign 0.
fn crossings(hits: impl Iterator<Item = (f64, i8, bool)>) -> impl Iterator<Item = (f64, i32)> {
    let mut last = [(f64::NEG_INFINITY, false); 2];
    hits.map(move |(length, sign, is_exact)| {
        let before = std::mem::replace(&mut last[usize::from(sign > 0)], (length, is_exact));
        let counts = length - before.0 > TIE * length || is_exact && before.1;
        (length, if counts { sign.into() } else { 0 })
    })
}

/// Length at which a ray from the origin meets a triangle, and 1 if it leaves through the front.
/// Also true if it meets the border, or if rounding decides on which side the origin is. The length
/// may be negative there.
pub(super) fn hit(corners @ [a, b, c]: &[DVec3; 3], direction: DVec3) -> Option<(f64, i8, bool)> {
    let normal = area_vector(corners);
    let along = normal.dot(direction);
    let length = normal.dot(*a) / along;
    // Six times the volume between the ray and a side.
    let volume = |(p, q): (&DVec3, &DVec3)| p.cross(*q).dot(direction) * along.signum();
    let least = [(a, b), (b, c), (c, a)].map(volume).into_iter().fold(f64::INFINITY, f64::min);
    let slack = TIE * along.abs();
    let rounding = TIE * a.length();
    let is_met = length > -rounding && least >= -slack;
    let is_at_border = least <= slack || length <= rounding;
    (is_met && along != 0.0).then_some((length, along.signum() as i8, is_at_border))
}

/// Triangles near a ray up to which [`ends_within`] tests them. Higher: slow where many triangles
/// are at one place. Lower: more rays that test winding numbers.
const MOST_NEAR: usize = 64;

/// Returns true if a solid ends within a length along a ray that starts in it. `near` has the
/// corners of all triangles that the ray may meet, seen from its start. `outward` is the sign with
/// which normals lead out of the solid. A solid goes on where one of its parts ends and another
/// begins. Returns false if too many triangles are near.
pub fn ends_within(
    near: impl Iterator<Item = [DVec3; 3]>,
    direction: DVec3,
    length: f64,
    outward: f64,
) -> bool {
    let near: ArrayVec<[DVec3; 3], MOST_NEAR> = near.take(MOST_NEAR).collect();
    if near.is_full() {
        return false;
    }
    let hit = |corners: &[DVec3; 3]| {
        hit(corners, direction).filter(|(at, ..)| *at > 0.0 && *at <= length)
    };
    let mut hits: ArrayVec<_, MOST_NEAR> = near.iter().filter_map(hit).collect();
    hits.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut parts, mut end) = (1.0, None);
    for (at, sign) in crossings(hits.into_iter().map(|(at, sign, _)| (at, sign, false))) {
        if end.is_some_and(|end| at - end > TIE * at) {
            return true;
        }
        parts -= f64::from(sign) * outward;
        end = (parts <= 0.0).then_some(at);
    }
    end.is_some()
}
