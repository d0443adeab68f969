//! The contact of two triangles, for hosts with a midphase of their own.

use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::Triangle;
use sbbk_core::contact::{FeaturePair, ManifoldPoints, clip, push_closest};
use sbbk_core::query::TrianglePair;

use super::pose::PairPose;
use super::query::ContactPoints;
use super::shapes::contact_of;
use super::triangle_points::write_triangle_points;
use super::write::write_points;

/// The contacts of two triangles from step to step, without meshes: for hosts with a midphase of
/// their own.
///
/// Exact at every scale, see [`sbbk_core::contact`](mod@sbbk_core::contact).
#[derive(Clone, Debug)]
pub struct TriangleContacts<C> {
    features: Option<FeaturePair>,
    points: Vec<TrackedContact<()>>,
    previous_points: Vec<TrackedContact<C>>,
}

impl<C> Default for TriangleContacts<C> {
    fn default() -> Self {
        Self { features: None, points: Vec::new(), previous_points: Vec::new() }
    }
}

impl<C: Default + Copy> TriangleContacts<C> {
    /// Brings the manifold of two triangles up to date, `triangle2` at `pos12` in the frame of
    /// `triangle1`.
    ///
    /// The manifold has no points if the triangles are farther apart than `prediction`, if normal
    /// constraints reject the contact, or for numbers that are not finite.
    pub fn update<M>(
        &mut self,
        pos12: &Pose,
        triangles: [&Triangle; 2],
        normal_constraints: [Option<&dyn NormalConstraints>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let pose = PairPose::new(pos12, prediction);
        let [corners1, corners2] = triangles.map(|Triangle { a, b, c }| [*a, *b, *c]);
        let triangles = TrianglePair::new(&pose.placement12, corners1, corners2);
        let mut clipped = ManifoldPoints::new();
        let [t1, t2] = &triangles.corners;
        let contact = contact_of(&triangles, f64::from(prediction), self.features);
        self.features = contact.map(|contact| contact.features);
        let points = std::mem::take(&mut self.points);
        let mut points = ContactPoints { points, ..ContactPoints::default() };
        points.points.clear();
        if let Some(contact) = contact {
            clip(t1, t2, contact.normal, &mut clipped);
            push_closest(t1, t2, &contact, &mut clipped);
            let cones = normal_constraints;
            write_triangle_points(&pose, &triangles, &contact, &mut clipped, cones, &mut points);
        }
        if points.points.is_empty() {
            manifold.points.clear();
        } else {
            write_points(&points, &mut self.previous_points, manifold);
        }
        self.points = points.points;
    }
}
