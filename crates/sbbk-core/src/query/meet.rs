//! A test of two meshes for triangles that meet.
//!
//! The search for the nearest pair with a limit of zero would tell. Here each axis only has to tell
//! whether nodes are apart, as in a descent, not how far: a tenth to a fifth less time. The pair of
//! nodes that overlaps most is looked at first.

use crate::leaf::LeafTest;
use crate::traverse::{OrderedOverlap, PairFrame, Placement};
use crate::tree::{LeafBatch, Tree};

use super::seek::{BestFirst, FOUND, SearchScratch, seek};
use super::triangles::FoundPair;

/// Returns a pair of triangles that touch or cross, with mesh 2 placed at `placement` in frame 1.
/// `None` if no pair meets, or if the placement is not finite.
///
/// Triangles touch up to 1e-12 of their size. Faster than [`nearest`](super::nearest()) with a
/// limit of zero, which may choose another pair.
pub fn meeting(
    trees: (&Tree, &Tree),
    placement: Placement,
    scratch: &mut SearchScratch,
) -> Option<FoundPair> {
    if !placement.is_finite() {
        return None;
    }
    let mut frame = PairFrame::new(trees, placement, 0.0);
    let test = LeafTest::new(&frame);
    let overlap = OrderedOverlap(&mut frame);
    let mut search = MeetingSearch { overlap, placement, test, found: None };
    seek(trees, &mut search, scratch);
    search.found
}

struct MeetingSearch<'a> {
    overlap: OrderedOverlap<'a>,
    placement: Placement,
    test: LeafTest,
    found: Option<FoundPair>,
}

impl<'a> BestFirst for MeetingSearch<'a> {
    type Compare = OrderedOverlap<'a>;

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
        test.survivors(batch1, batch2, |lane1, lane2| {
            if self.found.is_none() {
                let (one, two) = (batch1.triangle(lane1), batch2.triangle(lane2));
                self.found = FoundPair::of(&self.placement, one, two, 0.0);
            }
        });
    }
}
