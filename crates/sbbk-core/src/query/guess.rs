//! A pair of leaves to start with that is probably near the answer.
//!
//! A search prunes by the best pair of triangles so far, so a good one at the start is worth more
//! than any later.

use wide::f32x4;

use crate::simd::{Spread, dot};
use crate::traverse::{Compare, NodeLanes, PairFrame, expand, leaves_at};
use crate::tree::{LeafBatch, Slot, Tree};

/// Down both trees from the roots, always to the children whose centres are nearest to each other.
pub(super) fn near_leaves<'a>(
    trees: (&'a Tree, &'a Tree),
    frame: &PairFrame,
) -> (&'a LeafBatch, &'a LeafBatch) {
    let mut slots = (Slot::ROOT, Slot::ROOT);
    loop {
        if let Some(leaves) = leaves_at(trees, slots) {
            return leaves;
        }
        let mut nearest = f32::INFINITY;
        let pair = slots;
        expand(trees, pair, &mut Centres(frame), |children, squared| {
            // The first one even if all are NaN.
            if slots == pair || squared < nearest {
                (slots, nearest) = (children, squared);
            }
        });
    }
}

/// Compares nodes by the squared distance of their centres.
struct Centres<'a>(&'a PairFrame);

impl Compare for Centres<'_> {
    type Key = f32;

    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        let offset = self.0.along1(nodes, f32x4::ZERO).offset;
        (nodes.lanes, dot(offset, offset).to_array())
    }
}
