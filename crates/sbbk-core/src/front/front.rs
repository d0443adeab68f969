//! The front itself.

use std::cmp::Reverse;

use wide::f32x4;

use super::cells::{Cell, Cells, PATIENCE, lanes};
use super::clock::{Clock, Reading};
use super::opening::{PairTest, TreePair};
use super::options::FrontOptions;
use super::policy::Policy;
use crate::traverse::{Counters, Descent, DescentScratch, PairFrame, Verdict, Visitor, descend};
use crate::tree::{LeafBatch, Tree};

/// An adaptive front is built anew when it has more than this many times the cells that it was
/// built with, and [`SPARE_CELLS`]: its bound. Lower: more fresh descents for pairs that close in.
/// Higher: more memory.
const GROWTH: usize = 2;
/// See [`GROWTH`].
const SPARE_CELLS: usize = 64;
/// Time at which an adaptive front is built anew, in radii of mesh 2: stamps are f32, and would
/// become coarse.
const LONGEST_TIME: f64 = 8.0;

/// Where the last descent of a pair of trees stopped: see [the module](super).
///
/// One front is for one pair of trees; after a tree was exchanged, [`clear`](Self::clear) it.
#[derive(Clone, Debug, Default)]
pub struct Front {
    options: FrontOptions,
    clock: Clock,
    policy: Policy,
    pub(super) cells: Cells,
    /// Number of cells when the front was built.
    built: usize,
    /// Cells to be tested.
    pub(super) due: Vec<u32>,
    pending: Vec<u32>,
    /// Node and leaf counts of both trees: other trees must not cause a panic.
    sizes: [usize; 4],
    stats: FrontStats,
}

/// What a front has done since it was made, and what it is.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct FrontStats {
    /// Queries.
    pub queries: u64,
    /// Queries answered by a fresh descent, without a front.
    pub fresh: u64,
    /// Queries that built the front from the roots.
    pub built: u64,
    /// Queries answered from the front.
    pub reused: u64,
    /// Cells, of up to four pairs of nodes each, that were tested again.
    pub tested: u64,
    /// Pairs that had parted and met again: the front was lowered.
    pub lowered: u64,
    /// Pairs above the front that parted: it was raised.
    pub raised: u64,
    /// Cells that the front has now.
    pub cells: usize,
    /// Bytes that it holds on the heap.
    pub memory: usize,
}

impl Front {
    /// A front of this kind.
    pub fn new(options: FrontOptions) -> Self {
        Self { options, ..Self::default() }
    }

    /// Forgets everything but the statistics. The next query starts at the roots.
    pub fn clear(&mut self) {
        self.cells.clear();
        self.clock.clear();
        self.policy = Policy::default();
    }

    /// What it has done so far.
    pub fn stats(&self) -> FrontStats {
        FrontStats { cells: self.cells.len(), memory: self.cells.memory(), ..self.stats }
    }

    /// Visits pairs of leaves, as [`descend`] does: every pair of leaves that has triangles within
    /// the margin, and few others. Which others, and the order, depend on the queries before.
    ///
    /// Of the visitor, only [`Visitor::leaves`] is called, as the pairs above are not visited; it
    /// may stop. A pose or margin that is not finite finds nothing, and the next query starts at
    /// the roots.
    pub fn visit<V: Visitor, C: Counters>(
        &mut self,
        trees: (&Tree, &Tree),
        frame: &mut PairFrame,
        scratch: &mut DescentScratch,
        mut counters: C,
        visitor: &mut V,
    ) {
        self.stats.queries += 1;
        self.check(trees);
        if !frame.placement().is_finite() || frame.margin().is_nan() {
            self.clear();
            return;
        }
        let ball = trees.1.bounding_ball();
        let reading = self.clock.advance(frame.placement(), &ball);
        if self.cells.is_empty() && self.is_adaptive() && !self.policy.builds(reading.step, trees.1)
        {
            self.stats.fresh += 1;
            descend(trees, frame, Descent::Simultaneous, scratch, counters, &mut Leaves(visitor));
            return;
        }
        counters.sphere_test();
        if !frame.spheres_meet(trees.0, trees.1) {
            self.cells.clear();
            return;
        }
        let margin = frame.margin();
        let limit = LONGEST_TIME * f64::from(ball.radius);
        let mut pair = TreePair::new(trees, frame, &mut counters);
        if !self.update(&mut pair, reading, margin, limit) {
            self.stats.fresh += 1;
            descend(trees, frame, Descent::Simultaneous, scratch, counters, &mut Leaves(visitor));
            return;
        }
        for pair in self.cells.leaf_pairs() {
            counters.leaf_pair();
            let (leaf1, leaf2) = pair.leaves;
            let (batch1, batch2) = (trees.0.leaf(leaf1), trees.1.leaf(leaf2));
            if visitor.leaves(leaf1, batch1, leaf2, batch2) == Verdict::Stop {
                return;
            }
        }
    }

    /// Clears the front if it cannot be one of these trees.
    fn check(&mut self, (tree1, tree2): (&Tree, &Tree)) {
        let sizes = [
            tree1.node_count(),
            tree2.node_count(),
            tree1.leaf_count() as usize,
            tree2.leaf_count() as usize,
        ];
        if sizes != self.sizes {
            self.clear();
            self.sizes = sizes;
        }
    }

