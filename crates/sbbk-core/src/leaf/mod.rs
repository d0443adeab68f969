//! Which triangles of two leaves may come within the margin.
//!
//! The test looks for a separating axis in SIMD lanes: one triangle of leaf 1 against the batch of
//! leaf 2. It is conservative and nearly exact. Pairs that pass go to the exact
//! [`contact`](mod@crate::contact) in f64. A [`LeafBatch`] comes from a tree or any other
//! hierarchy.

mod lateral;
mod placed;
mod separation;

pub use lateral::LateralCulling;
pub(crate) use placed::PlacedTest;

use std::cell::Cell;

use wide::f32x4;

use crate::simd::{V3, bits, each};
use crate::traverse::PairFrame;
use crate::tree::LeafBatch;
use separation::{Corners, LeafFrame, apart, apart_by_centroids};

/// Tests pairs of leaves at one pose. Made once a query.
#[derive(Copy, Clone)]
pub struct LeafTest {
    frame: LeafFrame,
}

impl LeafTest {
    /// A test at the pose and margin of `frame`.
    pub fn new(frame: &PairFrame) -> Self {
        let at = LeafFrame::at(&frame.placement);
        Self { frame: at.with_margin(frame.margin, frame.rounding[0]) }
    }

    /// Replaces the margin.
    #[inline]
    #[must_use]
    pub fn within(&self, margin: f32) -> Self {
        Self { frame: self.frame.with_margin(margin, self.frame.rounding) }
    }

    /// Calls `found(lane1, lane2)` for the pairs of triangles that no axis separates by more than
    /// the margin, in lexicographic order.
    #[inline]
    pub fn survivors(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        found: impl FnMut(usize, usize),
    ) {
        self.not_apart(batch1, batch2, apart, found);
    }

    /// Like [`survivors`](Self::survivors). With `lateral`, leaves out pairs whose nearest points
    /// are beside one of the triangles. `may_reject` returns true for a triangle whose pairs may be
    /// left out, by its leaf (0 or 1) and lane.
    #[inline]
    pub fn survivors_in_front(
        &self,
        lateral: Option<&LateralCulling>,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        may_reject: impl Fn(usize, usize) -> bool,
        mut found: impl FnMut(usize, usize),
    ) {
        let Some(lateral) = lateral else { return self.survivors(batch1, batch2, found) };
        let beside = Cell::new([0; 2]);
        let test = |frame: &LeafFrame, one: &Corners, two: &Corners| {
            let apart = apart(frame, one, two);
            beside.set(if apart.all() { [0; 2] } else { lateral.beside(frame, one, two) });
            apart
        };
        self.not_apart(batch1, batch2, test, |lane1, lane2| {
            let [beside1, beside2] = beside.get().map(|lanes| lanes >> lane2 & 1 == 1);
            if !(beside1 && may_reject(0, lane1) || beside2 && may_reject(1, lane2)) {
                found(lane1, lane2);
            }
        });
    }

    /// Like [`survivors`](Self::survivors), with one more axis for triangles that may be far apart
    /// for their size.
    #[inline]
    pub(crate) fn far_survivors(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        found: impl FnMut(usize, usize),
    ) {
        let test = |frame: &LeafFrame, one: &Corners, two: &Corners| {
            let by_centroids = apart_by_centroids(frame, one, two);
            if by_centroids.all() { by_centroids } else { by_centroids | apart(frame, one, two) }
        };
        self.not_apart(batch1, batch2, test, found);
    }

    /// Calls `found` for the pairs of triangles that are not apart by `test`.
    #[inline(always)]
    fn not_apart(
        &self,
        batch1: &LeafBatch,
        batch2: &LeafBatch,
        test: impl Fn(&LeafFrame, &Corners, &Corners) -> f32x4,
        mut found: impl FnMut(usize, usize),
    ) {
        let frame = &self.frame;
        let two = Corners::from_frame2(frame, batch2.lanes());
        let used = used(batch2);
        for lane1 in 0..batch1.count() {
            let one = Corners::new(splat(|corner, axis| batch1.corners[corner][axis][lane1]));
            let near = !test(frame, &one, &two).to_bitmask() & used;
            for lane2 in bits(near) {
                found(lane1, lane2);
            }
        }
    }
}

/// The lanes of a leaf that hold a triangle, as bits.
#[inline(always)]
fn used(batch: &LeafBatch) -> u32 {
    (1 << batch.count()) - 1
}

/// Fills all lanes with the triangle whose coordinates are `coordinate(corner, axis)`.
#[inline(always)]
fn splat(coordinate: impl Fn(usize, usize) -> f32) -> [V3<f32x4>; 3] {
    each(|corner| each(|axis| f32x4::splat(coordinate(corner, axis))))
}
