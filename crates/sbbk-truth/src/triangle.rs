//! Two triangles, one of them as a [`Polytope`].

use super::polytope::Polytope;
use glamx::DVec3;

/// Fraction of the size of the pair below which a distance gives no direction, and two depths tie.
const UNCLEAR: f64 = 1.0e-8;

/// Triangles this close, as a fraction of the size of the pair, touch or cross.
const TOUCHING: f64 = 1.0e-13;

/// Distance or depth of two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthContact {
    /// The distance, or minus the least translation that separates the triangles. Triangles
    /// that touch, or overlap in one plane, have distance 0.
    pub distance: f64,
    /// The unit direction of the distance, or of the least translation of triangle 2.
    pub normal: DVec3,
    /// True if no direction that differs by more than 0.03 degrees is nearly as good.
    pub normal_is_unique: bool,
}

/// Distance or depth of two triangles, which may be segments or points. About 10 µs.
pub fn contact(triangle1: &[DVec3; 3], triangle2: &[DVec3; 3]) -> TruthContact {
    let [t1, t2] = [triangle1, triangle2].map(|t| t.map(|v| v - triangle1[0]));
    let size =
        [t1, t2].map(|[a, b, c]| (b - a).length().max((c - b).length()).max((a - c).length()));
    let size = size[0].max(size[1]);
    let polytope = Polytope::new(t2.into());
    let axes = polytope.separation(&t1, UNCLEAR);
    let way = if axes.distance > 0.0 { polytope.apart(&t1) } else { DVec3::ZERO };
    let distance = way.length();
    if distance > TOUCHING * size {
        let normal_is_unique = distance > UNCLEAR * size;
        return TruthContact { distance, normal: way / distance, normal_is_unique };
    }
    // Triangles on one line have no axis: the least translation is sideways, by nothing.
    let normal = axes.normals.first().copied().unwrap_or_else(|| {
        (t1[1] - t1[0]).try_normalize().map_or(DVec3::Z, DVec3::any_orthonormal_vector)
    });
    let is_same = |other: &DVec3| other.dot(normal) >= 1.0 - 1.0e-7;
    TruthContact {
        distance: axes.distance.min(0.0),
        normal,
        normal_is_unique: !axes.normals.is_empty() && axes.normals.iter().all(is_same),
    }
}

/// The gap between the shadows of two triangles on a unit axis, negative if they overlap. Triangle
/// 2 lies beyond triangle 1 by the gap.
pub fn separation(triangle1: &[DVec3; 3], triangle2: &[DVec3; 3], axis: DVec3) -> f64 {
    let far1 = triangle1.map(|v| (v - triangle1[0]).dot(axis));
    let near2 = triangle2.map(|v| (v - triangle1[0]).dot(axis));
    near2.into_iter().fold(f64::INFINITY, f64::min)
        - far1.into_iter().fold(-f64::INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn plain_cases_are_right() {
        let over = contact(&FLOOR, &FLOOR.map(|v| v + DVec3::Z * 0.5));
        assert_eq!((over.distance, over.normal, over.normal_is_unique), (0.5, DVec3::Z, true));
        let beside = contact(&FLOOR, &FLOOR.map(|v| v - DVec3::X * 3.0));
        assert_eq!((beside.distance, beside.normal), (2.0, -DVec3::X));
        let crossed = [[0.2, 0.2, -0.1], [0.2, 0.3, 1.0], [0.3, 0.2, 1.0]].map(DVec3::from_array);
        let crossed = contact(&FLOOR, &crossed);
        assert!((crossed.distance + 0.1).abs() < 1.0e-15 && crossed.normal == DVec3::Z);
        assert!(crossed.normal_is_unique);
        let in_plane = contact(&FLOOR, &FLOOR.map(|v| v * 0.5));
        assert_eq!((in_plane.distance, in_plane.normal.abs()), (0.0, DVec3::Z));
        assert!(!in_plane.normal_is_unique);
        assert_eq!(separation(&FLOOR, &FLOOR.map(|v| v + DVec3::X * 3.0), DVec3::X), 2.0);
    }
}
