//! Queries against brute force in f64 over all pairs of triangles.

mod cast;
mod contacts;
mod motion;
mod nearest;

use crate::prelude::*;
use glamx::DPose3;
use sbbk_truth::{self as truth, TruthPair};

fn tree(soup: &Soup) -> Tree {
    soup.tree(None)
}

fn triangle(corners: [[f32; 3]; 3]) -> Soup {
    Soup::apart(corners.map(Vec3::from_array))
}

/// A pose in f64 with a unit rotation.
fn exact(pose: &Pose3) -> DPose3 {
    DPose3::from_parts(pose.translation.as_dvec3(), pose.rotation.as_dquat().normalize())
}

/// All pairs of triangles up to a distance, mesh 2 at `pose`.
pub fn pairs_within([one, two]: [&Soup; 2], pose: DPose3, distance: f64) -> Vec<TruthPair> {
    let wide = |soup: &Soup| soup.vertices.iter().map(|v| v.as_dvec3()).collect::<Vec<DVec3>>();
    truth::pairs_within(&wide(one), &one.triangles, &wide(two), &two.triangles, pose, distance)
}

/// All pairs of triangles, mesh 2 at `pose` and moved by `shift`.
fn all_pairs(meshes: [&Soup; 2], pose: &Pose3, shift: DVec3) -> Vec<TruthPair> {
    let mut pose = exact(pose);
    pose.translation += shift;
    pairs_within(meshes, pose, f64::INFINITY)
}

fn least(pairs: &[TruthPair]) -> f64 {
    pairs.iter().map(|pair| pair.distance).fold(f64::INFINITY, f64::min)
}

fn triangles_of(pair: &TruthPair) -> [u32; 2] {
    [pair.triangle1, pair.triangle2]
}

fn distance_of(pairs: &[TruthPair], triangles: [u32; 2]) -> f64 {
    pairs.iter().find(|pair| triangles_of(pair) == triangles).expect("triangles exist").distance
}
