//! What kind of surface a mesh is: closed, oriented, degenerate; and how much it encloses.

use std::collections::HashMap;

use glamx::{DVec3, Vec3};
use thiserror::Error;

use super::Mesh;

/// How an edge breaks a closed, oriented surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenEdgeKind {
    /// No triangle runs along the edge the other way: the surface has a rim here.
    Rim,
    /// Several triangles run along the edge the same way: neighbours disagree about which side
    /// is out, or more than two triangles meet.
    Repeated,
}

/// The first edge that keeps a mesh from being closed and consistently oriented.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "edge {from}-{to} of triangle {triangle_index} is not shared by exactly two opposite triangles ({kind:?})"
)]
pub struct OpenEdge {
    /// The triangle that brings the edge in.
    pub triangle_index: usize,
    /// Index of the vertex where the edge starts.
    pub from: u32,
    /// Index of the vertex where the edge ends.
    pub to: u32,
    /// What is wrong with the edge.
    pub kind: OpenEdgeKind,
}

impl Mesh {
    /// Checks that each edge is shared by exactly two triangles that run along it in opposite
    /// directions, by vertex index: weld first where equal positions have several indices.
    ///
    /// Errors: the first edge, in triangle order, that is not.
    pub fn check_closed(&self) -> Result<(), OpenEdge> {
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        for triangle in &self.triangles {
            for edge in edges(triangle) {
                *uses.entry(edge).or_default() += 1;
            }
        }
        for (triangle_index, triangle) in self.triangles.iter().enumerate() {
            for [from, to] in edges(triangle) {
                let kind = match (uses[&[from, to]], uses.contains_key(&[to, from])) {
                    (1, true) if from != to => continue,
                    (1, _) => OpenEdgeKind::Rim,
                    _ => OpenEdgeKind::Repeated,
                };
                return Err(OpenEdge { triangle_index, from, to, kind });
            }
        }
        Ok(())
    }

    /// Signed volume, in cubed units: positive when a closed surface faces outwards. Of an open
    /// surface, the volume between it and the origin.
    pub fn volume(&self) -> f64 {
        let six_fold: f64 = (0..self.triangle_count())
            .map(|index| {
                let [a, b, c] = self.corners(index).map(Vec3::as_dvec3);
                a.dot(b.cross(c))
            })
            .sum();
        six_fold / 6.0
    }

    /// Total area of the triangles, in squared units.
    pub fn area(&self) -> f64 {
        (0..self.triangle_count())
            .map(|index| 0.5 * doubled_area(self.corners(index)).length())
            .sum()
    }

    /// Number of triangles without area: a repeated corner, or all three on a line, exactly.
    /// Loaded files keep them, since what a mesh holds is the user's affair.
    pub fn degenerate_count(&self) -> usize {
        (0..self.triangle_count())
            .filter(|&index| doubled_area(self.corners(index)) == DVec3::ZERO)
            .count()
    }
}

fn edges(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Normal times twice the area. In f64 the products of f32 differences are exact, so that it is
/// zero exactly when the stored corners are collinear, up to the rounding of the differences.
fn doubled_area(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}