    fn is_adaptive(&self) -> bool {
        self.options == FrontOptions::Adaptive
    }

    /// Brings the front up to date, or clears it and returns `false`: then a fresh descent is
    /// cheaper.
    fn update(
        &mut self,
        pair: &mut impl PairTest,
        reading: Reading,
        margin: f32,
        longest_time: f64,
    ) -> bool {
        let is_late = self.is_adaptive() && reading.time > longest_time;
        if self.cells.is_empty() || is_late {
            self.build(pair, margin);
            return true;
        }
        self.due.clear();
        match self.options {
            FrontOptions::Paper => self.cells.all(&mut self.due),
            FrontOptions::Adaptive => {
                self.cells.due(reading.time, margin, &mut self.due);
                if self.policy.gives_up(reading.step, self.due.len(), self.cells.len()) {
                    self.cells.clear();
                    return false;
                }
            }
        }
        self.stats.reused += 1;
        self.stats.tested += self.due.len() as u64;
        self.test_due(pair, reading.stamp, margin);
        if self.is_adaptive() && self.cells.len() > GROWTH * self.built + SPARE_CELLS {
            self.build(pair, margin);
        }
        true
    }

    pub(super) fn build(&mut self, pair: &mut impl PairTest, margin: f32) {
        self.stats.built += 1;
        self.cells.clear();
        self.clock.restart();
        let root = self.cells.add(pair.roots(), 0);
        self.test_from(pair, root, 0.0, margin);
        self.built = self.cells.len();
    }

    /// Tests the cells that are due, in the order of the paper, or the highest first: one that
    /// parts takes those below it with it.
    pub(super) fn test_due(&mut self, pair: &mut impl PairTest, stamp: f64, margin: f32) {
        let cells = &self.cells;
        match self.options {
            FrontOptions::Paper => self.due.sort_by_key(|&cell| Reverse(cells.get(cell).depth)),
            FrontOptions::Adaptive => self.due.sort_by_key(|&cell| cells.get(cell).depth),
        }
        for place in 0..self.due.len() {
            let cell = self.due[place];
            if self.cells.is_cell(cell) {
                self.test_from(pair, cell, stamp, margin);
            }
        }
    }

    /// Tests a cell, and the new cells below it.
    fn test_from(&mut self, pair: &mut impl PairTest, cell: u32, stamp: f64, margin: f32) {
        self.pending.push(cell);
        while let Some(cell) = self.pending.pop() {
            self.test(pair, cell, stamp, margin);
        }
    }

    /// Tests the lanes of a cell, and lowers and raises the front below it. New cells are pending
    /// then.
    #[inline(always)]
    fn test(&mut self, pair: &mut impl PairTest, index: u32, stamp: f64, margin: f32) {
        let cell = *self.cells.get(index);
        let Cell { opening, met: before, .. } = cell;
        let asked = match self.options {
            // The pairs above the front are never asked again.
            FrontOptions::Paper => opening.lanes & !(before & !opening.leaves),
            FrontOptions::Adaptive => opening.lanes,
        };
        if asked == 0 {
            return;
        }
        let gaps = pair.gaps(&opening, asked);
        // NaN, from numbers that overflow, counts as meeting.
        let apart = gaps.simd_gt(f32x4::splat(margin)).to_bitmask() as u8 & asked;
        let met = asked & !apart;
        for lane in lanes(before & apart) {
            self.stats.raised += u64::from(opening.leaves >> lane & 1 == 0);
            self.cells.part(index, lane);
        }
        for lane in lanes(met & !before) {
            self.stats.lowered += 1;
            let slots = cell.pair(lane);
            if opening.leaves >> lane & 1 != 0 {
                self.cells.meet_leaves(index, lane, pair.leaves(slots));
            } else {
                let below = self.cells.add(pair.open(slots), cell.depth + 1);
                self.cells.meet(index, lane, below);
                self.pending.push(below);
            }
        }
        if self.is_adaptive() {
            self.set_lasting(index, gaps, apart, met, stamp);
        }
    }

    /// Sets until when the lanes that are apart, and those that met, stay so.
    #[inline(always)]
    fn set_lasting(&mut self, index: u32, gaps: f32x4, apart: u8, met: u8, stamp: f64) {
        let gaps = gaps.to_array();
        let (mut least, mut largest) = (f32::MAX, f32::MIN);
        for lane in 0..4 {
            let (is_apart, has_met) = (apart >> lane & 1 != 0, met >> lane & 1 != 0);
            least = if is_apart && gaps[lane] < least { gaps[lane] } else { least };
            let gap = if gaps[lane].is_nan() { f32::MAX } else { gaps[lane] };
            largest = if has_met && gap > largest { gap } else { largest };
        }
        let stamp = stamp as f32;
        let parted_until = (least + stamp.next_down()).next_down();
        self.cells.set_lasting(index, parted_until, PATIENCE * largest - stamp);
    }
}

/// Passes on the calls of [`Visitor::leaves`] only.
struct Leaves<'a, V>(&'a mut V);

impl<V: Visitor> Visitor for Leaves<'_, V> {
    #[inline(always)]
    fn leaves(
        &mut self,
        leaf1: u32,
        batch1: &LeafBatch,
        leaf2: u32,
        batch2: &LeafBatch,
    ) -> Verdict {
        self.0.leaves(leaf1, batch1, leaf2, batch2)
    }
}
