//! A pair of leaves to start with that is probably near the answer.
//!
//! A search prunes by the best pair of triangles so far, so a good one at the start is worth more
//! than any later.

use wide::f32x4;

use crate::simd::{Spread, dot};
use crate::traverse::{Compare, NodeLanes, PairFrame, expand};
use crate::tree::{LeafBatch, Slot, Tree};

/// Down both trees from the roots, always to the children whose centres are nearest to each other.
pub(super) fn near_leaves<'a>(
    (tree1, tree2): (&'a Tree, &'a Tree),
    frame: &PairFrame,
) -> (&'a LeafBatch, &'a LeafBatch) {
    let mut slots = (Slot::ROOT, Slot::ROOT);
    loop {
        let links = (tree1.link(slots.0), tree2.link(slots.1));
        if links.0.is_leaf() && links.1.is_leaf() {
            return (tree1.leaf(links.0.index()), tree2.leaf(links.1.index()));
        }
        let mut nearest = f32::INFINITY;
        let pair = slots;
        expand((tree1, tree2), pair, &mut Centres(frame), |children, squared| {
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
