use glamx::DVec3;

use crate::contact::Feature;
use crate::simd::each;

/// Least squared cosine between the normals of a contact and of a triangle for a face contact: a
/// tenth of a degree. Higher: faces on curved shapes count as edges. Lower: edges count as faces.
const FACE: f64 = 1.0 - 3.1e-6;

/// Greatest weight of a corner that counts as zero, as a share of all. Higher: points near a corner
/// count as the corner. Lower: rounding decides.
const NONE: f64 = 1.0e-4;

/// Least weight of a corner that counts as all.
const MOST: f64 = 1.0 - NONE;

/// Greatest sine of the first corner of a triangle that counts as a segment. Higher: faces of
/// needles count as edges. Lower: rounding decides.
const FLAT: f64 = 1.0e-12;

/// The feature of a triangle at a contact point, given the unit normal of the contact. This is the
/// face if the normal is the triangle's, otherwise the edge or corner at the point. A triangle
/// without an area is its longest edge.
pub fn feature_at(triangle: &[DVec3; 3], point: DVec3, normal: DVec3) -> Feature {
    let [a, b, c] = *triangle;
    let (ab, ac) = (b - a, c - a);
    let face = ab.cross(ac);
    let size = face.length_squared();
    if size <= FLAT * FLAT * ab.length_squared() * ac.length_squared() {
        return feature_of_segment(triangle, point);
    }
    let along = normal.dot(face);
    if along * along >= FACE * size {
        return Feature::Face;
    }
    // Share of each corner in the point, times `size`.
    let weight = |i: usize| {
        let [from, to] = [triangle[(i + 1) % 3], triangle[(i + 2) % 3]];
        (to - from).cross(point - from).dot(face)
    };
    match each(|i| weight(i) <= NONE * size) {
        [false, true, true] => Feature::Vertex(0),
        [true, false, true] => Feature::Vertex(1),
        [true, true, false] => Feature::Vertex(2),
        [false, false, true] => Feature::Edge(0),
        [true, false, false] => Feature::Edge(1),
        [false, true, false] => Feature::Edge(2),
        _ => Feature::Face,
    }
}

/// The feature at a point of a triangle without an area.
#[cold]
fn feature_of_segment(triangle: &[DVec3; 3], point: DVec3) -> Feature {
    let edge = |i: u8| [i, (i + 1) % 3].map(|end| triangle[usize::from(end)]);
    let length = |i: &u8| edge(*i)[0].distance(edge(*i)[1]);
    let longest = (0..3).max_by(|i, j| length(i).total_cmp(&length(j))).unwrap_or_default();
    let [from, to] = edge(longest);
    // A point has no share.
    let share = (point - from).dot(to - from) / from.distance_squared(to);
    match share {
        NONE..=MOST => Feature::Edge(longest),
        share if share > MOST => Feature::Vertex((longest + 1) % 3),
        _ => Feature::Vertex(longest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_follow_from_points_and_normals() {
        let triangle = [DVec3::ZERO, 4.0 * DVec3::X, 4.0 * DVec3::Y];
        let [a, b, c] = triangle;
        let aslant = DVec3::new(0.1, -0.2, 1.0).normalize();
        let parts = [
            (a, Feature::Vertex(0)),
            (b, Feature::Vertex(1)),
            (c, Feature::Vertex(2)),
            (a.midpoint(b), Feature::Edge(0)),
            (b.lerp(c, 0.01), Feature::Edge(1)),
            (c.lerp(a, 0.99), Feature::Edge(2)),
            (DVec3::ONE.with_z(0.0), Feature::Face),
        ];
        for (point, part) in parts {
            for normal in [aslant, -aslant] {
                assert_eq!(feature_at(&triangle, point, normal), part, "{point}");
            }
            assert_eq!(feature_at(&triangle, point, DVec3::Z), Feature::Face);
        }
        // Triangles without an area.
        let (segment, middle) = ([a, b.lerp(a, 0.3), b], a.midpoint(b));
        for normal in [aslant, DVec3::Y, DVec3::Z] {
            assert_eq!(feature_at(&segment, middle, normal), Feature::Edge(2));
            assert_eq!(feature_at(&segment, a, normal), Feature::Vertex(0));
            assert_eq!(feature_at(&segment, b, normal), Feature::Vertex(2));
            assert_eq!(feature_at(&[a; 3], a, normal), Feature::Vertex(2));
        }
    }
}
