//! Descents to the candidates of two shapes made of triangles.
//!
//! Two rigid meshes with trees descend both trees. Two others descend Parry's BVHs. A mesh and a
//! height field visit Parry's BVH of the mesh and read the cells under it ([`sbbk_core::field`]).
//!
//! A descent of BVHs first finds the triangles of the larger mesh near the box of the other. Many
//! descents end here. Groups of such triangles descend the other BVH until something is near. Then
//! each four of a group descend.
//!
//! Rapier hands out pairs in blocks of 64, so few heavy pairs would run on one thread. With the
//! feature `parallel`, a heavy pair is split into chunks for the threads of the host's pool.
//! Results are joined in the order of chunks, so they have the same bits on any number of threads.

use std::cell::Cell;
use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use parry3d::math::{Pose, Real};
use sbbk_core::field::{FieldFrame, FieldLeaves};
use sbbk_core::leaf::{LateralCulling, LeafTest};
use sbbk_core::surface::{Facets, Surface};
use sbbk_core::traverse::{
    BoxTest, DescentCounts, DescentScratch, NearBox, NodePair, PairFrame, Placement, TestedBox,
    begin_descent, descend_from,
};
use sbbk_core::tree::{BATCH, LeafBatch, Tree};

use super::field::Field;
use super::pose::PairPose;
use super::query::Candidate;
use super::shapes::{Hint, ShapeView, TriangleShape, TriangleShapes};
use super::tuning::{DISTANT, LEAST_REACH, MUCH_LESS, NEAR_NORMAL, REACH, REACH_PER_TRIANGLE};
use crate::mesh::MeshView;

/// Greatest product of the numbers of triangles near the other shape with which all pairs are
/// candidates. Higher: small bodies cost more time and memory. Lower: thin plates with soft CCD
/// turn through sheets.
const MOST_PAIRS: usize = 1 << 14;

/// Pairs of nodes or a few more at which the chunks of a descent start. Higher: fewer descents are
/// split; lower: one chunk may have all that is near.
const STARTS: usize = 1024;

/// Least number of node pairs in a chunk. Higher: one chunk may have all that is near; lower:
/// chunks of microseconds.
const LEAST_STARTS: usize = 32;

/// Least number of triangles of the larger mesh in a chunk of a BVH descent. Higher, lower: see
/// [`LEAST_STARTS`].
const LEAST_NEAR: usize = 64;

/// Memory for descents.
#[derive(Default)]
pub(super) struct DescentMemory {
    /// Triangles at which a descent starts.
    near: Vec<u32>,
    /// Nodes at which a descent starts.
    start: Vec<NodePair>,
    descent: DescentChunk,
}

/// Result of a chunk of a descent, and memory for it.
#[derive(Default)]
struct DescentChunk {
    found: Vec<Candidate<Hint>>,
    counts: DescentCounts,
    stack: DescentScratch,
}

impl ChunkResult for DescentChunk {
    fn append(&mut self, next: Self) {
        self.found.extend(next.found);
        self.counts += next.counts;
    }
}

