//! Whether any triangles of two meshes meet.
//!
//! The search for the nearest pair, with a limit of zero, would tell; but how far apart nodes are is of no interest here, and
//! each axis only has to tell whether they are, as in a descent: a tenth to a fifth less time. Of pairs that overlap the one that
//! does most is looked at first.

use crate::contact::contact;
use crate::leaf::LeafTest;
use crate::traverse::{OrderedOverlap, PairFrame, Placement};
use crate::tree::{LeafBatch, Tree};
use crate::volumes::{DirectionSet, Directions};

use super::seek::{Bounds, FOUND, SearchScratch, seek};
use super::triangles::{FoundPair, LocalPair};

/// A pair of triangles that touch or cross, mesh 2 placed at `placement` in the frame of mesh 1; `None` if there is none, or if
/// the placement is not finite.
///
/// Triangles touch up to 1e-12 of their size. As [`nearest`](super::nearest()) with a limit of zero, but for the choice among several
/// pairs, and faster.
pub fn meeting<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement: Placement,
    scratch: &mut SearchScratch,
) -> Option<FoundPair>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    if !placement.is_finite() {
        return None;
    }
    let mut frame = PairFrame::at(trees, placement, 0.0);
    let test = LeafTest::new(&frame);
    let overlap = OrderedOverlap(&mut frame);
    let mut search = Search { overlap, placement, test, found: None };
    seek(trees, &mut search, scratch);
    search.found
}

struct Search<'a, const AXES: usize> {
    overlap: OrderedOverlap<'a, AXES>,
    placement: Placement,
    test: LeafTest,
    found: Option<FoundPair>,
}

impl<const AXES: usize> Search<'_, AXES> {
    fn triangles(&mut self, side1: (&LeafBatch, usize), side2: (&LeafBatch, usize)) {
        if self.found.is_some() {
            return;
        }
        let pair = LocalPair::new(&self.placement, side1, side2);
        let [t1, t2] = &pair.corners;
        if let Some(contact) = contact(t1, t2, pair.touching_distance()) {
            let [triangle1, triangle2] =
                [side1, side2].map(|(batch, lane)| batch.triangles()[lane]);
            let origin = pair.origin;
            self.found =
                Some(FoundPair { triangle1, triangle2, contact, origin, is_touching: true });
        }
    }
}

impl<'a, const AXES: usize> Bounds<AXES> for Search<'a, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    type Compare = OrderedOverlap<'a, AXES>;

    #[inline(always)]
    fn compare(&mut self) -> &mut Self::Compare {
        &mut self.overlap
    }

    #[inline(always)]
    fn limit(&self) -> f32 {
        if self.found.is_some() { FOUND } else { f32::INFINITY }
    }

    fn leaves(&mut self, batch1: &LeafBatch, batch2: &LeafBatch) {
        let test = self.test;
        let found = |lane1, lane2| self.triangles((batch1, lane1), (batch2, lane2));
        test.survivors(batch1, batch2, found);
    }
}
