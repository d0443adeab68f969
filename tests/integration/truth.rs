//! Brute force in f64.

use crate::prelude::*;
use glamx::{DPose3, DVec3};
use rapier3d::parry::query::ContactManifold;
use sbbk_testkit::judge::{Errors, Truth};
use sbbk_truth::{TruthPair, pairs_within};

/// Pairs of triangles of two meshes at a distance of at most `margin`.
pub fn of_meshes(meshes: [&TriMesh; 2], pos12: DPose3, margin: f64) -> Vec<TruthPair> {
    let [(v1, t1), (v2, t2)] = meshes.map(|mesh| {
        let vertices: Vec<DVec3> = mesh.vertices().iter().map(|v| v.as_dvec3()).collect();
        (vertices, mesh.indices())
    });
    pairs_within(&v1, t1, &v2, t2, pos12, margin)
}

/// A pose in f64 whose quaternion has length one.
pub fn normalized(pose: &Pose3) -> DPose3 {
    DPose3::from_parts(pose.translation.as_dvec3(), pose.rotation.as_dquat().normalize())
}

/// The errors of a fresh answer about two meshes. Panics if a contact is beyond the prediction distance.
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
