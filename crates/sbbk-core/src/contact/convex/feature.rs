use glamx::DVec3;

use super::ConvexContact;
use crate::contact::Feature;

/// Least squared cosine of the normals of a contact and of a triangle that touches with its face: a
/// tenth of a degree, three times as much as normals of curved shapes are off.
const FACE: f64 = 1.0 - 3.1e-6;

/// Greatest weight of a corner that has no part in a point, as a share of all: what rounding, and the
/// search for points of curved shapes, can do to a zero.
const NONE: f64 = 1.0e-4;

impl ConvexContact {
    /// The part of the triangle that touches: its face if the normal is that of the triangle, else the
    /// edge or the corner that the point is on.
    pub fn feature(&self, triangle: &[DVec3; 3]) -> Feature {
        let [a, b, c] = *triangle;
        let face = (b - a).cross(c - a);
        let size = face.length_squared();
        let along = self.normal.dot(face);
        if along * along >= FACE * size {
            return Feature::Face;
        }
        // How much of the point each corner has, times `size`.
        let weight = |i: usize| {
            let [from, to] = [triangle[(i + 1) % 3], triangle[(i + 2) % 3]];
            (to - from).cross(self.on_triangle - from).dot(face)
        };
        let weights = [weight(0), weight(1), weight(2)];
        let is_none = weights.map(|weight| weight <= NONE * size);
        match is_none {
            [false, true, true] => Feature::Vertex(0),
            [true, false, true] => Feature::Vertex(1),
            [true, true, false] => Feature::Vertex(2),
            [false, false, true] => Feature::Edge(0),
            [true, false, false] => Feature::Edge(1),
            [false, true, false] => Feature::Edge(2),
            _ => Feature::Face,
        }
    }
}
