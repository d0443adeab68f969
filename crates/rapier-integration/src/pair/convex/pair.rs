use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Real};

use super::parts::Parts;
use crate::ContactGenerator;
use crate::mesh::Hierarchy;
use crate::pair::pose::{MeshPlace, PairPose};

/// A mesh and one or more convex shapes.
#[derive(Copy, Clone)]
pub(crate) struct ConvexPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) mesh: Hierarchy<'a>,
    pub(crate) parts: Parts<'a>,
    pub(crate) mesh_place: MeshPlace,
    pub(crate) contacts: ContactGenerator,
    /// Whether contacts are those of the surface of the mesh.
    pub(crate) has_surfaces: bool,
    /// Whether parts are led out of the mesh, if it bounds a solid.
    pub(crate) leave_solids: bool,
    pub(crate) has_patches: bool,
}

/// Parry's GJK ends when it knows a distance, radii not counted, to this share; it calls triangles
/// that are so much beyond the prediction distance contacts as well. Looking for them makes its
/// contacts those of a test of all triangles.
const GJK_TOLERANCE: Real = 1.2e-3;

impl ConvexPair<'_> {
    /// The box around the mesh in the frame of the parts, grown by `reach`.
    pub(super) fn mesh_box(&self, reach: Real) -> Aabb {
        let pos12 = self.pose.pos12;
        let pose = if self.mesh_place.is_second() { pos12 } else { pos12.inverse() };
        self.mesh.placed_root(&pose, reach)
    }

    /// How far contacts may be found of parts with radii of at most `radius`, roundings not
    /// counted.
    pub(super) fn sight(&self, radius: Real) -> Real {
        let prediction = self.pose.prediction.max(0.0);
        match self.contacts {
            ContactGenerator::Exact => prediction,
            ContactGenerator::Parry => prediction + GJK_TOLERANCE * (prediction + radius),
        }
    }

    /// Whether stock walks the hierarchy of the mesh first.
    pub(super) fn is_mesh_first(&self) -> bool {
        let mesh = self.mesh.size_squared();
        self.parts.walk_size().is_none_or(|parts| match self.mesh_place {
            MeshPlace::First => mesh >= parts,
            MeshPlace::Second => parts < mesh,
        })
    }

    /// The pose of shape 2 in the frame of shape 1 with a part in place of the whole: with stock's
    /// roundings.
    pub(super) fn part_pose(&self, part: Option<&Pose>) -> Pose {
        let pos12 = self.pose.pos12;
        let (is_mesh_first, is_mesh_second) = (self.is_mesh_first(), self.mesh_place.is_second());
        match (self.parts, part) {
            (Parts::One(_), _) if is_mesh_second => pos12.inverse().inverse(),
            (Parts::One(_), _) => pos12,
            (_, None) if is_mesh_first == is_mesh_second => pos12,
            (_, None) => pos12.inverse().inverse(),
            (_, Some(part)) => match (is_mesh_second, is_mesh_first) {
                (false, false) => pos12 * *part,
                (false, true) => part.inv_mul(&pos12.inverse()).inverse(),
                (true, true) => part.inv_mul(&pos12),
                (true, false) => (pos12.inverse() * *part).inverse(),
            },
        }
    }
}
