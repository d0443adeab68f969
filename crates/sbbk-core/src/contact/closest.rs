//! The closest points of two given features, and the proof that no others are closer.
//!
//! The proof is duality. If all of triangle 2 lies at least `d` beyond triangle 1 along some
//! direction, the distance is at least `d`. Two points at distance `d` show that it is at most `d`.
//! So points of two features are the closest points exactly if each triangle stays on its own side
//! of a plane: the plane through its feature, perpendicular to the direction between the points.
//! The test takes four dot products for any features.

use super::feature::{Feature, FeaturePair};
use super::triangle::{NEAR_PARALLEL, Triangle};
use glamx::DVec3;

/// Distance, in triangle sizes, by which a vertex may lie beyond its bounding plane. Covers
/// rounding. Higher: features that only nearly realise the contact are kept from the last step.
/// Lower: flat contacts, where many features tie, take a full search.
pub(super) const TIE: f64 = 1.0e-13;

/// Least distance, in triangle sizes, of all other vertices behind the closest features in a proof
/// ([`proved`]). Higher: more pairs that nearly tie take a full search. Lower: the contact depends
/// on the features of the last step.
const CLEAR_WIN: f64 = 1.0e-9;

/// Least distance of a closest point from the border of its feature, as a share of the geometric
/// mean of size and distance. Higher: more pairs that nearly tie take a full search. Lower: the
/// contact depends on the features of the last step.
const NEAR: f64 = 1.0e-5;

/// Closest points of two features and the direction from the first to the second.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    pub point1: DVec3,
    pub point2: DVec3,
    pub normal: DVec3,
    pub distance: f64,
}

impl Closest {
    pub fn between(point1: DVec3, point2: DVec3, difference: DVec3) -> Self {
        let distance = difference.length();
        Self { point1, point2, normal: difference / distance, distance }
    }

    fn swapped(self) -> Self {
        Self { point1: self.point2, point2: self.point1, normal: -self.normal, ..self }
    }
}

/// The closest points of two features of the pair: of their lines and planes, and none when
/// those fall outside the features. When the features touch, the normal may be NaN.
#[inline(always)]
pub(super) fn closest(t1: &Triangle, t2: &Triangle, features: FeaturePair) -> Option<Closest> {
    use Feature::{Edge, Face, Vertex};
    match (features.feature1(), features.feature2()) {
        (Vertex(i), Vertex(j)) => {
            let (p, q) = (t1.vertices[i as usize], t2.vertices[j as usize]);
            Some(Closest::between(p, q, q - p))
        }
        (Vertex(i), Edge(j)) => vertex_edge(t1.vertices[i as usize], t2, j as usize),
        (Edge(i), Vertex(j)) => {
            vertex_edge(t2.vertices[j as usize], t1, i as usize).map(Closest::swapped)
        }
        (Edge(i), Edge(j)) => edge_edge(t1, i as usize, t2, j as usize),
        (Vertex(i), Face) => vertex_face(t1.vertices[i as usize], t2),
        (Face, Vertex(j)) => vertex_face(t2.vertices[j as usize], t1).map(Closest::swapped),
        (Face, Edge(_) | Face) | (Edge(_), Face) => None,
    }
}

#[inline(always)]
fn vertex_edge(vertex: DVec3, t: &Triangle, j: usize) -> Option<Closest> {
    let (start, edge) = (t.vertices[j], t.edges[j]);
    let along = (vertex - start).dot(edge) / edge.length_squared();
    let point = start + edge * along;
    let difference = (start - vertex) + edge * along;
    within(along).then(|| Closest::between(vertex, point, difference))
}

#[inline(always)]
fn vertex_face(vertex: DVec3, t: &Triangle) -> Option<Closest> {
    let normal = t.normal();
    if !is_over(vertex, t, normal) {
        return None;
    }
    let height = (t.vertices[0] - vertex).dot(normal);
    let normal = if height < 0.0 { -normal } else { normal };
    let point2 = vertex + normal * height.abs();
    Some(Closest { point1: vertex, point2, normal, distance: height.abs() })
}

/// True if the foot of the perpendicular from `point` lies in the triangle, border included.
/// `normal` is the triangle's, with either sign. False for a triangle without area.
#[inline(always)]
pub(super) fn is_over(point: DVec3, t: &Triangle, normal: DVec3) -> bool {
    let area_beside = |i: usize| t.edges[i].cross(point - t.vertices[i]).dot(normal);
    let areas = [area_beside(0), area_beside(1), area_beside(2)];
    let area = (areas[0] + areas[1] + areas[2]).abs();
    has_one_sign(areas) && area > 0.0 && (!t.is_thin(area * area) || t.is_beside(point))
}

