use crate::prelude::*;
use rapier3d::parry::bounding_volume::BoundingVolume;
use sbbk_core::traverse::Placement;
use sbbk_truth::ConvexBody;

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
    let found = found.iter().map(|manifold| (question.subshapes(manifold), distance(manifold)));
    let found: BTreeMap<[u32; 2], Real> = found.collect();
    assert!(found.keys().all(|&[_, other]| other == 0), "the convex shape has no subshapes");
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
        match found.get(&[index, 0]) {
            Some(&near) => {
                let error = (f64::from(near) - truth).abs();
                assert!(error <= tolerance, "{name}: {index} at {near}, is at {truth}");
            }
            None => assert!(truth >= prediction - tolerance, "{name}: {index} is lost"),
        }
    }
    found.len()
}
