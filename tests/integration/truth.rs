//! Brute force in f64.

use std::collections::BTreeMap;

use glamx::{DPose3, DVec3, Pose3};
use rapier3d::parry::query::ContactManifold;
use rapier3d::parry::shape::TriMesh;
use sbbk_truth::{self as truth, TruthPair};

use crate::support::{Question, TrianglePair, by_triangles, distance};

/// Pairs of triangles of two meshes at a distance of at most `margin`.
pub fn of_meshes(meshes: [&TriMesh; 2], pos12: DPose3, margin: f64) -> Vec<TruthPair> {
    let [(v1, t1), (v2, t2)] = meshes.map(|mesh| {
        let vertices: Vec<DVec3> = mesh.vertices().iter().map(|v| v.as_dvec3()).collect();
        (vertices, mesh.indices())
    });
    truth::pairs_within(&v1, t1, &v2, t2, pos12, margin)
}

/// A pose in f64 whose quaternion has length one.
pub fn normalized(pose: &Pose3) -> DPose3 {
    DPose3::from_parts(pose.translation.as_dvec3(), pose.rotation.as_dquat().normalize())
}

/// Counts of contacts and of errors.
#[derive(Debug, Default, PartialEq)]
pub struct Tally {
    contacts: usize,
    missed: usize,
    phantom: usize,
    wrong_depth: usize,
    wrong_normal: usize,
}

impl Tally {
    /// Judges a fresh answer.
    pub fn add<M, C>(&mut self, query: &Question, found: &[ContactManifold<M, C>]) {
        let prediction = f64::from(query.prediction);
        let truth = of_meshes(query.meshes(), DPose3::from(query.pos12()), 1.01 * prediction);
        let truth: BTreeMap<TrianglePair, TruthPair> =
            truth.into_iter().map(|pair| ([pair.triangle1, pair.triangle2], pair)).collect();
        let found = by_triangles(found);
        for (pair, manifold) in &found {
            let Some(truth) = truth.get(pair) else {
                self.phantom += 1;
                continue;
            };
            let off = (f64::from(distance(manifold)) - truth.distance).abs();
            self.wrong_depth += usize::from(off > 0.05 * prediction);
            let normal = manifold.local_n1.as_dvec3();
            let is_off = normal.angle_between(truth.normal) > 0.1_f64.to_radians();
            self.wrong_normal += usize::from(truth.normal_is_unique && is_off);
        }
        let is_missed = |(pair, truth): &(&_, &TruthPair)| {
            truth.distance <= 0.99 * prediction && !found.contains_key(*pair)
        };
        self.missed += truth.iter().filter(is_missed).count();
        self.contacts += found.len();
    }

    /// Panics unless all was right, and there were contacts to judge.
    pub fn check_all_right(&self, least_contacts: usize) {
        let right = Self { contacts: self.contacts, ..Self::default() };
        assert_eq!(*self, right);
        assert!(self.contacts >= least_contacts, "{} contacts", self.contacts);
    }
}
