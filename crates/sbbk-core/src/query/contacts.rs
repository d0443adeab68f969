//! All contacts of two meshes.

use crate::leaf::LeafTest;
use crate::traverse::{PairFrame, Placement, descend};
use crate::tree::Tree;
use crate::volumes::rounding::gamma;

use super::seek::SearchScratch;
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
    descend(trees, &mut frame, &mut scratch.descent, (), |batch1, batch2| {
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