impl TriangleShapes<'_> {
    /// Returns the distance up to which all pairs of triangles are candidates. Farther contacts are
    /// [far](super::far).
    pub(super) fn reach(&self) -> Real {
        *self.reach.get_or_init(|| {
            let most = self.reach_of_fine() as Real;
            // A prediction distance that is NaN finds nothing.
            let is_less = most < self.pose.prediction && !self.are_few();
            if is_less { most } else { self.pose.prediction }
        })
    }

    /// Returns the greatest reach of fine meshes.
    fn reach_of_fine(&self) -> f64 {
        let [least, most] = [LEAST_REACH, REACH].map(|share| share * self.filter_distance);
        let [size1, size2] = self.shapes.each_ref().map(TriangleShape::triangle_size);
        let of_triangles = (REACH_PER_TRIANGLE * f64::from(size1.max(size2))).max(least);
        let otherwise = most.min(f64::from(self.pose.prediction));
        if of_triangles <= MUCH_LESS * otherwise { of_triangles } else { most }
    }

    /// Returns true if few pairs of triangles may be within the prediction distance.
    fn are_few(&self) -> bool {
        let PairPose { pos12, prediction, .. } = *self.pose;
        let poses = [pos12, pos12.inverse()];
        if let [ShapeView::Mesh(one), ShapeView::Mesh(two)] = [0, 1].map(|i| self[i].view) {
            return are_few_of_meshes([one, two], poses, prediction);
        }
        let views = [self.larger, 1 - self.larger].map(|i| self[i].view);
        let [ShapeView::Field(field), ShapeView::Mesh(mesh)] = views else { return true };
        let root = mesh.placed_root(&poses[self.larger], prediction);
        mesh.mesh.indices().len() as f64 * field.count_under(&root) <= MOST_PAIRS as f64
    }

    /// Returns a test for triangles beside each other. Their contacts are no local minima while
    /// candidates within `margin` serve, where the surface [bends little](Self::bends_little).
    pub(super) fn lateral_culling(&self, margin: Real) -> Option<LateralCulling> {
        let reach = self.reach();
        let is_filtered = f64::from(reach) <= self.filter_distance;
        (self.has_surface() && is_filtered).then(|| {
            let (distance, travel) = ((DISTANT * self.filter_unit()) as Real, margin - reach);
            LateralCulling::new(distance, NEAR_NORMAL as Real, reach, travel)
        })
    }

    /// Returns true if contacts beside a triangle of shape `i`, by [lateral
    /// culling](Self::lateral_culling), are no local minima. False for height fields.
    pub(super) fn bends_little(&self, i: usize, triangle: u32) -> bool {
        let Some(surface) = &self[i].surface else { return false };
        surface.facets().cones(triangle).least_square(false) >= NEAR_NORMAL * NEAR_NORMAL
    }

    /// Adds all pairs of triangles within `margin`, and few others.
    pub(super) fn descend(
        &self,
        margin: Real,
        counts: &mut DescentCounts,
        DescentMemory { near, start, descent }: &mut DescentMemory,
        found: &mut Vec<Candidate<Hint>>,
    ) {
        std::mem::swap(found, &mut descent.found);
        match ([0, 1].map(|i| self[i].view), self[0].tree.zip(self[1].tree)) {
            (_, Some(trees)) => self.descend_trees(trees, margin, start, descent),
            ([ShapeView::Mesh(one), ShapeView::Mesh(two)], None) => {
                self.descend_bvhs([one, two], margin, near, descent);
            }
            ([ShapeView::Field(field), ShapeView::Mesh(mesh)], None)
            | ([ShapeView::Mesh(mesh), ShapeView::Field(field)], None) => {
                self.descend_field(*field, mesh, margin, near, descent);
            }
            ([ShapeView::Field(_), ShapeView::Field(_)], None) => {}
        }
        *counts += std::mem::take(&mut descent.counts);
        std::mem::swap(found, &mut descent.found);
    }

    fn descend_trees(
        &self,
        trees: (&Tree, &Tree),
        margin: Real,
        start: &mut Vec<NodePair>,
        descent: &mut DescentChunk,
    ) {
        let mut frame = PairFrame::new(trees, self.pose.placement12, margin);
        let culling = self.lateral_culling(margin);
        let test = LeafTest::new(&frame);
        let doubles = self.doubles();
        let count = if has_threads() { STARTS } else { 1 };
        begin_descent(trees, &mut frame, count, start);
        descent.counts += std::mem::take(&mut frame.counts);
        let least = if start.len() < STARTS { STARTS } else { LEAST_STARTS };
        in_chunks(start, least, descent, &|start: &mut [_], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, stack } = chunk;
            let frame = &mut frame.clone();
            descend_from(start, trees, frame, stack, |batch1, batch2| {
                let triangles = [batch1.triangles(), batch2.triangles()];
                let bends_little = |i: usize, lane: usize| self.bends_little(i, triangles[i][lane]);
                let found = |lane1: usize, lane2: usize| {
                    let pair = [triangles[0][lane1], triangles[1][lane2]];
                    if !has_double(&doubles, pair) {
                        found.push(Candidate::new(pair));
                    }
                };
                let lateral = culling.as_ref();
                test.survivors_in_front(lateral, batch1, batch2, bends_little, found);
            });
            *counts += frame.counts;
        });
    }

    fn descend_bvhs(
        &self,
        meshes: [&MeshView<'_>; 2],
        margin: Real,
        near: &mut Vec<u32>,
        descent: &mut DescentChunk,
    ) {
        let bends_little = |i: usize, triangle: u32| self.bends_little(i, triangle);
        let lateral = self.lateral_culling(margin);
        let search = BvhDescent::new(meshes, self.pose.placement12, margin, lateral);
        search.list_near(near, &mut descent.counts);
        let doubles = self.doubles();
        let larger = doubles[self.larger];
        near.retain(|&triangle| !larger.is_some_and(|surface| surface.is_double(triangle)));
        in_chunks(near, LEAST_NEAR, descent, &|near: &mut [u32], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, .. } = chunk;
            let _ = search.pairs(near, counts, bends_little, |pair| {
                if !has_double(&doubles, pair) {
                    found.push(Candidate::new(pair));
                }
                ControlFlow::Continue(())
            });
        });
        meshes[0].store.counters.walks.raise();
        meshes[0].store.earn_tree();
    }

    fn descend_field(
        &self,
        field: Field<'_>,
        mesh: &MeshView<'_>,
        margin: Real,
        near: &mut Vec<u32>,
        DescentChunk { found, counts, .. }: &mut DescentChunk,
    ) {
        let moving = self.moving();
        let frame = FieldFrame::new(&field, moving.placement(self.pose), margin);
        let leaves = FieldLeaves::new(&frame, moving.body.ball.centre, mesh.magnitude());
        near.clear();
        near.extend(mesh.near(|node| frame.meets(node)));
        for triangles in near.chunks(BATCH) {
            let batch = LeafBatch::gather(triangles, |triangle| mesh.corners(triangle));
            leaves.visit(&batch, |triangle, of_mesh| {
                let of_field = field.id(triangle);
                let pair = if self.larger == 0 { [of_field, of_mesh] } else { [of_mesh, of_field] };
                found.push(Candidate::new(pair));
            });
        }
        counts.cells += frame.cells.get();
    }

    /// Returns the surfaces that are known by now and have doubles. A descent may leave these out,
    /// as they have no contacts.
    fn doubles(&self) -> [Option<&Surface>; 2] {
        self.shapes.each_ref().map(|shape| shape.surface.as_ref()?.with_doubles())
    }
}

