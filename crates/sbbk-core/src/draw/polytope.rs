use glamx::{DVec3, Vec3};

/// Lengths below this share of the coordinates are rounding errors of f64.
const TOLERANCE: f64 = 1e-12;

/// A half-space: points whose product with the normal is at most `end`.
struct Half {
    normal: DVec3,
    end: f64,
}

/// The edges of the polytope between slabs, each once.
///
/// An edge is what the others leave of the line in which two planes meet. Takes time in the third
/// power of the number of slabs: microseconds for a k-DOP, enough for pictures.
pub(super) fn edges(
    directions: &[Vec3],
    min: &[f32],
    max: &[f32],
    mut line: impl FnMut(Vec3, Vec3),
) {
    let slabs = directions.iter().zip(min.iter().zip(max));
    let halves: Vec<Half> = slabs
        .flat_map(|(direction, (&min, &max))| {
            let (normal, min, max) = (direction.as_dvec3(), f64::from(min), f64::from(max));
            [Half { normal, end: max }, Half { normal: -normal, end: -min }]
        })
        .collect();
    let tolerance = TOLERANCE * halves.iter().map(|half| half.end.abs()).fold(0.0, f64::max);
    for second in 1..halves.len() {
        for first in 0..second {
            if let Some([a, b]) = edge(&halves, [first, second], tolerance) {
                line(a.as_vec3(), b.as_vec3());
            }
        }
    }
}

/// The edge between two planes; `None` if they have none, or if others stand for it.
fn edge(halves: &[Half], [first, second]: [usize; 2], tolerance: f64) -> Option<[DVec3; 2]> {
    let [one, two] = [&halves[first], &halves[second]];
    let along = one.normal.cross(two.normal);
    let scale = along.length_squared();
    if scale == 0.0 {
        return None;
    }
    let start = (one.end * two.normal.cross(along) + two.end * along.cross(one.normal)) / scale;
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for (index, half) in halves.iter().enumerate() {
        if index == first || index == second {
            continue;
        }
        // How much is left of the half-space at the start, and how fast it shrinks along the line.
        let (left, slope) = (half.end - half.normal.dot(start), half.normal.dot(along));
        if slope > 0.0 {
            to = to.min(left / slope);
        } else if slope < 0.0 {
            from = from.max(left / slope);
        } else {
            // Along the whole line, inside or outside. Of more planes than two through the line, the
            // least two that are not opposite stand for it.
            let is_opposite = index == first ^ 1 && index > first;
            let is_earlier = index < second && !is_opposite;
            if left < -tolerance || (left <= tolerance && is_earlier) {
                return None;
            }
        }
    }
    let is_long = (to - from) * scale.sqrt() > tolerance;
    is_long.then(|| [start + from * along, start + to * along])
}
