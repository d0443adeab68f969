//! Size of a triangle, what touches it, and where another one meets it.

use glamx::DVec3;

use crate::simd::each;

/// Returns the normal of a triangle, as long as twice its area.
#[inline]
pub fn area_vector([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (*b - *a).cross(*c - *a)
}

/// Returns the length of the longest side of a triangle.
pub fn longest_side([a, b, c]: &[DVec3; 3]) -> f64 {
    a.distance(*b).max(b.distance(*c)).max(c.distance(*a))
}

/// Greatest distances of the strays of a needle and of a large triangle, as shares of the longest
/// side. Higher: walls that stand close to each other count as one surface. Lower: gaps of a
/// modeller count as holes.
const SEAM: [f64; 2] = [1.0e-5, 1.0e-3];

/// Returns the greatest distance of the strays of a triangle. This is half the least height,
/// because slivers would have many strays, but between 0.00001 and 0.001 of the longest side.
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

/// Returns the segment in which another triangle meets a triangle, and the unit vector across it in
/// the plane of the triangle. Corners within `slack` of the plane lie in it. `None` if the two
/// share no more than a point, a border of the triangle, or an area.
pub(super) fn meeting(
    triangle: &[DVec3; 3],
    other: &[DVec3; 3],
    slack: f64,
) -> Option<([DVec3; 2], DVec3)> {
    let normal = area_vector(triangle).try_normalize()?;
    let heights = other.map(|corner| normal.dot(corner - triangle[0]));
    let mut points = (0..3).filter_map(|i| in_plane(other, &heights, i, slack));
    let (first, second) = (points.next()?, points.next()?);
    if heights.iter().all(|height| height.abs() <= slack) {
        return None;
    }
    // A corner in the plane and the edges beside it give one place twice.
    let farthest = |a: DVec3, b: DVec3| if b.distance(first) > a.distance(first) { b } else { a };
    let ends = [first, points.fold(second, farthest)];
    let across = normal.cross(ends[1] - ends[0]).try_normalize()?;
    let inner = clip(triangle, ends, slack)?;
    let middle = 0.5 * (inner[0] + inner[1]);
    let is_border = depth_within(triangle, normal, middle) <= slack;
    (!is_border).then_some((inner, across))
}

/// Returns the distance of a point in the plane of a triangle from its border; negative outside.
pub(super) fn depth_within(triangle: &[DVec3; 3], normal: DVec3, point: DVec3) -> f64 {
    let [a, b, c] = *triangle;
    let inward = |from: DVec3, to: DVec3| normal.cross(to - from).normalize_or_zero();
    let depth = |from: DVec3, to: DVec3| inward(from, to).dot(point - from);
    depth(a, b).min(depth(b, c)).min(depth(c, a))
}

/// Returns where the edge from corner `i` meets the plane, if it does.
fn in_plane(corners: &[DVec3; 3], heights: &[f64; 3], i: usize, slack: f64) -> Option<DVec3> {
    let next = (i + 1) % 3;
    let (start, end) = (heights[i], heights[next]);
    if start.abs() <= slack {
        return Some(corners[i]);
    }
    let crosses = end.abs() > slack && (start > 0.0) != (end > 0.0);
    crosses.then(|| corners[i].lerp(corners[next], start / (start - end)))
}
