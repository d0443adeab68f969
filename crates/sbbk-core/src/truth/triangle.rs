//! Two triangles, by enumeration.
//!
//! Apart: the distance of two triangles is the least of nine edge-edge and six vertex-face
//! distances, each found by least squares (a QR factorisation).
//!
//! Crossing: if an edge of one triangle pierces the other, the depth is the least overlap over all
//! possible face normals of the Minkowski difference. These are both face normals and the nine
//! products of two edges (S. Gottschalk, "Separating axis theorem", 1996). Other directions only
//! overestimate the depth, so a badly computed direction does no harm.

use arrayvec::ArrayVec;
use glamx::DVec3;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, Vector2, Vector3};

type Vector = Vector3<f64>;
type Triangle = [Vector; 3];

/// Fraction of the size of the pair below which a distance gives no direction, and two depths tie.
const UNCLEAR: f64 = 1.0e-8;

/// Triangles this close, as a fraction of the size of the pair, are taken to touch or cross.
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
    /// The closest points on triangles 1 and 2; none when they cross.
    pub closest_points: Option<[DVec3; 2]>,
}

/// Distance or depth of two triangles, which may be segments or points. About 10 µs.
pub fn contact(triangle1: &[DVec3; 3], triangle2: &[DVec3; 3]) -> TruthContact {
    let origin = triangle1[0];
    let local = |t: &[DVec3; 3]| t.map(|v| Vector::from((v - origin).to_array()));
    let (t1, t2) = (local(triangle1), local(triangle2));
    let size = [t1, t2].map(|t| size(&t)).into_iter().fold(0.0, f64::max);
    let [p1, p2] = closest_points(&t1, &t2);
    let distance = (p2 - p1).norm();
    // An edge may pass through the border exactly, where rounding hides that it pierces.
    if distance <= TOUCHING * size || pierces(&t1, &t2) || pierces(&t2, &t1) {
        return least_translation(&t1, &t2, size);
    }
    TruthContact {
        distance,
        normal: plain((p2 - p1) / distance),
        normal_is_unique: distance > UNCLEAR * size,
        closest_points: Some([p1, p2].map(|p| plain(p) + origin)),
    }
}

/// The gap between the shadows of two triangles on a unit axis, negative when they overlap: how
/// far triangle 2 lies beyond triangle 1.
pub fn separation(triangle1: &[DVec3; 3], triangle2: &[DVec3; 3], axis: DVec3) -> f64 {
    let far1 = triangle1.map(|v| (v - triangle1[0]).dot(axis));
    let near2 = triangle2.map(|v| (v - triangle1[0]).dot(axis));
    near2.into_iter().fold(f64::INFINITY, f64::min)
        - far1.into_iter().fold(-f64::INFINITY, f64::max)
}

fn plain(v: Vector) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

