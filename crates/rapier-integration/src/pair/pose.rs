use glamx::DVec3;
use parry3d::math::{Pose, Real, Vector};
use sbbk_core::traverse::{MovingBody, Placement};

/// Share by which a length may be greater in another frame: quaternions in f32 are not of unit
/// length. Higher: more steps of casts. Lower: impacts are missed.
pub(crate) const STRETCH: f64 = 1.0e-6;

/// Rounding of a sum of some twenty products in f64, as a share of coordinates. Higher: more
/// triangles are looked at. Lower: the nearest one is left out.
pub(crate) const ROUNDING: f64 = 1.0e-14;

/// Pose of shape 2 in the frame of shape 1, and the prediction distance.
#[derive(Copy, Clone)]
pub(crate) struct PairPose {
    /// Pose as the host passes it.
    pub(super) pos12: Pose,
    /// Pose in f64.
    pub(super) placement12: Placement,
    /// Shape 1 in the frame of shape 2.
    placement21: Placement,
    /// The prediction distance.
    pub(super) prediction: Real,
}

impl PairPose {
    pub(crate) fn new(pos12: &Pose, prediction: Real) -> Self {
        let placement12 = Placement::new(pos12);
        Self { pos12: *pos12, placement12, placement21: placement12.inverted(), prediction }
    }

    /// Returns the placement of shape 1 (0) or 2 (1) in the frame of the other shape.
    pub(super) fn placement_of(&self, i: usize) -> &Placement {
        [&self.placement21, &self.placement12][i]
    }

    /// Returns a point of shape 1 (0) or 2 (1) in the frame of the other shape.
    pub(super) fn in_other(&self, i: usize, point: Vector) -> Vector {
        self.placement_of(i).to_frame1(point, Vector::ZERO).as_vec3()
    }

    /// Returns a point of shape 1 (0) or 2 (1) in frame 1, from an origin there.
    pub(super) fn in_local(&self, i: usize, point: Vector, origin: Vector) -> DVec3 {
        match i {
            0 => point.as_dvec3() - origin.as_dvec3(),
            _ => self.placement12.to_frame1(point, origin),
        }
    }
}

/// The shape of a pair whose motion limits how long candidates serve.
#[derive(Copy, Clone)]
pub(crate) struct Moving {
    pub(super) body: MovingBody,
    /// 0 for shape 1, 1 for shape 2.
    pub(super) shape: usize,
}

impl Moving {
    /// Returns the placement of the shape in the frame of the other one.
    pub(super) fn placement(self, pose: &PairPose) -> &Placement {
        pose.placement_of(self.shape)
    }
}

/// The order of a mesh and another shape in their pair.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum MeshPlace {
    First,
    Second,
}

impl MeshPlace {
    /// Swaps mesh and other shape to shape 1 and shape 2, or back.
    #[inline(always)]
    pub(crate) fn swap<T>(self, [one, two]: [T; 2]) -> [T; 2] {
        match self {
            Self::First => [one, two],
            Self::Second => [two, one],
        }
    }

    /// Returns the mesh in the frame of the other shape, and the other shape in the frame of the
    /// mesh.
    pub(super) fn placements(self, pose: &PairPose) -> [&Placement; 2] {
        self.swap([0, 1].map(|i| pose.placement_of(i)))
    }

    /// Returns the mesh in the frame of the other shape.
    pub(crate) fn mesh_in_shape(self, pos12: &Pose) -> Pose {
        if self.is_second() { *pos12 } else { pos12.inverse() }
    }

    /// Returns the other shape in the frame of the mesh.
    pub(crate) fn shape_in_mesh(self, pos12: &Pose) -> Pose {
        if self.is_second() { pos12.inverse() } else { *pos12 }
    }

    pub(crate) fn is_second(self) -> bool {
        self == Self::Second
    }
}
