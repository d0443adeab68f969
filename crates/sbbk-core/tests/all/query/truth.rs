//! Brute force.

use glamx::{DPose3, DQuat, DVec3, Pose3, Vec3};
use sbbk_core::truth::contact;

use crate::support::Soup;

/// A pair of triangles and its signed distance.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub triangles: [u32; 2],
    pub distance: f64,
}

/// All pairs of triangles, mesh 2 at `pose` and moved by `shift` (both exact in f64).
pub fn all_pairs(meshes: [&Soup; 2], pose: &Pose3, shift: DVec3) -> Vec<Pair> {
    let corners = |soup: &Soup, i: usize| soup.triangles[i].map(|v| soup.vertices[v as usize]);
    let pose = exact(pose);
    let mut pairs = Vec::new();
    for i in 0..meshes[0].triangles.len() {
        let t1 = corners(meshes[0], i).map(Vec3::as_dvec3);
        for j in 0..meshes[1].triangles.len() {
            let t2 = corners(meshes[1], j).map(|v| pose * v.as_dvec3() + shift);
            let distance = contact(&t1, &t2).distance;
            pairs.push(Pair { triangles: [i as u32, j as u32], distance });
        }
    }
    pairs
}

/// The least signed distance.
pub fn least(pairs: &[Pair]) -> f64 {
    pairs.iter().map(|pair| pair.distance).fold(f64::INFINITY, f64::min)
}

/// The distance of one pair of triangles.
pub fn of(pairs: &[Pair], triangles: [u32; 2]) -> f64 {
    pairs.iter().find(|pair| pair.triangles == triangles).expect("triangles exist").distance
}

/// The largest distance between vertices: what errors are relative to.
pub fn size(meshes: [&Soup; 2]) -> f64 {
    let reach = |soup: &Soup| soup.vertices.iter().map(|v| v.length()).fold(0.0, f32::max);
    f64::from(meshes.map(reach).into_iter().sum::<f32>()).max(f64::MIN_POSITIVE)
}

fn exact(pose: &Pose3) -> DPose3 {
    let q: DQuat = pose.rotation.as_dquat();
    DPose3::from_parts(pose.translation.as_dvec3(), q.normalize())
}
