//! The simultaneous descent of two trees (section 3.2 of the SBBK paper).
//!
//! The pairs of children replace a pair of nodes that meet; one SIMD test compares all four. A leaf
//! is not replaced, nor is a node much smaller than the other one.
//!
//! For complete trees of n levels in which all nodes meet, the paper counts `(2^(2(n-1)) - 1)/3`
//! tests between inner nodes and `2^(2(n-1))` between leaves. A descent of one side at a time makes
//! `2^(2n-1) - 1` tests.

use super::expand::{NodePair, expand, leaves_at};
use super::frame::PairFrame;
use super::overlap::Overlap;
use super::side::NodeLanes;
use crate::simd::Same;
use crate::tree::{LeafBatch, Tree};

/// Memory of descents, kept by the caller: after a few queries nothing is allocated.
///
/// The stack holds at most 3 pairs for each level of both trees, besides those at which a descent
/// starts.
#[derive(Clone, Debug, Default)]
pub struct DescentScratch {
    stack: Vec<NodePair>,
}

/// Calls `visit` with all pairs of leaves whose volumes, and those of all their ancestors, come
/// within the margin.
///
/// Finds every pair of triangles within the margin: volumes contain all below them, and tests are
/// conservative, see [`PairFrame`]. The order of visits depends on the trees only.
pub fn descend(
    trees: (&Tree, &Tree),
    frame: &mut PairFrame,
    scratch: &mut DescentScratch,
    visit: impl FnMut(&LeafBatch, &LeafBatch),
) {
    let start = roots(trees, frame);
    descend_from(start.as_slice(), trees, frame, scratch, visit);
}

/// Replaces `pairs` by up to `count` pairs of nodes or a few more, or by all pairs of leaves if
/// these are fewer. Calls of [`descend_from`] for all of them make a whole descent, in parts that
/// may run on several threads.
pub fn begin_descent(
    trees: (&Tree, &Tree),
    frame: &mut PairFrame,
    count: usize,
    pairs: &mut Vec<NodePair>,
) {
    pairs.clear();
    pairs.extend(roots(trees, frame));
    // A queue. Pairs of leaves go back to its end, until nothing else is left.
    let (mut first, mut leaves) = (0, 0);
    while let waiting = pairs.len() - first
        && waiting < count
        && leaves < waiting
    {
        let pair = pairs[first];
        first += 1;
        if leaves_at(trees, pair).is_some() {
            leaves += 1;
            pairs.push(pair);
        } else {
            leaves = 0;
            expand(trees, pair, &mut Overlap(frame), |pair, _| pairs.push(pair));
        }
    }
    pairs.drain(..first);
}

/// Continues a descent below pairs of nodes; see [`descend`].
pub fn descend_from(
    pairs: &[NodePair],
    trees: (&Tree, &Tree),
    frame: &mut PairFrame,
    scratch: &mut DescentScratch,
    mut visit: impl FnMut(&LeafBatch, &LeafBatch),
) {
    let stack = &mut scratch.stack;
    stack.clear();
    stack.extend_from_slice(pairs);
    while let Some(pair) = stack.pop() {
        if let Some((leaf1, leaf2)) = leaves_at(trees, pair) {
            frame.counts.leaf_pairs += 1;
            visit(leaf1, leaf2);
        } else {
            expand(trees, pair, &mut Overlap(frame), |pair, _| stack.push(pair));
        }
    }
}

/// Returns the roots if these come within the margin.
fn roots((tree1, tree2): (&Tree, &Tree), frame: &mut PairFrame) -> Option<NodePair> {
    if !frame.spheres_meet(tree1, tree2) {
        return None;
    }
    frame.counts.aabb_tests += 1;
    let [root1, root2] = [tree1, tree2].map(|tree| (tree.children(0), Same(0)));
    (frame.boxes_meet(&NodeLanes::new(root1, root2, 1)) != 0).then_some(NodePair::ROOTS)
}
