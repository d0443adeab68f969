//! Which samples a triangle covers, and which of them it is the nearest at.

use glamx::{Mat4, Vec2, Vec3};

/// How far outside an edge a sample still counts, in barycentric weight: bridges the rounding
/// between neighbours. Too small: pinholes along edges; too large: jagged outlines.
const EDGE_TOLERANCE: f32 = 1.0e-4;

/// A depth buffer.
pub(super) struct Raster {
    /// Columns and rows.
    pub size: [usize; 2],
    /// From the world to column, row and depth; of two depths the greater one is seen.
    pub matrix: Mat4,
    /// The depth at each sample, by rows; negative infinity where nothing is.
    pub depths: Vec<f32>,
}

impl Raster {
    pub fn new(size: [usize; 2], matrix: Mat4) -> Self {
        Self { size, matrix, depths: vec![f32::NEG_INFINITY; size[0] * size[1]] }
    }

    /// Fills a triangle, of either orientation: calls `seen(sample index, weights of the corners)`
    /// where it covers what was there. A triangle that reaches behind the eye is left out.
    pub fn fill(&mut self, corners: [Vec3; 3], mut seen: impl FnMut(usize, Vec3)) {
        let projected = corners.map(|corner| self.matrix * corner.extend(1.0));
        if projected.iter().any(|corner| corner.w <= 0.0) {
            return;
        }
        let projected = projected.map(|corner| corner.truncate() / corner.w);
        let depths = Vec3::from_array(projected.map(|corner| corner.z));
        let [a, b, c] = projected.map(Vec3::truncate);
        let doubled_area = (b - a).perp_dot(c - a);
        // The samples whose centres, half a sample in, lie within the bounds.
        let limit = Vec2::from_array(self.size.map(|length| length as f32));
        let first = (a.min(b).min(c) - 0.5).ceil().max(Vec2::ZERO);
        let end = (a.max(b).max(c) + 0.5).floor().min(limit);
        for row in first.y as usize..end.y as usize {
            for column in first.x as usize..end.x as usize {
                let sample = Vec2::new(column as f32, row as f32) + 0.5;
                let weights = Vec3::new(
                    (b - sample).perp_dot(c - sample),
                    (c - sample).perp_dot(a - sample),
                    (a - sample).perp_dot(b - sample),
                ) / doubled_area;
                let depth = weights.dot(depths);
                let index = row * self.size[0] + column;
                if weights.min_element() >= -EDGE_TOLERANCE && depth > self.depths[index] {
                    self.depths[index] = depth;
                    // Under perspective the depth is one over the distance, by which the weights
                    // in space differ from those in the picture.
                    seen(index, weights * depths / depth);
                }
            }
        }
    }
}
