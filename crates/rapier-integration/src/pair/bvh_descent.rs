//! Pairs of triangles of two meshes from Parry's BVHs, if one of the meshes has no tree.
//!
//! The descent first finds the triangles of the larger mesh near the box of the other: often there
//! are none. Groups of these descend the other BVH until something is near, then each four of a
//! group do.

use std::cell::Cell;
use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use sbbk_core::leaf::{LateralCulling, LeafTest};
use sbbk_core::traverse::{BoxTest, Counters, NearBox, PairFrame, Placement, TestedBox};
use sbbk_core::tree::{BATCH, LeafBatch};

use crate::mesh::MeshView;

/// Length of a group of triangles that follow each other in a BVH. Higher: groups are wide and
/// something is near more often; lower: more descents.
const MANY: usize = 64;

/// Least length of a group that descends as one. Higher: more descents; lower: descents that decide
/// nothing.
const FEW: usize = 16;

/// Calls `found` with all pairs of triangles within `margin` except those that `culling` excludes,
/// and few others, in any order, until it breaks. `near` is memory.
pub(crate) fn walk(
    [mesh1, mesh2]: [&MeshView<'_>; 2],
    placement12: Placement,
    margin: f32,
    culling: Option<LateralCulling>,
    mut counters: impl Counters,
    near: &mut Vec<u32>,
    mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
) {
    let tested = Cell::new(0);
    if mesh1.size_squared() < mesh2.size_squared() {
        let found = |[two, one]: [u32; 2]| found([one, two]);
        walk_larger([mesh2, mesh1], placement12.inverted(), margin, culling, &tested, near, found);
    } else {
        walk_larger([mesh1, mesh2], placement12, margin, culling, &tested, near, found);
    }
    counters.aabb_tests(tested.get());
}

/// Descends with mesh 1 as the larger one. Counts tests in `tested`.
fn walk_larger(
    [mesh1, mesh2]: [&MeshView<'_>; 2],
    placement12: Placement,
    margin: f32,
    culling: Option<LateralCulling>,
    tested: &Cell<u32>,
    near1: &mut Vec<u32>,
    mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
) {
    let [m1, m2] = [mesh1, mesh2].map(MeshView::magnitude);
    let in_frame1 = BoxTest::new([m1, m2], &placement12, margin);
    let whole = in_frame1.of(TestedBox::new(mesh2.root().mins, mesh2.root().maxs));
    near1.clear();
    let meets = |near: &NearBox<'_>, node| {
        tested.set(tested.get() + 1);
        near.meets(node)
    };
    let _ = mesh1.near(
        |node| meets(&whole, node),
        |triangle| {
            near1.push(triangle);
            ControlFlow::Continue(())
        },
    );
    if near1.is_empty() {
        return;
    }
    // The margin is a distance in frame 1; quaternions far from unit length scale it.
    let scale = placement12.rotation.x_axis.length();
    let margin2 = ((f64::from(margin) / scale) as f32).next_up();
    let in_frame2 = BoxTest::new([m2, m1], &placement12.inverted(), margin2);
    let frame: PairFrame = PairFrame::within([m1, m2], placement12, margin);
    let test = LeafTest::new(&frame).with_culling(culling);
    let is_near = |many: &&[u32]| {
        let group = in_frame2.of(mesh1.tested(many));
        let is_first_enough = |_| ControlFlow::Break(());
        many.len() < FEW || mesh2.near(|node| meets(&group, node), is_first_enough).is_break()
    };
    let mut fours = near1.chunks(MANY).filter(is_near).flat_map(|many| many.chunks(BATCH));
    let _ = fours.try_for_each(|triangles| {
        let batch1 = LeafBatch::gather(triangles, |triangle| mesh1.corners(triangle));
        let group = in_frame2.of(mesh1.tested(triangles));
        let mut decide = |near2: &[u32]| {
            let batch2 = LeafBatch::gather(near2, |triangle| mesh2.corners(triangle));
            let mut flow = ControlFlow::Continue(());
            test.survivors(&batch1, &batch2, |lane1, lane2| {
                if flow.is_continue() {
                    flow = found([triangles[lane1], near2[lane2]]);
                }
            });
            flow
        };
        let mut waiting = ArrayVec::<u32, BATCH>::new();
        mesh2.near(
            |node| meets(&group, node),
            |triangle2| {
                waiting.push(triangle2);
                if !waiting.is_full() {
                    return ControlFlow::Continue(());
                }
                decide(&waiting)?;
                waiting.clear();
                ControlFlow::Continue(())
            },
        )?;
        if waiting.is_empty() { ControlFlow::Continue(()) } else { decide(&waiting) }
    });
}
