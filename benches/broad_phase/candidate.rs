//! This crate's broad phase and Parry's tree, each taking the same frames to the same pairs.

use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::partitioning::{Bvh, BvhWorkspace};
use sbbk_core::broad_phase::{Bounds, BroadPhase};

/// Two object indices, the lower one first.
pub type IndexPair = [u32; 2];

/// A structure that finds all pairs of a frame.
pub trait Candidate {
    /// Takes the bounds of the same objects as before, moved, and returns all pairs, in any order.
    fn step(&mut self, frame: &[Bounds]) -> Vec<IndexPair>;
}

/// This crate's.
pub struct Sbbk(BroadPhase);

impl Sbbk {
    pub fn new(margin: f32) -> Self {
        Self(BroadPhase::new(margin))
    }
}

impl Candidate for Sbbk {
    fn step(&mut self, frame: &[Bounds]) -> Vec<IndexPair> {
        self.0.pairs(frame).to_vec()
    }
}

/// Parry's tree, used as Rapier's `BroadPhaseBvh` does: updated, refitted and optimised step by
/// step, and only pairs with a member that moved are sought.
pub struct Parry {
    margin: f32,
    bvh: Bvh,
    workspace: BvhWorkspace,
    last: Vec<Bounds>,
    pairs: Vec<IndexPair>,
}

impl Parry {
    pub fn new(margin: f32) -> Self {
        let (bvh, workspace) = (Bvh::new(), BvhWorkspace::default());
        Self { margin, bvh, workspace, last: Vec::new(), pairs: Vec::new() }
    }
}

impl Candidate for Parry {
    fn step(&mut self, frame: &[Bounds]) -> Vec<IndexPair> {
        let Self { margin, bvh, workspace, last, pairs } = self;
        let has_moved = |index: u32| last.get(index as usize) != Some(&frame[index as usize]);
        for (index, bounds) in (0..).zip(frame).filter(|&(index, _)| has_moved(index)) {
            let aabb = Aabb::new(bounds.min, bounds.max + *margin);
            bvh.insert_or_update_partially(aabb, index, 0.0);
        }
        bvh.refit(workspace);
        bvh.optimize_incremental(workspace);
        pairs.retain(|pair| !pair.iter().any(|&index| has_moved(index)));
        bvh.traverse_bvtt_single_tree::<true>(workspace, &mut |index1, index2| {
            if frame[index1 as usize].is_pair_with(&frame[index2 as usize], *margin) {
                pairs.push([index1.min(index2), index1.max(index2)]);
            }
        });
        last.clear();
        last.extend_from_slice(frame);
        pairs.clone()
    }
}
