//! Pairs of triangles of two meshes from Parry's own hierarchies, where one of the meshes has no
//! tree.

use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{BoxTest, Counters, PairFrame, Placement};
use sbbk_core::tree::{BATCH, LeafBatch};

use crate::mesh::Hierarchy;

/// Calls `found` with all pairs of triangles within `margin`, and few others, in any order, until it
/// has enough.
pub(crate) fn walk(
    meshes: [&Hierarchy<'_>; 2],
    placement12: Placement,
    margin: f32,
    counters: impl Counters,
    mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
) {
    let magnitudes = meshes.map(Hierarchy::magnitude);
    let frame: PairFrame = PairFrame::within(magnitudes, placement12, margin);
    let test = LeafTest::new(&frame);
    let mut decide = |pairs: &[[u32; 2]]| {
        let batch = |side: usize| {
            let mut triangles = [0; BATCH];
            triangles.iter_mut().zip(pairs).for_each(|(number, pair)| *number = pair[side]);
            let corners = |triangle| meshes[side].corners(triangle);
            LeafBatch::gather(&triangles[..pairs.len()], corners)
        };
        let near = test.lanes(&batch(0), &batch(1));
        let mut near = pairs.iter().zip(0..).filter(|(_, lane)| near >> lane & 1 == 1);
        near.try_for_each(|(pair, _)| found(*pair))
    };
    // Pairs wait until there are as many as the test takes at once.
    let mut waiting = ArrayVec::<_, BATCH>::new();
    let mut outcome = ControlFlow::Continue(());
    Hierarchy::pairs(meshes, &BoxTest::new(&frame), counters, |pair| {
        waiting.push(pair);
        if waiting.is_full() {
            outcome = decide(&waiting);
            waiting.clear();
        }
        outcome
    });
    if outcome.is_continue() && !waiting.is_empty() {
        let _ = decide(&waiting);
    }
}
