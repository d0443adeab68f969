//! Pairs of triangles of two meshes from Parry's own hierarchies, where one of the meshes has no
//! tree.
//!
//! The triangles of the larger mesh that are near the other as a whole come first: often there are
//! none. Each four of them then go down the other hierarchy together.
//!
//! Tried: Parry's simultaneous walk (`Bvh::leaf_pairs`). For two heads it takes as long; a head above
//! a terrain of 320,000 triangles took 28 µs where this takes 1.

use std::cell::Cell;
use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{BoxTest, Counters, PairFrame, Placement, TestedBox};
use sbbk_core::tree::{BATCH, LeafBatch};

use crate::mesh::Hierarchy;

/// Calls `found` with all pairs of triangles within `margin`, and few others, in any order, until it
/// has enough. `near` is memory.
pub(crate) fn walk(
    [mesh1, mesh2]: [&Hierarchy<'_>; 2],
    placement12: Placement,
    margin: f32,
    mut counters: impl Counters,
    near: &mut Vec<u32>,
    mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
) {
    let is_swapped = is_smaller(mesh1, mesh2);
    let found = |[one, two]: [u32; 2]| found(if is_swapped { [two, one] } else { [one, two] });
    let whole = Whole::new(larger_first([mesh1, mesh2], placement12), margin);
    let tested = Cell::new(0);
    let count = || tested.set(tested.get() + 1);
    whole.near(near, &count);
    if !near.is_empty() {
        whole.pairs(near, &count, found);
    }
    counters.aabb_tests(tested.get());
}

fn is_smaller(mesh1: &Hierarchy<'_>, mesh2: &Hierarchy<'_>) -> bool {
    let size = |mesh: &Hierarchy<'_>| mesh.root().half_extents().length_squared();
    size(mesh1) < size(mesh2)
}

fn larger_first<'a>(
    [mesh1, mesh2]: [&'a Hierarchy<'a>; 2],
    placement12: Placement,
) -> ([&'a Hierarchy<'a>; 2], Placement) {
    if is_smaller(mesh1, mesh2) {
        ([mesh2, mesh1], placement12.inverted())
    } else {
        ([mesh1, mesh2], placement12)
    }
}

/// Two meshes, the larger one first, and the box around the other.
struct Whole<'a> {
    meshes: [&'a Hierarchy<'a>; 2],
    placement12: Placement,
    margin: f32,
    frame: PairFrame,
    test: BoxTest,
    whole: TestedBox,
}

impl<'a> Whole<'a> {
    fn new((meshes, placement12): ([&'a Hierarchy<'a>; 2], Placement), margin: f32) -> Self {
        let frame = PairFrame::within(meshes.map(Hierarchy::magnitude), placement12, margin);
        let root = meshes[1].root();
        let (test, whole) = (BoxTest::new(&frame), TestedBox::new(root.mins, root.maxs));
        Self { meshes, placement12, margin, frame, test, whole }
    }

    /// The triangles of mesh 1 near the box of mesh 2.
    fn near(&self, near: &mut Vec<u32>, count: &impl Fn()) {
        let whole = self.test.of(self.whole);
        near.clear();
        near.extend(self.meshes[0].near(&|node: TestedBox| {
            count();
            whole.meets(node)
        }));
    }

    /// Calls `found` with their pairs.
    fn pairs(
        &self,
        near: &[u32],
        count: &impl Fn(),
        mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
    ) {
        let [mesh1, mesh2] = self.meshes;
        let [m1, m2] = self.meshes.map(Hierarchy::magnitude);
        // The margin is a distance in frame 1.
        let scale = self.placement12.rotation.x_axis.length();
        let margin2 = ((f64::from(self.margin) / scale) as f32).next_up();
        let back: PairFrame = PairFrame::within([m2, m1], self.placement12.inverted(), margin2);
        let (in_frame2, test) = (BoxTest::new(&back), LeafTest::new(&self.frame));
        let _ = near.chunks(BATCH).try_for_each(|triangles| {
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
            let meets = |node: TestedBox| {
                count();
                group.meets(node)
            };
            let mut waiting = ArrayVec::<u32, BATCH>::new();
            for triangle2 in mesh2.near(&meets) {
                waiting.push(triangle2);
                if waiting.is_full() {
                    decide(&waiting)?;
                    waiting.clear();
                }
            }
            if waiting.is_empty() { ControlFlow::Continue(()) } else { decide(&waiting) }
        });
    }
}
