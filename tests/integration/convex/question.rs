use std::collections::BTreeMap;

use glamx::Vec3;
use rapier3d::math::Real;
use rapier3d::parry::bounding_volume::BoundingVolume;
use rapier3d::parry::query::ContactManifold;
use sbbk_core::traverse::Placement;
use sbbk_truth::ConvexBody;

use crate::support::{Manifold, Question, distance};

/// The triangle of a manifold of a mesh, the first shape, and a convex shape.
pub(super) fn triangle_of<M, C>(question: &Question, manifold: &ContactManifold<M, C>) -> u32 {
    let [mesh, other] = question.subshapes(manifold);
    assert_eq!(other, 0, "the convex shape has no subshapes");
    mesh
}

/// Compares contacts with brute force in f64, up to `tolerance`. Returns their number. Triangles beside
/// the box of the shape are known to be far.
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
    let around = question.shapes[1].compute_local_aabb().loosened(1.01 * question.prediction);
    for (index, triangle) in (0..).zip(question.mesh().triangles()) {
        let corners = triangle.vertices().map(|v| placement.to_frame1(v, Vec3::ZERO));
        let is_beside = (0..3).any(|axis| {
            let [low, high] = [around.mins[axis], around.maxs[axis]].map(f64::from);
            corners.iter().all(|corner| corner[axis] < low)
                || corners.iter().all(|corner| corner[axis] > high)
        });
        let truth = if is_beside { f64::INFINITY } else { body.distance(&corners) };
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
