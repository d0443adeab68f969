//! Builds the surface of a convex hull, and proves it closed and convex.

use super::lanes::PointLanes;
use super::polytope::{Face, Polytope};
use super::simplex::thin_normal;
use super::support::Vertex;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Most points. Faces of more points cost as much as the search.
pub(super) const POINTS: usize = 128;

/// Faces at most: a closed surface of so many points has fewer than twice as many.
pub(super) const FACES: usize = 2 * POINTS;

/// Share of the size that rounding leaves open.
pub(super) const ROUNDING: f64 = 1.0e-14;

/// A hull thinner than this share of its size has no faces.
const FLAT: f64 = 1.0e-9;

/// A closed convex surface of triangles.
#[derive(Default)]
pub(super) struct HullSurface {
    /// The unit normal of each face, outward, and how far the hull reaches along it.
    pub planes: ArrayVec<(DVec3, f64), FACES>,
    /// Counterclockwise from outside.
    pub corners: Vec<[DVec3; 3]>,
    /// The face across the edge from each corner to the next.
    pub neighbors: Vec<[u8; 3]>,
}

impl HullSurface {
    /// Builds the surface from the probable faces of the hull of some points. `None` if they are no
    /// closed surface, counterclockwise from outside, or too far from convex.
    ///
    /// A surface without concave edges whose face count excludes handles is convex everywhere.
    pub fn from_triangles(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let slack = ROUNDING * size(points.iter().copied());
        let (neighbors, unused) = neighbors_of(points.len(), triangles)?;
        let mut surface = Self { neighbors, ..Self::default() };
        for triangle in triangles {
            let corners = triangle.map(|corner| points[corner as usize]);
            surface.planes.push(plane(&corners)?);
            surface.corners.push(corners);
        }
        surface.flip_until_convex(slack)?;
        for point in unused {
            surface.include(points[point], slack)?;
        }
        Some(surface)
    }

    /// Builds the surface of the hull of at most [`POINTS`] points by growth. `None` for a flat
    /// hull, or if rounding determines the faces.
    pub fn by_growth(points: &PointLanes) -> Option<Self> {
        let size = size(points.iter());
        let slack = ROUNDING * size;
        let vertex = |point: DVec3| Vertex { point, corner: 0 };
        let mut polytope = Polytope::empty(slack);
        polytope.begin(points.tetrahedron(FLAT * size)?.map(vertex));
        while let Some(i) = polytope.first_open() {
            let Face { normal, distance, .. } = *polytope.get(i);
            let (height, point) = points.farthest(normal);
            if height <= distance + slack {
                polytope.close(i);
            } else if !polytope.expand(i, vertex(point)) {
                return None;
            }
        }
        let mut numbers = [u8::MAX; 2 * FACES];
        let mut surface = Self::default();
        for (i, face) in polytope.faces() {
            let (height, _) = points.farthest(face.normal);
            let corners = polytope.corners(face).map(|corner| corner.point);
            // False for a face without area, whose normal is borrowed or zero.
            let is_plane = corners.iter().all(|c| height - c.dot(face.normal) <= 4.0 * slack);
            if !is_plane || face.normal == DVec3::ZERO || surface.planes.is_full() {
                return None;
            }
            numbers[i] = surface.planes.len() as u8;
            surface.planes.push((face.normal, height));
            surface.corners.push(corners);
        }
        for (_, face) in polytope.faces() {
            surface.neighbors.push(face.neighbors.map(|i| numbers[usize::from(i)]));
        }
        Some(surface)
    }
}

/// The normal of a face of a hull, and how far the face reaches along it. `None` if rounding would
/// determine the normal.
pub(super) fn plane(corners: &[DVec3; 3]) -> Option<(DVec3, f64)> {
    let (normal, squared) = thin_normal(*corners)?;
    let normal = normal / squared.sqrt();
    let [a, b, c] = corners.map(|corner| corner.dot(normal));
    Some((normal, a.max(b).max(c)))
}

/// Returns the triangle across each edge, and the points without triangles. `None` if triangles
/// share a directed edge, have a border, or are not as many as a closed surface has.
fn neighbors_of(
    count: usize,
    triangles: &[[u32; 3]],
) -> Option<(Vec<[u8; 3]>, impl Iterator<Item = usize>)> {
    const NONE: u8 = u8::MAX;
    let corners = triangles.as_flattened();
    let is_large = count > POINTS || triangles.len() >= usize::from(NONE);
    if is_large || corners.iter().any(|&corner| corner as usize >= count) {
        return None;
    }
    let edges = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| corner as usize);
        [[a, b], [b, c], [c, a]]
    };
    // The triangle at the edge between two points.
    let mut at_edge = vec![NONE; count * count];
    let mut is_used = [false; POINTS];
    for (i, triangle) in (0..).zip(triangles) {
        for [from, to] in edges(triangle) {
            is_used[from] = true;
            let place = &mut at_edge[from * count + to];
            if std::mem::replace(place, i) != NONE {
                return None;
            }
        }
    }
    let across = |triangle: &[u32; 3]| edges(triangle).map(|[from, to]| at_edge[to * count + from]);
    let neighbors: Vec<[u8; 3]> = triangles.iter().map(across).collect();
    let unused = (0..count).filter(move |point| !is_used[*point]);
    let is_closed = triangles.len() + 4 == 2 * (count - unused.clone().count())
        && !neighbors.as_flattened().contains(&NONE);
    is_closed.then_some((neighbors, unused))
}

/// The largest coordinate, or a bit more.
fn size(points: impl Iterator<Item = DVec3>) -> f64 {
    points.fold(0.0, |size: f64, p| size.max(p.abs().element_sum()))
}
