//! A mesh and one or more convex shapes.

use parry3d::bounding_volume::Aabb;
use parry3d::math::Real;
use parry3d::shape::HalfSpace;

use super::parts::Parts;
use super::shape::ConvexShape;
use crate::SbbkConfig;
use crate::mesh::MeshView;
use crate::pair::pose::{MeshPlace, PairPose};

/// A mesh and one or more convex shapes, at a pose.
#[derive(Copy, Clone)]
pub(crate) struct ConvexPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) mesh: MeshView<'a>,
    pub(crate) parts: Parts<'a>,
    pub(crate) mesh_place: MeshPlace,
    pub(crate) config: &'a SbbkConfig,
}

impl ConvexPair<'_> {
    /// Returns the box around the mesh in the frame of the parts, grown by `reach`.
    pub(super) fn mesh_box(&self, reach: Real) -> Aabb {
        self.mesh.placed_root(&self.mesh_place.mesh_in_shape(&self.pose.pos12), reach)
    }

    /// Returns true for contacts of the surface. Soft bodies need contacts of each triangle.
    pub(super) fn has_surface(&self) -> bool {
        self.config.wants_surfaces() && self.mesh.is_rigid()
    }

    pub(super) fn is_ball(&self) -> bool {
        matches!(self.parts, Parts::One(ConvexShape::Ball(_)))
    }

    /// Returns true if contacts make patches: unless the mesh is deformable or the shape is a ball,
    /// which has few contacts of one point.
    pub(super) fn has_patches(&self) -> bool {
        self.config.has_patches() && self.mesh.is_rigid() && !self.is_ball()
    }

    /// Returns the half-space if contacts with it are [vertices](super::half_space).
    pub(super) fn half_space_by_vertices(&self) -> Option<&HalfSpace> {
        let Parts::One(ConvexShape::HalfSpace(half_space)) = self.parts else { return None };
        self.has_patches().then_some(half_space)
    }
}
