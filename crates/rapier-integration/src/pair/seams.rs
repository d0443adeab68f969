//! Triangles that share edges and corners, by the places of their corners.

use glamx::Vec3;
use sbbk_core::contact::Feature;

/// A triangle in the frame of the mesh.
pub(crate) struct Touched {
    pub(crate) corners: [Vec3; 3],
}

impl Touched {
    /// Returns true if the triangle has an edge or a corner of another triangle.
    pub(crate) fn has(&self, other: &Self, feature: Feature) -> bool {
        let [a, b, c] = other.corners;
        let ends = match feature {
            Feature::Vertex(i) => [other.corners[usize::from(i)]; 2],
            Feature::Edge(1) => [b, c],
            Feature::Edge(2) => [c, a],
            Feature::Edge(_) | Feature::Face => [a, b],
        };
        ends.iter().all(|end| self.corners.contains(end))
    }
}
