//! The faces of a convex hull, proved to be those.

use super::lanes::PointLanes;
use super::polytope::{Face, Polytope};
use super::simplex::thin_normal;
use super::support::Vertex;
use arrayvec::ArrayVec;
use glamx::DVec3;

/// Points at most. More: faces of larger hulls than this take as long as a search.
pub(super) const POINTS: usize = 128;

/// Faces at most: a closed surface of so many points has fewer than twice as many.
pub(super) const FACES: usize = 2 * POINTS;

/// Share of the size that rounding leaves open.
pub(super) const ROUNDING: f64 = 1.0e-14;

/// A hull thinner than this share of its size has no faces.
const FLAT: f64 = 1.0e-9;

/// A closed convex surface of triangles.
pub(super) struct HullSurface {
    /// The unit normal of each face, outward, and how far the hull reaches along it.
    pub planes: ArrayVec<(DVec3, f64), FACES>,
    /// Counterclockwise from outside.
    pub corners: Vec<[DVec3; 3]>,
    /// The face across the edge from each corner to the next.
    pub neighbors: Vec<[u8; 3]>,
}

impl HullSurface {
    /// Builds the surface from triangles that use all points. `None` if they are no closed convex
    /// surface, counterclockwise from outside.
    ///
    /// A surface without concave edges whose face count excludes handles is convex everywhere.
    pub fn from_triangles(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Self> {
        let slack = ROUNDING * size(points.iter().copied());
        let neighbors = neighbors_of(points.len(), triangles)?;
        let mut surface = Self { neighbors, ..Self::empty() };
        for triangle in triangles {
            let corners = triangle.map(|corner| points[corner as usize]);
            let (normal, squared) = thin_normal(corners)?;
            let normal = normal / squared.sqrt();
            let heights = corners.map(|corner| corner.dot(normal));
            surface.planes.push((normal, heights[0].max(heights[1]).max(heights[2])));
            surface.corners.push(corners);
        }
        for (&(normal, height), neighbors) in surface.planes.iter().zip(&surface.neighbors) {
            for &neighbor in neighbors {
                let corners = surface.corners.get(usize::from(neighbor))?;
                let is_convex = corners.iter().all(|c| c.dot(normal) <= height + slack);
                if !is_convex {
                    return None;
                }
            }
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
        let mut surface = Self::empty();
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

    fn empty() -> Self {
        Self { planes: ArrayVec::new(), corners: Vec::new(), neighbors: Vec::new() }
    }
}

/// Returns the triangle across each edge: 255 at a border. `None` if triangles share a directed edge, leave out a point, or are
/// not as many as a closed surface has.
fn neighbors_of(count: usize, triangles: &[[u32; 3]]) -> Option<Vec<[u8; 3]>> {
    const NONE: u8 = u8::MAX;
    let is_closed = (4..=POINTS).contains(&count) && triangles.len() == 2 * count - 4;
    if !is_closed || triangles.as_flattened().iter().any(|&corner| corner as usize >= count) {
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
    let are_all_used = is_used[..count].iter().all(|is_used| *is_used);
    are_all_used.then(|| triangles.iter().map(across).collect())
}

/// The largest coordinate, or a bit more.
fn size(points: impl Iterator<Item = DVec3>) -> f64 {
    points.fold(0.0, |size: f64, p| size.max(p.abs().element_sum()))
}
