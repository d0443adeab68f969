//! Queries against brute force in f64 over all pairs of triangles.

mod cast;
mod contacts;
mod motion;
mod nearest;

use crate::prelude::*;
use glamx::DPose3;
use sbbk_core::surface::RayTriangles;
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
pub fn pairs_within(meshes: [&Soup; 2], pose: DPose3, distance: f64) -> Vec<TruthPair> {
    let corners = meshes.map(|soup| (0..soup.count()).map(|triangle| soup.corners(triangle)));
    truth::pairs_within(corners, pose, distance)
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

fn distance_of(pairs: &[TruthPair], triangles: [u32; 2]) -> f64 {
    pairs.iter().find(|pair| pair.triangles == triangles).expect("triangles exist").distance
}
