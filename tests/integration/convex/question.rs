use std::collections::BTreeMap;

use glamx::Vec3;
use rapier3d::math::Real;
use rapier3d::parry::query::{ContactManifold, DefaultQueryDispatcher, QueryDispatcher};
use sbbk_core::traverse::Placement;
use sbbk_truth::ConvexBody;

use crate::support::{Manifold, Question, distance};

/// The triangle of a manifold of a mesh, the first shape, and a convex shape.
pub(super) fn triangle_of<M, C>(question: &Question, manifold: &ContactManifold<M, C>) -> u32 {
    let [mesh, other] = question.subshapes(manifold);
    assert_eq!(other, 0, "the convex shape has no subshapes");
    mesh
}

/// Distance of a triangle and the convex shape, by Parry.
pub(super) fn apart(question: &Question, triangle: u32) -> Real {
    let triangle = question.mesh().triangle(triangle);
    let distance = DefaultQueryDispatcher.distance(&question.pose, &triangle, question.shapes[1]);
    distance.expect("Parry knows the distance of all these shapes to triangles").distance
}

/// Panics unless contacts are those of brute force in f64, up to `tolerance`. Returns their number.
pub(super) fn check_against_truth(
    question: &Question,
    name: &str,
    found: &[Manifold],
    body: &ConvexBody,
    tolerance: f64,
) -> usize {
    let placement = Placement::new(&question.pos12());
    let placement = if question.is_flipped { placement } else { placement.inverted() };
    let found: BTreeMap<u32, Real> =
        found.iter().map(|m| (triangle_of(question, m), distance(m))).collect();
    let prediction = f64::from(question.prediction);
    for (index, triangle) in (0..).zip(question.mesh().triangles()) {
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
