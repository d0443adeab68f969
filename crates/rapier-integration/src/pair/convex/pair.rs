use parry3d::bounding_volume::Aabb;
use parry3d::math::Real;

use super::parts::Parts;
use crate::mesh::Hierarchy;
use crate::pair::pose::{MeshPlace, PairPose};

/// A mesh and one or more convex shapes.
#[derive(Copy, Clone)]
pub(crate) struct ConvexPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) mesh: Hierarchy<'a>,
    pub(crate) parts: Parts<'a>,
    pub(crate) mesh_place: MeshPlace,
    /// Whether contacts are those of the surface of the mesh.
    pub(crate) has_surfaces: bool,
    /// Whether parts are led out of the mesh, if it bounds a solid.
    pub(crate) leave_solids: bool,
    pub(crate) has_patches: bool,
}

impl ConvexPair<'_> {
    /// The box around the mesh in the frame of the parts, grown by `reach`.
    pub(super) fn mesh_box(&self, reach: Real) -> Aabb {
        let pos12 = self.pose.pos12;
        let pose = if self.mesh_place.is_second() { pos12 } else { pos12.inverse() };
        self.mesh.placed_root(&pose, reach)
    }
}
