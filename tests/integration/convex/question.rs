use std::collections::BTreeMap;

use glamx::Vec3;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher,
};
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

    /// Panics unless an answer is that of Parry's routine on all triangles, bit for bit: each
    /// manifold of ours is one of brute force, and each of brute force that has a point within the
    /// prediction distance is one of ours. The number of contacts.
    pub fn check_against_parry(&self, name: &str, found: &[Manifold]) -> usize {
        let all = self.brute_force();
        let by_triangle: BTreeMap<u32, &Manifold> =
            found.iter().map(|manifold| (self.triangle_of(manifold), manifold)).collect();
        assert_eq!(by_triangle.len(), found.len(), "{name}: two manifolds of one triangle");
        for (triangle, manifold) in &by_triangle {
            let expected =
                all.get(triangle).unwrap_or_else(|| panic!("{name}: {triangle} is invented"));
            assert!(bits(manifold) == bits(expected), "{name}: {triangle}");
        }
        let touching = all.iter().filter(|(_, manifold)| touches(manifold, self.prediction));
        for (triangle, expected) in touching.clone() {
            let points = &expected.points;
            assert!(by_triangle.contains_key(triangle), "{name}: {triangle} is lost, {points:?}");
        }
        touching.count()
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

    /// Parry's routine on each triangle of the mesh, called as stock calls it; manifolds with
    /// points.
    pub fn brute_force(&self) -> BTreeMap<u32, Manifold> {
        let all = (0..self.mesh.indices().len() as u32).filter_map(|index| {
            let subshapes = if self.flipped { [0, index] } else { [index, 0] };
            let mut manifold = Manifold::with_data(subshapes[0], subshapes[1], ());
            let triangle = self.mesh.triangle(index);
            let cone = self.mesh.triangle_normal_constraints(index);
            let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
            let (shape, parry) = (&*self.shape.0, DefaultQueryDispatcher);
            let (pos12, within) = (self.pos12(), self.prediction);
            let answer = if self.flipped {
                let pose = pos12.inverse().inverse();
                parry.contact_manifold_convex_convex(
                    &pose,
                    shape,
                    &triangle,
                    None,
                    cone,
                    within,
                    &mut manifold,
                )
            } else {
                parry.contact_manifold_convex_convex(
                    &pos12,
                    &triangle,
                    shape,
                    cone,
                    None,
                    within,
                    &mut manifold,
                )
            };
            answer.expect("Parry knows contacts of all these shapes with triangles");
            (!manifold.points.is_empty()).then_some((index, manifold))
        });
        all.collect()
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