/// Returns true if few pairs of triangles of two meshes may be within the prediction distance.
/// `poses` has each mesh's partner in the frame of the mesh.
fn are_few_of_meshes(meshes: [&MeshView<'_>; 2], poses: [Pose; 2], prediction: Real) -> bool {
    let count = |i: usize, most: usize| {
        let around = meshes[1 - i].placed_root(&poses[i], prediction);
        meshes[i].mesh.bvh().intersect_aabb(&around).take(most + 1).count()
    };
    let least = MOST_PAIRS.isqrt();
    match [0, 1].map(|i| count(i, least)) {
        [one, _] if one <= least => one * count(1, MOST_PAIRS / one.max(1)) <= MOST_PAIRS,
        [_, two] if two <= least => two * count(0, MOST_PAIRS / two.max(1)) <= MOST_PAIRS,
        _ => false,
    }
}

/// Returns true if one of two triangles is a double.
#[inline]
fn has_double(of: &[Option<&Surface>; 2], pair: [u32; 2]) -> bool {
    (0..2).any(|i| of[i].is_some_and(|surface| surface.is_double(pair[i])))
}

/// Length of a group of triangles that follow each other in a BVH. Higher: groups are wide and
/// something is near more often; lower: more descents.
const GROUP: usize = 64;

/// Least length of a group that descends as one. Higher: more descents; lower: descents that decide
/// nothing.
const LEAST_GROUP: usize = 16;

/// A descent of the BVHs of two meshes.
pub(crate) struct BvhDescent<'a> {
    /// The larger mesh, and the other one.
    meshes: [&'a MeshView<'a>; 2],
    /// True if the larger mesh is mesh 2.
    is_swapped: bool,
    /// The other mesh in the frame of the larger one.
    placement12: Placement,
    margin: f32,
    lateral: Option<LateralCulling>,
}

