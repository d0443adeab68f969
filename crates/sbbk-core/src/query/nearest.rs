//! The nearest or the deepest pair of triangles.

use glamx::DVec3;

use crate::contact::contact;
use crate::leaf::LeafTest;
use crate::traverse::{Cutoff, GapCounts, PairFrame, Placement, SignedGaps, Toward};
use crate::tree::{LeafBatch, Tree};
use crate::volumes::{DirectionSet, Directions};

use super::guess::near_leaves;
use super::seek::{Bounds, FOUND, SearchScratch, seek};
use super::triangles::{FoundPair, LeafTriangle, TrianglePair};

/// Which pair of triangles is sought.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Goal {
    /// The nearest one. If several touch or cross, any of them.
    Nearest,
    /// The nearest one; if several touch or cross, the deepest.
    Deepest,
}

/// Margins of the leaf test whose squares would overflow are no use.
const WIDEST_LEAF_MARGIN: f32 = 1.0e15;

/// The pair of triangles sought, mesh 2 placed at `placement` in the frame of mesh 1; `None` if all pairs are farther
/// apart than `limit`, or if the placement is not finite.
///
/// Triangles touch up to 1e-12 of their size. With a limit of zero this is the test whether the surfaces meet.
pub fn nearest<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement: Placement,
    limit: f64,
    goal: Goal,
    scratch: &mut SearchScratch,
) -> Option<FoundPair>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    nearest_counted(trees, placement, limit, goal, scratch).0
}

/// As [`nearest`], with the work that was done.
pub fn nearest_counted<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement: Placement,
    limit: f64,
    goal: Goal,
    scratch: &mut SearchScratch,
) -> (Option<FoundPair>, GapCounts)
where
    Directions<AXES>: DirectionSet<AXES>,
{
    // Not `min`: a limit that is NaN stays, and admits nothing.
    let some = some_distance(trees, &placement);
    let best = if some < limit { some } else { limit };
    nearest_besides(trees, placement, best, goal, &[], scratch)
}

/// The same of all pairs of triangles but some, which are given in ascending order.
pub(super) fn nearest_besides<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement: Placement,
    best: f64,
    goal: Goal,
    besides: &[[u32; 2]],
    scratch: &mut SearchScratch,
) -> (Option<FoundPair>, GapCounts)
where
    Directions<AXES>: DirectionSet<AXES>,
{
    // Not `best < 0`: a limit that is NaN admits nothing.
    let admits = best >= 0.0;
    if !admits || !placement.is_finite() {
        return (None, GapCounts::default());
    }
    let mut frame = PairFrame::at(trees, placement, 0.0);
    let test = LeafTest::new(&frame);
    let gaps = SignedGaps { frame: &mut frame, cutoff: Cutoff::at(above(best)), toward: None };
    let mut search = NearestSearch { gaps, placement, test, goal, besides, best, found: None };
    // A limit of zero cannot be lowered: the search ends with the first pair that meets.
    if best > 0.0 {
        let (leaf1, leaf2) = near_leaves(trees, search.gaps.frame);
        search.leaves(leaf1, leaf2);
    }
    seek(trees, &mut search, scratch);
    (search.found, search.gaps.cutoff.counts)
}

/// The distance of two vertices: the least is not above it.
fn some_distance<const AXES: usize>(
    (tree1, tree2): (&Tree<AXES>, &Tree<AXES>),
    placement: &Placement,
) -> f64 {
    let [vertex1, vertex2] = [tree1, tree2].map(|tree| tree.leaf(0).corners(0)[0]);
    let distance = placement.to_frame1(vertex2, vertex1).length();
    distance * (1.0 + 1.0e-9)
}

/// The f32 above.
fn above(x: f64) -> f32 {
    (x as f32).next_up()
}

struct NearestSearch<'a, const AXES: usize> {
    gaps: SignedGaps<'a, AXES>,
    placement: Placement,
    test: LeafTest,
    goal: Goal,
    /// Pairs of triangles that do not count, in ascending order.
    besides: &'a [[u32; 2]],
    /// The signed distance to beat.
    best: f64,
    found: Option<FoundPair>,
}

impl<const AXES: usize> NearestSearch<'_, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    fn triangles(&mut self, one: LeafTriangle<'_>, two: LeafTriangle<'_>) {
        if self.gaps.cutoff.limit == FOUND {
            return;
        }
        let besides = self.besides;
        if !besides.is_empty() && besides.binary_search(&[one.index(), two.index()]).is_ok() {
            return;
        }
        self.gaps.cutoff.counts.triangle_pairs += 1;
        let pair = TrianglePair::new(&self.placement, one.corners(), two.corners());
        let touching = pair.touching_distance();
        let margin = if self.best >= 0.0 { self.best.max(touching) } else { self.best };
        let [t1, t2] = &pair.corners;
        let Some(contact) = contact(t1, t2, margin) else {
            return;
        };
        if self.found.is_some() && contact.distance >= self.best {
            return;
        }
        self.found = Some(FoundPair::new(one, two, &pair, contact));
        self.best = contact.distance;
        let is_last = self.goal == Goal::Nearest && contact.distance <= touching;
        self.gaps.cutoff.limit = if is_last { FOUND } else { above(contact.distance) };
        self.look_along(contact.normal);
    }

    /// Bounds along the normal of the best pair from now on. Rare, and long: kept out of the way.
    #[inline(never)]
    fn look_along(&mut self, normal: DVec3) {
        // Where triangles cross, the normal tells nothing about the others.
        self.gaps.toward = None;
        if self.best > 0.0 {
            self.gaps.toward = Toward::new(self.gaps.frame, normal);
        }
    }
}

impl<'a, const AXES: usize> Bounds<AXES> for NearestSearch<'a, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    type Compare = SignedGaps<'a, AXES>;

    #[inline(always)]
    fn compare(&mut self) -> &mut Self::Compare {
        &mut self.gaps
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        self.gaps.cutoff.limit
    }

    fn leaves(&mut self, batch1: &LeafBatch, batch2: &LeafBatch) {
        self.gaps.cutoff.counts.leaf_pairs += 1;
        let toward = self.gaps.toward.as_ref();
        if toward.is_some_and(|t| t.gap_of_leaves(batch1, batch2) > self.gaps.cutoff.limit) {
            return;
        }
        if self.gaps.cutoff.limit < WIDEST_LEAF_MARGIN {
            let test = self.test.within(self.gaps.cutoff.limit);
            // The axis of far triangles tells nothing about those that touch.
            let is_far = self.best > 0.0;
            let found = |lane1, lane2| {
                let one = LeafTriangle { batch: batch1, lane: lane1 };
                self.triangles(one, LeafTriangle { batch: batch2, lane: lane2 });
            };
            if is_far {
                test.far_survivors(batch1, batch2, found);
            } else {
                test.survivors(batch1, batch2, found);
            }
        } else {
            for lane1 in 0..batch1.count() {
                for lane2 in 0..batch2.count() {
                    let one = LeafTriangle { batch: batch1, lane: lane1 };
                    self.triangles(one, LeafTriangle { batch: batch2, lane: lane2 });
                }
            }
        }
    }
}
