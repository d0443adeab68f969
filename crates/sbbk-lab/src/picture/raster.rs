//! Which samples a triangle covers.

use glamx::{Vec2, Vec3};

/// How far outside an edge a sample still counts, in barycentric weight: bridges the rounding
/// between neighbours. Too small: pinholes along edges; too large: jagged outlines.
const EDGE_TOLERANCE: f32 = 1.0e-4;

/// Calls `fragment(sample index, barycentric weights)` for each sample of a row-major raster whose
/// centre lies in the triangle, of either orientation.
pub(super) fn fill(corners: [Vec2; 3], size: [usize; 2], mut fragment: impl FnMut(usize, Vec3)) {
    let [a, b, c] = corners;
    let doubled_area = (b - a).perp_dot(c - a);
    // The samples whose centres, half a sample in, lie within the bounds.
    let limit = Vec2::new(size[0] as f32, size[1] as f32);
    let first = (a.min(b).min(c) - 0.5).ceil().max(Vec2::ZERO);
    let end = (a.max(b).max(c) + 0.5).floor().min(limit);
    // Non-finite corners are turned away too, as no comparison holds for them.
    if !(doubled_area.abs() > 0.0 && first.x < end.x && first.y < end.y) {
        return;
    }
    // Weights are affine: those at the first sample, and steps from there.
    let origin = first + 0.5;
    let opposite = [[b, c], [c, a], [a, b]];
    let scale = doubled_area.recip();
    let weights = opposite.map(|[p, q]| (p - origin).perp_dot(q - origin));
    let step_x = opposite.map(|[p, q]| p.y - q.y);
    let step_y = opposite.map(|[p, q]| q.x - p.x);
    let [weights, step_x, step_y] =
        [weights, step_x, step_y].map(|edges| Vec3::from_array(edges) * scale);

    let columns = first.x as usize..end.x as usize;
    for (down, row) in (first.y as usize..end.y as usize).enumerate() {
        let row_weights = weights + step_y * down as f32;
        for (across, column) in columns.clone().enumerate() {
            let weights = row_weights + step_x * across as f32;
            if weights.min_element() >= -EDGE_TOLERANCE {
                fragment(row * size[0] + column, weights);
            }
        }
    }
}