impl<'a> BvhDescent<'a> {
    /// A descent to all pairs of triangles within `margin`, without some beside each other if
    /// `lateral` is set.
    pub(crate) fn new(
        meshes: [&'a MeshView<'a>; 2],
        placement12: Placement,
        margin: f32,
        lateral: Option<LateralCulling>,
    ) -> Self {
        let [mesh1, mesh2] = meshes;
        if mesh1.size_squared() < mesh2.size_squared() {
            let (meshes, placement12) = ([mesh2, mesh1], placement12.inverted());
            Self { meshes, is_swapped: true, placement12, margin, lateral }
        } else {
            Self { meshes, is_swapped: false, placement12, margin, lateral }
        }
    }

    /// Replaces `near` by the triangles of the larger mesh that are near the box of the other one.
    pub(crate) fn list_near(&self, near: &mut Vec<u32>, counts: &mut DescentCounts) {
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
        counts.aabb_tests += tested.get();
    }

    /// Calls `found` with the pairs of triangles in `near`, in any order, until it breaks.
    /// `may_reject` returns true if pairs beside a triangle of mesh 1 (0) or 2 (1) may be left out.
    pub(crate) fn pairs(
        &self,
        near: &[u32],
        counts: &mut DescentCounts,
        may_reject: impl Fn(usize, u32) -> bool,
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
        let may_reject = |i: usize, of: u32| may_reject(i ^ usize::from(self.is_swapped), of);
        let flow = fours.try_for_each(|triangles| {
            let group = in_frame2.of(mesh1.tested(triangles));
            let meets = |node| meets(&group, node);
            self.pairs_of_four(triangles, &test, meets, &may_reject, &mut found)
        });
        counts.aabb_tests += tested.get();
        flow
    }

    /// Calls `found` with the pairs of up to four triangles of the larger mesh.
    fn pairs_of_four(
        &self,
        triangles: &[u32],
        test: &LeafTest,
        meets: impl Fn(TestedBox) -> bool,
        may_reject: &impl Fn(usize, u32) -> bool,
        found: &mut impl FnMut([u32; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Self { meshes: [mesh1, mesh2], is_swapped, .. } = *self;
        let lateral = self.lateral.as_ref();
        let batch1 = LeafBatch::gather(triangles, |triangle| mesh1.corners(triangle));
        let mut decide = |near2: &[u32]| {
            let batch2 = LeafBatch::gather(near2, |triangle| mesh2.corners(triangle));
            let mut flow = ControlFlow::Continue(());
            let lists = [triangles, near2];
            let may_reject = |i: usize, lane: usize| may_reject(i, lists[i][lane]);
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

/// The result of a chunk.
pub(super) trait ChunkResult: Default + Send {
    /// Adds the result of the next chunk.
    fn append(&mut self, next: Self);
}

/// Returns true if work may run on other threads.
pub(super) fn has_threads() -> bool {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads() > 1;
    #[cfg(not(feature = "parallel"))]
    false
}

/// Calls both, maybe on two threads.
fn join(first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
    #[cfg(feature = "parallel")]
    rayon::join(first, second);
    #[cfg(not(feature = "parallel"))]
    {
        first();
        second();
    }
}

/// Calls `work` with all items: at once, or in chunks of at least `least` items on several threads.
pub(super) fn in_chunks<T: Send, R: ChunkResult>(
    items: &mut [T],
    least: usize,
    result: &mut R,
    work: &(impl Fn(&mut [T], &mut R) + Sync),
) {
    if items.len() < 2 * least || !has_threads() {
        return work(items, result);
    }
    let (first, second) = items.split_at_mut(items.len() / 2);
    let mut next = R::default();
    join(|| in_chunks(first, least, result, work), || in_chunks(second, least, &mut next, work));
    result.append(next);
}
