//! The descent: both trees at once.
//!
//! A pair of nodes that meet is replaced by the pairs of their children, all four compared in one
//! SIMD test (the paper's simultaneous descent, section 3.2). Where one side is a leaf, the other
//! goes on alone.
//!
//! For complete trees of n levels in which everything meets, the paper counts `(2^(2(n-1)) - 1)/3`
//! tests between inner nodes and `2^(2(n-1))` between leaves, against `2^(2n-1) - 1` in all when
//! one side descends at a time.

use super::counters::Counters;
use super::expand::{Sides, expand};
use super::frame::PairFrame;
use super::overlap::Overlap;
use super::side::Side;
use super::visitor::{NodePair, Verdict, Visitor};
use crate::simd::Same;
use crate::tree::{Link, Slot, Tree};

/// In which order the trees go down.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Descent {
    /// Both at once.
    #[default]
    Simultaneous,
    /// One at a time, taking turns: what the paper compares with. Visits more pairs.
    Single,
}

/// Memory of the descent, kept by the caller: after the first few queries nothing is allocated.
///
/// The stack holds at most 3 pairs a level of both trees in sum; it grows as needed.
#[derive(Clone, Debug, Default)]
pub struct DescentScratch {
    stack: Vec<NodePair>,
}

/// Visits all pairs of leaves whose volumes, and those of all their ancestors, come within the
/// margin.
///
/// Finds every pair of triangles within the margin: volumes contain what is below them and tests
/// are conservative, see [`PairFrame`]. The order of visits depends on the trees only.
pub fn descend<V: Visitor, C: Counters>(
    (tree1, tree2): (&Tree, &Tree),
    frame: &mut PairFrame,
    descent: Descent,
    scratch: &mut DescentScratch,
    mut counters: C,
    visitor: &mut V,
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
    stack.push(NodePair { slot1: Slot::ROOT, slot2: Slot::ROOT, depth: 0 });
    while let Some(pair) = stack.pop() {
        let links = (tree1.link(pair.slot1), tree2.link(pair.slot2));
        let verdict = if links.0.is_leaf() && links.1.is_leaf() {
            counters.leaf_pair();
            let (leaf1, leaf2) = (links.0.index(), links.1.index());
            match visitor.leaves(leaf1, tree1.leaf(leaf1), leaf2, tree2.leaf(leaf2)) {
                Verdict::Stop => Verdict::Stop,
                _ => Verdict::Prune,
            }
        } else {
            visitor.nodes(pair)
        };
        match verdict {
            Verdict::Stop => return,
            Verdict::Prune => {}
            Verdict::Descend => {
                let mut compare = Overlap { frame, counters: &mut counters };
                let sides = sides(descent, pair.depth, links);
                let depth = pair.depth + 1;
                let slots = (pair.slot1, pair.slot2);
                expand((tree1, tree2), slots, sides, &mut compare, |(slot1, slot2), ()| {
                    stack.push(NodePair { slot1, slot2, depth });
                });
            }
        }
    }
}

fn sides(descent: Descent, depth: u32, links: (Link, Link)) -> Sides {
    match descent {
        Descent::Single if !links.0.is_leaf() && !links.1.is_leaf() => {
            if depth.is_multiple_of(2) {
                Sides::First
            } else {
                Sides::Second
            }
        }
        _ => Sides::of(links),
    }
}