/// True if the values are all positive or zero, or all negative or zero.
#[inline(always)]
fn has_one_sign([a, b, c]: [f64; 3]) -> bool {
    // No branches: the sign cannot be predicted.
    ((a >= 0.0) & (b >= 0.0) & (c >= 0.0)) | ((a <= 0.0) & (b <= 0.0) & (c <= 0.0))
}

#[inline(always)]
fn edge_edge(t1: &Triangle, i: usize, t2: &Triangle, j: usize) -> Option<Closest> {
    let (e1, e2) = (t1.edges[i], t2.edges[j]);
    let between = t2.vertices[j] - t1.vertices[i];
    let cross = e1.cross(e2);
    let area = cross.length_squared();
    let [along1, along2] = closest_on_lines(between, e1, e2);
    if !(within(along1) && within(along2)) {
        return None;
    }
    let point1 = t1.vertices[i] + e1 * along1;
    let point2 = t2.vertices[j] + e2 * along2;
    // A direction from the cross product is off by 1e-16 over the sine; so is the distance, as a
    // share of the length. A direction from the difference is off by 1e-16 over the distance.
    let lengths = e1.length_squared() * e2.length_squared();
    if area < NEAR_PARALLEL * NEAR_PARALLEL * lengths {
        return Some(Closest::between(point1, point2, between + e2 * along2 - e1 * along1));
    }
    let apart = between.dot(cross);
    let scale = apart.signum() / area.sqrt();
    Some(Closest { point1, point2, normal: cross * scale, distance: apart * scale })
}

/// Places where two lines are closest, as fractions of the edges; NaN or infinite for parallel
/// lines. The second point is the foot of the first on its line, so that near parallel lines move
/// both by the same error.
#[inline(always)]
pub(super) fn closest_on_lines(between: DVec3, e1: DVec3, e2: DVec3) -> [f64; 2] {
    let cross = e1.cross(e2);
    let along1 = between.cross(e2).dot(cross) / cross.length_squared();
    [along1, (along1 * e1.dot(e2) - between.dot(e2)) / e2.length_squared()]
}

/// `along` clamped to 0 to 1; a NaN gives 0.
#[inline(always)]
pub(super) fn within_edge(along: f64) -> f64 {
    let at_least_0 = if along > 0.0 { along } else { 0.0 };
    if at_least_0 < 1.0 { at_least_0 } else { 1.0 }
}

fn within(along: f64) -> bool {
    (0.0..=1.0).contains(&along)
}

/// The closest points of two features, if they are clearly the only closest points of the
/// triangles. Then a search finds the same features in spite of rounding.
///
/// A search is off by a few times `TIE` of the size in the distance. Points `y` to the side of the
/// closest ones are farther by `y²/2d`. So the closest points must be farther than `√(2d·TIE·size)`
/// from the border of their features. A vertex that is `w` behind the plane puts the foot of a
/// perpendicular `d·w/size` outside, which must be more than rounding. The constants are hundreds
/// of times larger.
#[inline(always)]
pub(super) fn proved(t1: &Triangle, t2: &Triangle, features: FeaturePair) -> Option<Closest> {
    let closest = closest(t1, t2, features)?;
    let Closest { point1, point2, normal, distance } = closest;
    let (feature1, feature2) = (features.feature1(), features.feature2());
    let size = t1.size + t2.size;
    let win = CLEAR_WIN * size * (1.0 + NEAR * size / distance);
    let border_squared = NEAR * NEAR * distance * (size + distance);
    let is_proved = t1.is_behind(feature1, normal, TIE * t1.size, win)
        && t2.is_behind(feature2, -normal, TIE * t2.size, win)
        && t1.is_well_inside(feature1, point1, border_squared)
        && t2.is_well_inside(feature2, point2, border_squared)
        && !are_near_parallel(t1, feature1, t2, feature2);
    is_proved.then_some(closest)
}

#[inline(always)]
fn are_near_parallel(t1: &Triangle, feature1: Feature, t2: &Triangle, feature2: Feature) -> bool {
    let (Feature::Edge(i), Feature::Edge(j)) = (feature1, feature2) else {
        return false;
    };
    let (e1, e2) = (t1.edges[i as usize], t2.edges[j as usize]);
    let lengths = e1.length_squared() * e2.length_squared();
    e1.cross(e2).length_squared() < NEAR_PARALLEL * NEAR_PARALLEL * lengths
}
