//! The descent of one tree against a convex shape: both children of a node at a time.

use super::convex::Convex;
use super::counters::Counters;
use super::probe::Probe;
use super::visitor::Verdict;
use crate::simd::each_bit;
use crate::tree::{LeafBatch, Link, Tree};
use crate::volumes::{DirectionSet, Directions};

/// Memory of the descent, kept by the caller. Holds at most one node a level of the tree and one
/// more.
#[derive(Clone, Debug, Default)]
pub struct ProbeScratch {
    stack: Vec<Link>,
}

/// Visits all leaves whose volumes, and those of all their ancestors, come within the margin of the
/// shape.
///
/// Finds every triangle within the margin: volumes contain what is below them and tests are
/// conservative, see [`Probe`]. The order of visits depends on the tree only. Of the visitor's
/// verdicts only [`Verdict::Stop`] makes a difference.
pub fn descend_probe<S: Convex, const AXES: usize>(
    tree: &Tree<AXES>,
    probe: &mut Probe<'_, S, AXES>,
    scratch: &mut ProbeScratch,
    mut counters: impl Counters,
    mut visit: impl FnMut(&LeafBatch) -> Verdict,
) where
    Directions<AXES>: DirectionSet<AXES>,
{
    // The root's own volume is in lane 0 of the first entry.
    let root = tree.children(0);
    counters.aabb_tests(1);
    if probe.boxes_meet(&root) & 1 == 0 {
        return;
    }
    let stack = &mut scratch.stack;
    stack.clear();
    stack.push(root.links[0]);
    while let Some(link) = stack.pop() {
        if link.is_leaf() {
            counters.leaf_pair();
            if visit(tree.leaf(link.index())) == Verdict::Stop {
                return;
            }
            continue;
        }
        let children = tree.children(link.index());
        counters.aabb_tests(2);
        let mut meeting = probe.boxes_meet(&children);
        if let Some(kdops) = children.kdops.filter(|_| meeting != 0) {
            counters.kdop_tests(meeting.count_ones());
            meeting &= probe.kdops_meet(&kdops);
        }
        each_bit(meeting, |lane| stack.push(children.links[lane]));
    }
}