fn edges(t: &Triangle) -> [[Vector; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
}

fn size(t: &Triangle) -> f64 {
    edges(t).map(|[a, b]| (b - a).norm()).into_iter().fold(0.0, f64::max)
}

fn closest_points(t1: &Triangle, t2: &Triangle) -> [Vector; 2] {
    let edge_pairs = edges(t1).into_iter().flat_map(|e1| edges(t2).map(|e2| edge_edge(e1, e2)));
    let vertices1 = t1.iter().map(|&v| [v, closest_in_face(v, t2)]);
    let vertices2 = t2.iter().map(|&v| [closest_in_face(v, t1), v]);
    let by_distance = |a: &[Vector; 2], b: &[Vector; 2]| {
        (a[1] - a[0]).norm_squared().total_cmp(&(b[1] - b[0]).norm_squared())
    };
    edge_pairs.chain(vertices1).chain(vertices2).min_by(by_distance).expect("15 candidates")
}

/// The weights of two columns that come nearest to `target`; none when the columns are parallel.
fn least_squares(columns: [Vector; 2], target: Vector) -> Option<Vector2<f64>> {
    let qr = Matrix3x2::from_columns(&columns).qr();
    let mut rhs = target;
    qr.q_tr_mul(&mut rhs);
    let r: Matrix2<f64> = qr.r();
    r.solve_upper_triangular(&rhs.fixed_rows::<2>(0).into_owned())
}

fn closest_on_edge(point: Vector, [a, b]: [Vector; 2]) -> Vector {
    let length = (b - a).norm();
    if length == 0.0 {
        return a;
    }
    let direction = (b - a) / length;
    let along = (point - a).dot(&direction);
    if along >= length { b } else { a + direction * along.max(0.0) }
}

fn edge_edge(e1: [Vector; 2], e2: [Vector; 2]) -> [Vector; 2] {
    let (d1, d2) = (e1[1] - e1[0], e2[1] - e2[0]);
    let crossing = least_squares([d1, -d2], e2[0] - e1[0])
        .filter(|w| w.iter().all(|x| (0.0..=1.0).contains(x)))
        .map(|w| [e1[0] + d1 * w.x, e2[0] + d2 * w.y]);
    let ends1 = e1.map(|v| [v, closest_on_edge(v, e2)]);
    let ends2 = e2.map(|v| [closest_on_edge(v, e1), v]);
    let by_distance =
        |a: &[Vector; 2], b: &[Vector; 2]| (a[1] - a[0]).norm().total_cmp(&(b[1] - b[0]).norm());
    crossing.into_iter().chain(ends1).chain(ends2).min_by(by_distance).expect("4 or 5 candidates")
}

/// The foot of the perpendicular when it lies in the triangle, else a vertex (which the edges
/// answer for better).
fn closest_in_face(point: Vector, t: &Triangle) -> Vector {
    let columns = [t[1] - t[0], t[2] - t[0]];
    least_squares(columns, point - t[0])
        .filter(|w| w.x >= 0.0 && w.y >= 0.0 && w.x + w.y <= 1.0)
        .map_or(t[0], |w| t[0] + columns[0] * w.x + columns[1] * w.y)
}

/// True if an edge of `t1` passes through `t2`.
fn pierces(t1: &Triangle, t2: &Triangle) -> bool {
    edges(t1).into_iter().any(|[a, b]| {
        Matrix3::from_columns(&[t2[1] - t2[0], t2[2] - t2[0], a - b])
            .lu()
            .solve(&(a - t2[0]))
            .is_some_and(|w| w.min() >= 0.0 && w.x + w.y <= 1.0 && w.z <= 1.0)
    })
}

/// The unit vector perpendicular to two directions, exactly so to the first. None when parallel.
fn perpendicular(u: Vector, v: Vector) -> Option<Vector> {
    let (u, v) = (u.try_normalize(0.0)?, v.try_normalize(0.0)?);
    let mut n = u.cross(&v).try_normalize(0.0)?;
    for _ in 0..2 {
        n = (n - u * u.dot(&n)).try_normalize(0.0)?;
    }
    Some(n)
}

fn least_translation(t1: &Triangle, t2: &Triangle, size: f64) -> TruthContact {
    let directions = |t: &Triangle| edges(t).map(|[a, b]| b - a);
    let (d1, d2) = (directions(t1), directions(t2));
    let faces = [d1, d2].into_iter().flat_map(|d| [(d[0], d[1]), (d[1], d[2]), (d[2], d[0])]);
    let products = d1.into_iter().flat_map(|u| d2.map(|v| (u, v)));
    let axes: ArrayVec<(f64, DVec3), 30> = faces
        .chain(products)
        .filter_map(|(u, v)| perpendicular(u, v).map(plain))
        .flat_map(|n| [n, -n])
        .map(|n| (separation(&t1.map(plain), &t2.map(plain), n), n))
        .collect();
    // Both triangles lie on one line if there is no axis: the least translation is sideways, by
    // nothing.
    let sideways = d1[0].cross(&Vector::x()) + d1[0].cross(&Vector::y());
    let flat = (0.0, plain(sideways.try_normalize(0.0).unwrap_or(Vector::z())));
    let best = axes.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(flat);
    let rivals =
        |&(s, n): &(f64, DVec3)| s > best.0 - UNCLEAR * size && n.dot(best.1) < 1.0 - 1.0e-7;
    TruthContact {
        distance: best.0.min(0.0),
        normal: best.1,
        normal_is_unique: !axes.is_empty() && !axes.iter().any(rivals),
        closest_points: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    /// The plain cases, by hand: a reference that is wrong here would condemn right code.
    #[test]
    fn plain_cases() {
        let over = contact(&FLOOR, &FLOOR.map(|v| v + DVec3::Z * 0.5));
        assert_eq!((over.distance, over.normal, over.normal_is_unique), (0.5, DVec3::Z, true));
        let beside = contact(&FLOOR, &FLOOR.map(|v| v - DVec3::X * 3.0));
        assert_eq!((beside.distance, beside.normal), (2.0, -DVec3::X));
        assert_eq!(beside.closest_points, Some([DVec3::ZERO, -DVec3::X * 2.0]));
        let crossed = [[0.2, 0.2, -0.1], [0.2, 0.3, 1.0], [0.3, 0.2, 1.0]].map(DVec3::from_array);
        let crossed = contact(&FLOOR, &crossed);
        assert!((crossed.distance + 0.1).abs() < 1.0e-15 && crossed.normal == DVec3::Z);
        assert!(crossed.normal_is_unique && crossed.closest_points.is_none());
        let in_plane = contact(&FLOOR, &FLOOR.map(|v| v * 0.5));
        assert_eq!((in_plane.distance, in_plane.normal.abs()), (0.0, DVec3::Z));
        assert!(!in_plane.normal_is_unique);
        assert_eq!(separation(&FLOOR, &FLOOR.map(|v| v + DVec3::X * 3.0), DVec3::X), 2.0);
    }
}
