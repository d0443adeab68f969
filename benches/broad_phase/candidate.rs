//! This crate's broad phase and Parry's tree, each taking the same frames to the same pairs.

use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::partitioning::{Bvh, BvhWorkspace};
use sbbk_core::broad_phase::{Bounds, BroadPhase};

use super::MARGIN;

/// Two object indices, the lower one first.
pub type IndexPair = [u32; 2];

/// Takes the bounds of the same objects as before, moved, and returns all pairs, in any order.
pub type Candidate = Box<dyn FnMut(&[Bounds]) -> Vec<IndexPair>>;

/// This crate's.
pub fn sbbk() -> Candidate {
    let mut broad_phase = BroadPhase::new(MARGIN);
    Box::new(move |frame| broad_phase.pairs(frame).to_vec())
}

/// Parry's tree, used as Rapier's `BroadPhaseBvh` does: updated, refitted and optimised step by
/// step, and only pairs with a member that moved are sought.
pub fn parry() -> Candidate {
    let (mut bvh, mut workspace) = (Bvh::new(), BvhWorkspace::default());
    let (mut last, mut pairs) = (Vec::<Bounds>::new(), Vec::<IndexPair>::new());
    Box::new(move |frame| {
        let has_moved = |index: u32| last.get(index as usize) != Some(&frame[index as usize]);
        for (index, bounds) in (0..).zip(frame).filter(|&(index, _)| has_moved(index)) {
            let aabb = Aabb::new(bounds.min, bounds.max + MARGIN);
            bvh.insert_or_update_partially(aabb, index, 0.0);
        }
        bvh.refit(&mut workspace);
        bvh.optimize_incremental(&mut workspace);
        pairs.retain(|pair| !pair.iter().any(|&index| has_moved(index)));
        bvh.traverse_bvtt_single_tree::<true>(&mut workspace, &mut |index1, index2| {
            if frame[index1 as usize].is_pair_with(&frame[index2 as usize], MARGIN) {
                pairs.push([index1.min(index2), index1.max(index2)]);
            }
        });
        last.clear();
        last.extend_from_slice(frame);
        pairs.clone()
    })
}
