//! Finds where another triangle meets a triangle.

use glamx::DVec3;

use super::triangle::{area_vector, clip};

/// Returns the segment in which another triangle meets a triangle, and the unit vector across it in the plane of the
/// triangle. Corners within `slack` of the plane lie in it. `None` if the two share no more than a point, a border of the
/// triangle, or an area.
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
