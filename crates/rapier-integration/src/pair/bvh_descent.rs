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
const GROUP: usize = 64;

/// Least length of a group that descends as one. Higher: more descents; lower: descents that decide
/// nothing.
const LEAST_GROUP: usize = 16;

/// A test for triangles beside each other.
#[derive(Copy, Clone)]
pub(crate) struct Culling<'a> {
    pub(crate) lateral: LateralCulling,
    /// Returns true if pairs beside a triangle of mesh 1 (0) or 2 (1) may be left out.
    pub(crate) may_reject: &'a (dyn Fn(usize, u32) -> bool + Sync),
}

/// A descent of the BVHs of two meshes.
pub(crate) struct BvhDescent<'a> {
    /// The larger mesh, and the other one.
    meshes: [&'a MeshView<'a>; 2],
    /// True if the larger mesh is mesh 2.
    is_swapped: bool,
    /// The other mesh in the frame of the larger one.
    placement12: Placement,
    margin: f32,
    culling: Option<Culling<'a>>,
}

impl<'a> BvhDescent<'a> {
    /// A descent to all pairs of triangles within `margin` except those that `culling` excludes.
    pub(crate) fn new(
        meshes: [&'a MeshView<'a>; 2],
        placement12: Placement,
        margin: f32,
        culling: Option<Culling<'a>>,
    ) -> Self {
        let [mesh1, mesh2] = meshes;
        if mesh1.size_squared() < mesh2.size_squared() {
            let (meshes, placement12) = ([mesh2, mesh1], placement12.inverted());
            Self { meshes, is_swapped: true, placement12, margin, culling }
        } else {
            Self { meshes, is_swapped: false, placement12, margin, culling }
        }
    }

    /// Replaces `near` by the triangles of the larger mesh that are near the box of the other one.
    pub(crate) fn list_near(&self, near: &mut Vec<u32>, mut counters: impl Counters) {
        let [mesh1, mesh2] = self.meshes;
        let magnitudes = self.meshes.map(MeshView::magnitude);
        let in_frame1 = BoxTest::new(magnitudes, &self.placement12, self.margin);
        let whole = in_frame1.of(TestedBox::new(mesh2.root().mins, mesh2.root().maxs));
        near.clear();
        let tested = Cell::new(0);
        let meets = |node: TestedBox| {
            tested.set(tested.get() + 1);
            whole.meets(node)
        };
        near.extend(mesh1.near(meets));
        counters.aabb_tests(tested.get());
    }

    /// Calls `found` with the pairs of triangles in `near`, in any order, until it breaks.
    pub(crate) fn pairs(
        &self,
        near: &[u32],
        mut counters: impl Counters,
        mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if near.is_empty() {
            return ControlFlow::Continue(());
        }
        let Self { meshes: [mesh1, mesh2], placement12, margin, .. } = *self;
        let [m1, m2] = [mesh1, mesh2].map(MeshView::magnitude);
        // The margin is a distance in frame 1; quaternions far from unit length scale it.
        let scale = placement12.rotation.x_axis.length();
        let margin2 = ((f64::from(margin) / scale) as f32).next_up();
        let in_frame2 = BoxTest::new([m2, m1], &placement12.inverted(), margin2);
        let frame: PairFrame = PairFrame::within([m1, m2], placement12, margin);
        let test = LeafTest::new(&frame);
        let tested = Cell::new(0);
        let meets = |near: &NearBox<'_>, node: TestedBox| {
            tested.set(tested.get() + 1);
            near.meets(node)
        };
        let is_near = |many: &&[u32]| {
            let group = in_frame2.of(mesh1.tested(many));
            many.len() < LEAST_GROUP || mesh2.near(|node| meets(&group, node)).next().is_some()
        };
        let mut fours = near.chunks(GROUP).filter(is_near).flat_map(|many| many.chunks(BATCH));
        let flow = fours.try_for_each(|triangles| {
            let group = in_frame2.of(mesh1.tested(triangles));
            self.pairs_of_four(triangles, &test, |node| meets(&group, node), &mut found)
        });
        counters.aabb_tests(tested.get());
        flow
    }

    /// Calls `found` with the pairs of up to four triangles of the larger mesh.
    fn pairs_of_four(
        &self,
        triangles: &[u32],
        test: &LeafTest,
        meets: impl Fn(TestedBox) -> bool,
        found: &mut impl FnMut([u32; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Self { meshes: [mesh1, mesh2], culling, is_swapped, .. } = *self;
        let lateral = culling.as_ref().map(|culling| &culling.lateral);
        let batch1 = LeafBatch::gather(triangles, |triangle| mesh1.corners(triangle));
        let mut decide = |near2: &[u32]| {
            let batch2 = LeafBatch::gather(near2, |triangle| mesh2.corners(triangle));
            let mut flow = ControlFlow::Continue(());
            let lists = [triangles, near2];
            let may_reject = |i: usize, lane: usize| {
                let may_reject =
                    |of: Culling<'_>| (of.may_reject)(i ^ usize::from(is_swapped), lists[i][lane]);
                culling.is_some_and(may_reject)
            };
            test.survivors_in_front(lateral, &batch1, &batch2, may_reject, |lane1, lane2| {
                if flow.is_continue() {
                    let [one, two] = [triangles[lane1], near2[lane2]];
                    flow = found(if is_swapped { [two, one] } else { [one, two] });
                }
            });
            flow
        };
        let mut waiting = ArrayVec::<u32, BATCH>::new();
        for triangle2 in mesh2.near(meets) {
            waiting.push(triangle2);
            if waiting.is_full() {
                decide(&waiting)?;
                waiting.clear();
            }
        }
        if waiting.is_empty() { ControlFlow::Continue(()) } else { decide(&waiting) }
    }
}
