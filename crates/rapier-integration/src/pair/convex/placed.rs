use glamx::{DQuat, DVec3, Vec3};
use parry3d::math::Pose;
use sbbk_core::traverse::Placement;

use super::parts::Part;
use super::shape::{ConvexShape, Extent};
use crate::pair::pose::MeshPlace;

/// A part at the pose of a query, with all that its triangles share.
#[derive(Copy, Clone)]
pub(crate) struct PlacedPart {
    pub(super) index: u32,
    pub(super) extent: Extent,
    /// Pose of the mesh in the frame of the part.
    pub(super) placement: Placement,
    /// Pose of the part in the frame of the mesh.
    pub(super) inverse: Placement,
    /// Centre of a ball in the frame of the mesh, if the part's frame has the axes of the mesh. No
    /// triangle needs a rotation then.
    pub(super) centre_in_mesh: Option<DVec3>,
}

impl PlacedPart {
    /// `placements`: the mesh in the frame of the whole, and the whole in the frame of the mesh.
    pub(super) fn new(
        index: u32,
        part: &Part<'_>,
        placements: [&Placement; 2],
        extent: Extent,
    ) -> Self {
        let [placement, inverse] = placements.map(|placement| *placement);
        let placed = Self { index, extent, placement, inverse, centre_in_mesh: None };
        // In f64: a product of poses in f32 is off by 1e-7 of the distance.
        part.pose.map_or(placed, |part| {
            let placement = Placement::new(part).inverted().of(&placement);
            Self { placement, inverse: placement.inverted(), ..placed }
        })
    }

    /// Returns this part, a whole shape, at another pose of shape 2 in the frame of shape 1.
    pub(super) fn moved(&self, mesh_place: MeshPlace, placement: &Placement) -> Self {
        let [inverse, placement] = mesh_place.swap([*placement, placement.inverted()]);
        Self { placement, inverse, centre_in_mesh: None, ..*self }
    }

    /// Gives a ball the axes of the mesh.
    pub(super) fn in_mesh_axes(mut self, shape: ConvexShape<'_>) -> Self {
        if matches!(shape, ConvexShape::Ball(_)) {
            let is_finite = self.placement.is_finite();
            let centre = if is_finite { self.inverse.translation } else { DVec3::NAN };
            self.centre_in_mesh = Some(centre);
        }
        self
    }

    /// Returns the pose of the part in the frame of the mesh, in f32 and with a unit quaternion.
    pub(super) fn pose_in_mesh(&self) -> Pose {
        let rotation = DQuat::from_mat3(&self.inverse.rotation).normalize();
        Pose::from_parts(self.inverse.translation.as_vec3(), rotation.as_quat())
    }

    /// Returns points of the mesh in the frame of the part.
    #[inline(always)]
    pub(super) fn in_part(&self, [a, b, c]: [Vec3; 3]) -> [DVec3; 3] {
        if let Some(centre) = self.centre_in_mesh {
            return [a, b, c].map(|point| point.as_dvec3() - centre);
        }
        let at = |point: Vec3| self.placement.to_frame1(point, Vec3::ZERO);
        [at(a), at(b), at(c)]
    }

    /// Returns a point of the part in the frame of the mesh.
    #[inline(always)]
    pub(crate) fn in_mesh(&self, point: DVec3) -> Vec3 {
        if let Some(centre) = self.centre_in_mesh {
            return (centre + point).as_vec3();
        }
        (self.placement.inverse * (point - self.placement.translation)).as_vec3()
    }

    /// Returns a unit vector of the part's frame in the axes of the mesh and of the part.
    #[inline(always)]
    pub(super) fn directions(&self, normal: DVec3) -> [DVec3; 2] {
        if self.centre_in_mesh.is_some() {
            [normal, (self.placement.rotation * normal).normalize()]
        } else {
            [(self.placement.inverse * normal).normalize(), normal]
        }
    }

    /// Returns true only if a triangle is farther than `reach` from the part without its radius: their
    /// boxes are, along the axes of the part.
    #[inline(always)]
    pub(super) fn is_beyond(&self, [a, b, c]: &[DVec3; 3], reach: f64) -> bool {
        let (min, max, reach) = self.extent.widest(reach);
        let gap = (a.min(*b).min(*c) - max).max(min - a.max(*b).max(*c)).max(DVec3::ZERO);
        gap.length_squared() > reach * reach
    }
}
