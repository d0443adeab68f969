//! The simultaneous descent of two trees (section 3.2 of the SBBK paper).
//!
//! The pairs of children replace a pair of nodes that meet; one SIMD test compares all four. Where
//! one side is a leaf, the other goes on alone.
//!
//! For complete trees of n levels in which all nodes meet, the paper counts `(2^(2(n-1)) - 1)/3`
//! tests between inner nodes and `2^(2(n-1))` between leaves. A descent of one side at a time makes
//! `2^(2n-1) - 1` tests.

use super::counters::Counters;
use super::expand::{Sides, expand};
use super::frame::PairFrame;
use super::overlap::Overlap;
use super::side::Side;
use crate::simd::Same;
use crate::tree::{LeafBatch, Slot, Tree};

/// Memory of descents, kept by the caller: after a few queries nothing is allocated.
///
/// The stack holds at most 3 pairs for each level of both trees.
#[derive(Clone, Debug, Default)]
pub struct DescentScratch {
    stack: Vec<(Slot, Slot)>,
}

/// Calls `visit` with all pairs of leaves whose volumes, and those of all their ancestors, come
/// within the margin.
///
/// Finds every pair of triangles within the margin: volumes contain all below them, and tests are
/// conservative, see [`PairFrame`]. The order of visits depends on the trees only.
pub fn descend(
    (tree1, tree2): (&Tree, &Tree),
    frame: &mut PairFrame,
    scratch: &mut DescentScratch,
    mut counters: impl Counters,
    mut visit: impl FnMut(&LeafBatch, &LeafBatch),
) {
    if tree1.sphere().is_some() && tree2.sphere().is_some() {
        counters.sphere_test();
        if !frame.spheres_meet(tree1, tree2) {
            return;
        }
    }
    counters.aabb_tests(1);
    let [root1, root2] =
        [tree1, tree2].map(|tree| Side { children: tree.children(0), spread: Same(0) });
    if frame.boxes_meet(&root1, &root2) == 0 {
        return;
    }

    let stack = &mut scratch.stack;
    stack.clear();
    stack.push((Slot::ROOT, Slot::ROOT));
    while let Some(slots) = stack.pop() {
        let links = (tree1.link(slots.0), tree2.link(slots.1));
        if links.0.is_leaf() && links.1.is_leaf() {
            counters.leaf_pair();
            visit(tree1.leaf(links.0.index()), tree2.leaf(links.1.index()));
            continue;
        }
        let mut compare = Overlap { frame, counters: &mut counters };
        expand((tree1, tree2), slots, Sides::of(links), &mut compare, |slots, ()| {
            stack.push(slots);
        });
    }
}
