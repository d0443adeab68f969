//! Size of a triangle, and what touches it.

use glamx::DVec3;

use crate::simd::each;

/// Returns the normal of a triangle, as long as twice its area.
pub(super) fn area_vector([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*b - *a).cross(*c - *a)
}

/// Returns the length of the longest side of a triangle.
pub(super) fn longest_side([a, b, c]: &[DVec3; 3]) -> f64 {
    a.distance(*b).max(b.distance(*c)).max(c.distance(*a))
}

/// Greatest distances of the strays of a needle and of a large triangle, as shares of the longest side.
/// Higher: walls that stand close to each other count as one surface. Lower: gaps of a modeller count
/// as holes.
const SEAM: [f64; 2] = [1.0e-5, 1.0e-3];

/// Returns the greatest distance of the strays of a triangle. This is half the least height, because slivers would
/// have many strays, but between 0.00001 and 0.001 of the longest side.
pub fn seam(corners: &[DVec3; 3]) -> f64 {
    let longest = longest_side(corners);
    let height = area_vector(corners).length() / longest;
    (0.5 * height).max(SEAM[0] * longest).min(SEAM[1] * longest)
}

/// True if a triangle with an area comes within `seam` of a segment, or a little farther at its
/// corners.
pub fn touches(corners: &[DVec3; 3], segment: [DVec3; 2], seam: f64) -> bool {
    clip(corners, segment, seam).is_some()
}

/// Returns the ends of the part of a segment that [touches](touches()) a triangle.
pub(super) fn clip(
    corners: &[DVec3; 3],
    [start, end]: [DVec3; 2],
    seam: f64,
) -> Option<[DVec3; 2]> {
    let [a, ..] = *corners;
    let area = area_vector(corners);
    // Most triangles end here, without a root.
    let heights = [start, end].map(|place| area.dot(place - a));
    let most = seam * seam * area.length_squared();
    let is_beyond = heights.iter().all(|height| height * height > most);
    if is_beyond && heights[0] * heights[1] > 0.0 {
        return None;
    }
    let up = area.try_normalize()?;
    let sides = each(|i| {
        let along = (corners[(i + 1) % 3] - corners[i]).normalize_or_zero();
        (up.cross(along), corners[i])
    });
    let planes = [(up, a), (-up, a)].into_iter().chain(sides);
    // The part of the segment on the inner side of all planes.
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (inwards, on) in planes {
        let [from, to] = [start, end].map(|place| inwards.dot(place - on) + seam);
        match [from >= 0.0, to >= 0.0] {
            [true, true] => {}
            [false, false] => return None,
            [true, false] => last = last.min(from / (from - to)),
            [false, true] => first = first.max(from / (from - to)),
        }
    }
    (first <= last).then(|| [first, last].map(|share| start.lerp(end, share)))
}
