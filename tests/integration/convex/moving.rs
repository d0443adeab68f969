use super::queries::{least_at, truth_of};
use crate::prelude::*;
use glamx::{DAffine3, DQuat};
use sbbk_truth::ConvexBody;

/// A floor of this side with a wall across it, which is a sheet and the last triangle.
pub(super) fn walled(side: Real, cells: u32, place: Real) -> TriMesh {
    let mut floor = mesh::floor(side, cells);
    let first = floor.vertices.len() as u32;
    let corners = [[place, -1.0, -9.0], [place, -1.0, 9.0], [place, 9.0, 0.0]];
    floor.vertices.extend(corners.map(Vec3::from_array));
    floor.triangles.push([first, first + 1, first + 2]);
    shape(&floor)
}

/// A mesh and a shape on their ways until some time.
#[derive(Clone, Copy)]
pub(super) struct Cast<'a> {
    pub mesh: &'a TriMesh,
    pub shape: &'a SharedShape,
    /// First the mesh, then the shape.
    pub motions: [NonlinearRigidMotion; 2],
    pub is_mesh_first: bool,
    pub until: Real,
}

impl<'a> Cast<'a> {
    /// A shape that moves past a mesh, which stays, until the time of one unit.
    pub fn past(mesh: &'a TriMesh, shape: &'a SharedShape, moving: NonlinearRigidMotion) -> Self {
        let still = NonlinearRigidMotion::identity();
        Self { mesh, shape, motions: [still, moving], is_mesh_first: true, until: 1.0 }
    }

    pub fn swap<T>(&self, [one, two]: [T; 2]) -> [T; 2] {
        if self.is_mesh_first { [one, two] } else { [two, one] }
    }

    pub fn ask(&self, dispatcher: &dyn QueryDispatcher, stop: bool) -> Option<ShapeCastHit> {
        let [g1, g2] = self.swap::<&dyn Shape>([self.mesh, &*self.shape.0]);
        let [motion1, motion2] = self.swap(self.motions);
        dispatcher
            .cast_shapes_nonlinear(&motion1, g1, &motion2, g2, 0.0, self.until, stop)
            .expect("supported")
    }

    /// Places of mesh and shape in f64.
    pub fn places(&self, time: f64) -> [DAffine3; 2] {
        self.motions.map(|motion| {
            let affine = |pose: Pose3| {
                let turn = pose.rotation.as_dquat().normalize();
                DAffine3::from_rotation_translation(turn, pose.translation.as_dvec3())
            };
            let start = affine(motion.start);
            let centre = start.transform_point3(motion.local_center.as_dvec3());
            let turn = DQuat::from_scaled_axis(motion.angvel.as_dvec3() * time);
            let there = centre + motion.linvel.as_dvec3() * time;
            DAffine3::from_translation(there)
                * DAffine3::from_quat(turn)
                * DAffine3::from_translation(-centre)
                * start
        })
    }

    /// The least distance, or minus the greatest depth, of a triangle.
    pub fn distance(&self, body: &ConvexBody, time: f64) -> f64 {
        let [mesh, shape] = self.places(time);
        least_at(self.mesh, body, &self.shape.compute_local_aabb(), shape.inverse() * mesh)
    }

    /// No point of one moves faster than this against the other: seen from where the shape is, and
    /// without what both turn alike.
    pub fn speed(&self, size: f64) -> f64 {
        let [mesh, shape] = &self.motions;
        let arm = |motion: &NonlinearRigidMotion| f64::from(motion.local_center.length()) + size;
        let turn = |motion: &NonlinearRigidMotion| f64::from(motion.angvel.length());
        let linear = f64::from((mesh.linvel - shape.linvel).length());
        let is_endless = self.shape.as_halfspace().is_some();
        let shape_arm = if is_endless {
            let between = |time: f64| {
                let [mesh_place, shape_place] = self.places(time);
                let centre = |place: DAffine3, motion: &NonlinearRigidMotion| {
                    place.transform_point3(motion.local_center.as_dvec3())
                };
                centre(mesh_place, mesh).distance(centre(shape_place, shape))
            };
            between(0.0).max(between(1.0)) + arm(mesh)
        } else {
            arm(shape)
        };
        linear + turn(mesh) * arm(mesh) + turn(shape) * shape_arm
    }

    /// The least distance on the way to a time, and whether the march got there: no touch deeper
    /// than `tolerance` is missed. Triangles are looked at when they may be the nearest.
    pub fn march(&self, body: &ConvexBody, speed: f64, tolerance: f64, end: f64) -> (f64, bool) {
        let (mut time, mut nearest) = (0.0, f64::INFINITY);
        let mut clear = vec![f64::NEG_INFINITY; self.mesh.indices().len()];
        for _ in 0..500 {
            let [mesh, shape] = self.places(time);
            let in_shape = shape.inverse() * mesh;
            let mut distance = f64::INFINITY;
            for (clear, triangle) in clear.iter_mut().zip(self.mesh.triangles()) {
                if *clear < distance {
                    *clear = truth_of(&triangle, body, in_shape);
                    distance = distance.min(*clear);
                }
            }
            nearest = nearest.min(distance);
            let step = distance.abs().max(tolerance);
            clear.iter_mut().for_each(|clear| *clear -= step);
            time += step / speed;
            if time >= end {
                return (nearest, true);
            }
        }
        (nearest, false)
    }
}
