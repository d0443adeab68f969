//! Triangles against triangles, a batch at a time: which pairs of two leaves may come within the margin.
//!
//! The test looks for a separating axis over SIMD lanes: one triangle of leaf 1 against the batch of
//! leaf 2. It is conservative and nearly exact; what survives goes to the exact test in f64
//! ([`contact`](crate::contact)). The same code runs over one lane for comparison:
//! [`LeafTest::survivors_scalar`]. [`ProbeTest`] does the same for triangles and a convex shape.

pub(crate) mod lane;
mod placed;
mod probe;
mod separation;

pub(crate) use placed::PlacedTest;
pub use probe::ProbeTest;

use wide::f32x4;

use crate::traverse::PairFrame;
use crate::tree::{BATCH, LeafBatch};
use lane::each;
use separation::{Corners, LeafFrame, near, near_by_centroids};

/// Tests pairs of leaves at one pose. Made once a query.
#[derive(Copy, Clone)]
pub struct LeafTest(LeafFrame);

impl LeafTest {
    /// For the pose and margin of `frame`.
    pub fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        Self(LeafFrame::new(frame))
    }

    /// The same test with another margin.
    #[inline]
    #[must_use]
    pub fn within(&self, margin: f32) -> Self {
        Self(self.0.within(margin))
    }

    /// Calls `found(lane1, lane2)` for the pairs of triangles that no axis separates by more than the margin, in
    /// lexicographic order.
    #[inline]
    pub fn survivors(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        mut found: impl FnMut(usize, usize),
    ) {
        self.lanes_near(batch1, batch2, near, |lane1, lanes2| {
            each_bit(lanes2, |lane2| found(lane1, lane2));
        });
    }

    /// As [`survivors`](Self::survivors), with one more axis, for triangles that may be far apart for their size.
    #[inline]
    pub(crate) fn far_survivors(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        mut found: impl FnMut(usize, usize),
    ) {
        let test = |frame: &LeafFrame, one: &Corners<f32x4>, two: &Corners<f32x4>| {
            let by_centroids = near_by_centroids(frame, one, two);
            if by_centroids.to_bitmask() == 0 {
                by_centroids
            } else {
                by_centroids & near(frame, one, two)
            }
        };
        self.lanes_near(batch1, batch2, test, |lane1, lanes2| {
            each_bit(lanes2, |lane2| found(lane1, lane2));
        });
    }

    /// Calls `found(lane1, lanes2)` for each triangle of leaf 1 that has others in leaf 2, a mask, near by `test`.
    #[inline(always)]
    fn lanes_near(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        test: impl Fn(&LeafFrame, &Corners<f32x4>, &Corners<f32x4>) -> f32x4,
        mut found: impl FnMut(usize, u32),
    ) {
        let frame = &self.0;
        let two = Corners::from_frame2(frame, lanes(&batch2.corners, f32x4::new));
        let used = (1 << batch2.count()) - 1;
        for lane1 in 0..batch1.count() {
            let one = Corners::new(lanes(&batch1.corners, |axis| f32x4::splat(axis[lane1])));
            found(lane1, test(frame, &one, &two).to_bitmask() & used);
        }
    }

    /// [`survivors`](Self::survivors) over one lane: the same answer, slower.
    pub fn survivors_scalar(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        mut found: impl FnMut(usize, usize),
    ) {
        let one_lane = |batch: &LeafBatch, lane| batch.corners(lane).map(|c| c.to_array());
        for lane1 in 0..batch1.count() {
            let one = Corners::new(one_lane(batch1, lane1));
            for lane2 in 0..batch2.count() {
                if near(&self.0, &one, &Corners::from_frame2(&self.0, one_lane(batch2, lane2))) {
                    found(lane1, lane2);
                }
            }
        }
    }
}

#[inline(always)]
fn each_bit(mut mask: u32, mut found: impl FnMut(usize)) {
    while mask != 0 {
        found(mask.trailing_zeros() as usize);
        mask &= mask - 1;
    }
}

#[inline(always)]
fn lanes(
    corners: &[[[f32; BATCH]; 3]; 3],
    lane: impl Fn([f32; BATCH]) -> f32x4,
) -> [[f32x4; 3]; 3] {
    each(|corner| each(|axis| lane(corners[corner][axis])))
}
