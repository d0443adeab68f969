//! Brute force in f64.

use crate::prelude::*;
use glamx::DPose3;
use rapier3d::parry::query::ContactManifold;
use rapier3d::parry::shape::Triangle;
use sbbk_testkit::judge::{Errors, Truth};
use sbbk_truth::{TruthPair, pairs_within};

/// Pairs of triangles of two meshes at a distance of at most `margin`.
pub fn of_meshes(meshes: [&TriMesh; 2], pos12: DPose3, margin: f64) -> Vec<TruthPair> {
    let corners = |triangle: Triangle| triangle.vertices().map(|corner| corner.as_dvec3());
    pairs_within(meshes.map(|mesh| mesh.triangles().map(corners)), pos12, margin)
}

/// A pose in f64 whose quaternion has length one.
pub fn normalized(pose: &Pose3) -> DPose3 {
    DPose3::from_parts(pose.translation.as_dvec3(), pose.rotation.as_dquat().normalize())
}

/// The errors of a fresh answer about two meshes. Panics if a contact is beyond the prediction
/// distance.
pub fn errors_of<M, C>(query: &Question, found: &[ContactManifold<M, C>]) -> Errors {
    let prediction = query.prediction;
    assert!(found.iter().all(|manifold| distance(manifold) <= prediction), "beyond {prediction}");
    let margin = 1.01 * f64::from(prediction);
    let truth = of_meshes(query.meshes(), DPose3::from(query.pos12()), margin);
    Truth::of_pairs(truth, prediction).judge(found)
}

/// Panics unless all was right, and there were contacts to judge.
pub fn check_all_right(errors: Errors, least_contacts: usize) {
    let Errors { pairs, true_pairs, .. } = errors;
    assert_eq!(errors, Errors { pairs, true_pairs, ..Errors::default() });
    assert!(true_pairs >= least_contacts, "{true_pairs} contacts");
}
