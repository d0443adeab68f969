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
use separation::{Corners, LeafFrame, near};

/// Tests pairs of leaves at one pose. Made once a query.
#[derive(Copy, Clone)]
pub struct LeafTest(LeafFrame);

impl LeafTest {
    /// For the pose and margin of `frame`.
    pub fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        Self(LeafFrame::new(frame))
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
        let frame = &self.0;
        let two = Corners::from_frame2(frame, lanes(&batch2.corners, f32x4::new));
        let used = (1 << batch2.count()) - 1;
        for lane1 in 0..batch1.count() {
            let one = Corners::new(lanes(&batch1.corners, |axis| f32x4::splat(axis[lane1])));
            let mut near = near(frame, &one, &two).to_bitmask() & used;
            while near != 0 {
                found(lane1, near.trailing_zeros() as usize);
                near &= near - 1;
            }
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
fn lanes(
    corners: &[[[f32; BATCH]; 3]; 3],
    lane: impl Fn([f32; BATCH]) -> f32x4,
) -> [[f32x4; 3]; 3] {
    each(|corner| each(|axis| lane(corners[corner][axis])))
}
