//! All contacts of two meshes, or any one.

use wide::f32x4;

use crate::leaf::LeafTest;
use crate::simd::Spread;
use crate::traverse::{NodeLanes, PairFrame, Placement, descend};
use crate::tree::Tree;
use crate::volumes::rounding::gamma;

use super::seek::{FOUND, LowerBound, Pruned, SearchScratch, seek};
use super::triangles::FoundPair;

/// Calls `found` for each pair of triangles at a distance of at most `margin`, in units of frame 1.
/// `placement` places mesh 2 in frame 1.
///
/// Triangles that touch, up to 1e-12 of their size, are always among them. The order depends on the
/// trees and the pose only. No pair is found if the placement is not finite, or if the margin is
/// negative or NaN. Margins above 1e15 count as 1e15.
///
/// For the points of a manifold see [`clip`](crate::contact::clip); for one pair out of all,
/// [`nearest`](super::nearest()) is much faster.
pub fn contacts(
    trees: (&Tree, &Tree),
    placement: Placement,
    margin: f64,
    scratch: &mut SearchScratch,
    mut found: impl FnMut(FoundPair),
) {
    if !placement.is_finite() || !(0.0..).contains(&margin) {
        return;
    }
    let margin = margin.min(WIDEST_MARGIN);
    // Rounded up.
    let widened = margin as f32 * (1.0 + gamma(4)) + f32::MIN_POSITIVE;
    let mut frame = PairFrame::new(trees, placement, widened);
    let test = LeafTest::new(&frame);
    descend(trees, &mut frame, &mut scratch.descent, |batch1, batch2| {
        test.survivors(batch1, batch2, |lane1, lane2| {
            let (one, two) = (batch1.triangle(lane1), batch2.triangle(lane2));
            if let Some(pair) = FoundPair::of(&placement, one, two, margin) {
                found(pair);
            }
        });
    });
}

/// Greatest margin: squares of wider ones may overflow in the leaf test.
const WIDEST_MARGIN: f64 = 1.0e15;

/// Returns a pair of triangles that touch or cross, with mesh 2 placed at `placement` in frame 1.
/// `None` if no pair meets, or if the placement is not finite.
///
/// Triangles touch up to 1e-12 of their size. Faster than [`nearest`](super::nearest()) with a
/// limit of zero, which may choose another pair. Each axis only has to tell whether nodes are
/// apart, as in a descent, not how far. The pair of nodes that overlaps most is looked at first.
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
    let mut overlap = Pruned { frame: &mut frame, bound: Overlaps, limit: 0.0, normal: None };
    let mut found = None;
    seek(trees, &mut overlap, scratch, |overlap, batch1, batch2| {
        test.survivors(batch1, batch2, |lane1, lane2| {
            if found.is_none() {
                let (one, two) = (batch1.triangle(lane1), batch2.triangle(lane2));
                found = FoundPair::of(&placement, one, two, 0.0);
            }
        });
        if found.is_some() {
            overlap.limit = FOUND;
        }
    });
    found
}

/// Minus the overlap of nodes.
struct Overlaps;

impl LowerBound for Overlaps {
    #[inline(always)]
    fn of(&self, frame: &mut PairFrame, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        frame.overlaps(nodes)
    }
}
