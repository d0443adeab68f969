use std::collections::BTreeMap;

use glamx::Vec3;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::{ContactManifold, DefaultQueryDispatcher, QueryDispatcher};
use rapier3d::parry::shape::{SharedShape, TriMesh};
use sbbk_core::traverse::Placement;
use sbbk_core::truth::ConvexBody;

use crate::support::{Dispatcher, Manifold, Pair, distance};

/// What is asked: the contacts of a mesh and a convex shape.
#[derive(Clone, Copy)]
pub(super) struct Question<'a> {
    pub mesh: &'a TriMesh,
    pub shape: &'a SharedShape,
    /// The pose of the shape in the frame of the mesh.
    pub pose: Pose,
    pub prediction: Real,
    /// Whether the shape comes first.
    pub flipped: bool,
}

impl Question<'_> {
    /// The pose of the second shape in the frame of the first.
    pub fn pos12(&self) -> Pose {
        if self.flipped { self.pose.inverse() } else { self.pose }
    }

    pub fn ask<'p, M, C>(
        &self,
        dispatcher: &impl Dispatcher<M, C>,
        pair: &'p mut Pair<M, C>,
    ) -> &'p mut Pair<M, C> {
        let shapes = [self.mesh, &*self.shape.0];
        pair.ask_of(dispatcher, shapes, self.pose, self.flipped, self.prediction)
    }

    pub fn fresh(&self, dispatcher: &impl Dispatcher<(), ()>) -> Vec<Manifold> {
        std::mem::take(&mut self.ask(dispatcher, &mut Pair::default()).manifolds)
    }

    pub fn triangle_of<M, C>(&self, manifold: &ContactManifold<M, C>) -> u32 {
        let [mesh, other] = if self.flipped {
            [manifold.subshape2, manifold.subshape1]
        } else {
            [manifold.subshape1, manifold.subshape2]
        };
        assert_eq!(other, 0, "the convex shape has no subshapes");
        mesh
    }

    /// Distance of a triangle and the shape, by Parry.
    pub fn apart(&self, triangle: u32) -> Real {
        let triangle = self.mesh.triangle(triangle);
        let distance = DefaultQueryDispatcher.distance(&self.pose, &triangle, &*self.shape.0);
        distance.expect("Parry knows the distance of all these shapes to triangles").distance
    }

    /// Panics unless the answer is that of brute force in f64, up to `tolerance`: triangles within
    /// the prediction distance, each at its distance, without normal constraints. The number of
    /// contacts.
    pub fn check_against_truth(
        &self,
        name: &str,
        found: &[Manifold],
        body: &ConvexBody,
        tolerance: f64,
    ) -> usize {
        let placement = Placement::new(&self.pos12());
        let placement = if self.flipped { placement } else { placement.inverted() };
        let found: BTreeMap<u32, Real> =
            found.iter().map(|m| (self.triangle_of(m), distance(m))).collect();
        let prediction = f64::from(self.prediction);
        for (index, triangle) in (0..).zip(self.mesh.triangles()) {
            let corners = triangle.vertices().map(|v| placement.to_frame1(v, Vec3::ZERO));
            let truth = body.distance(&corners);
            match found.get(&index) {
                Some(&near) => {
                    let error = (f64::from(near) - truth).abs();
                    assert!(error <= tolerance, "{name}: {index} at {near}, is at {truth}");
                }
                None => assert!(truth >= prediction - tolerance, "{name}: {index} is lost"),
            }
        }
        found.len()
    }
}

/// All of a manifold that a user can see. Bits, but a zero has no sign.
pub(super) fn bits(manifold: &Manifold) -> Vec<u32> {
    let mut bits = Vec::new();
    let mut push = |x: f32| bits.push((x + 0.0).to_bits());
    for normal in [manifold.local_n1, manifold.local_n2] {
        normal.to_array().into_iter().for_each(&mut push);
    }
    for point in &manifold.points {
        for p in [point.local_p1, point.local_p2] {
            p.to_array().into_iter().for_each(&mut push);
        }
        push(point.dist);
    }
    let features = manifold.points.iter().flat_map(|point| [point.fid1.0, point.fid2.0]);
    bits.extend(features.collect::<Vec<_>>());
    bits
}

pub(super) fn touches(manifold: &Manifold, prediction: Real) -> bool {
    manifold.points.iter().any(|point| point.dist <= prediction)
}
