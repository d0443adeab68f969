//! The SBBK paper's front (section 3.2, figures 3 and 4): a descent that starts where the last one
//! of the pair stopped.
//!
//! Here to reproduce the paper. Rapier's dispatcher keeps candidates with
//! [`Slack`](crate::traverse::Slack) instead, which takes less time.
//!
//! Bodies move little between steps, so a descent stops at nearly the same pairs of nodes as the
//! last one. A [`Front`] stores these pairs. Each query tests them, deepest first:
//!
//! * **Lowering.** Children replace a pair that now comes within the margin.
//! * **Raising.** A pair replaces its children once these and the pair itself have parted. The
//!   paper's front is only lowered, and grows with all pairs that ever met.
//!
//! Pairs above the front are not tested. So a query visits fewer nodes than a fresh descent, and
//! may visit pairs of leaves below a pair that has parted. The pairs of *triangles* within the
//! margin are the same.
//!
//! ```
//! use glamx::Pose3;
//! use sbbk_core::front::Front;
//! use sbbk_core::traverse::{PairFrame, Placement};
//! # use sbbk_core::tree::Tree;
//! # use glamx::Vec3;
//!
//! # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! # let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree = Tree::build(&vertices, &triangles.repeat(4), None)?;
//! let mut front = Front::default();
//! let mut tests = Vec::new();
//! for step in 0..3 {
//!     let pos12 = Pose3::translation(0.0, 0.0, 0.9 + 1e-4 * step as f32);
//!     let mut frame = PairFrame::new((&tree, &tree), Placement::new(&pos12), 0.02);
//!     front.visit((&tree, &tree), &mut frame, |_leaf1, _leaf2| {});
//!     tests.push(frame.counts.aabb_tests);
//! }
//! assert!(tests[0] > tests[1] && tests[1] == tests[2]);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

#[cfg(test)]
mod figure;

use crate::simd::bits;
use crate::traverse::{NodePair, Opening, Overlap, PairFrame, Sides, leaves_at};
use crate::tree::{LeafBatch, Slot, Tree};

/// The pairs of nodes where the last descent of two trees stopped: see [the module](self).
///
/// A front serves one pair of trees. [`clear`](Self::clear) it when a tree is exchanged.
#[derive(Clone, Debug, Default)]
pub struct Front {
    /// The pairs above the front; the first is that of the roots. The front is every lane that has
    /// not met.
    cells: Vec<Cell>,
    free: Vec<u32>,
}

/// A pair of nodes that met, with its up to four pairs of children.
#[derive(Copy, Clone, Debug)]
struct Cell {
    opening: Opening,
    /// Lanes that hold a pair of leaves.
    leaves: u32,
    /// Lanes that came within the margin.
    met: u32,
    /// The cell of each lane that met and is not a pair of leaves.
    below: [u32; 4],
}

impl Front {
    /// Forgets the front. The next query starts at the roots.
    pub fn clear(&mut self) {
        self.cells.clear();
        self.free.clear();
    }

    /// Number of pairs of nodes above the front.
    pub fn len(&self) -> usize {
        self.cells.len() - self.free.len()
    }

    /// True if the next query starts at the roots.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Calls `visit` with each pair of leaves that meets and is reached from the front. These
    /// include all leaves with triangles within the margin.
    ///
    /// Their order depends on earlier queries. A pose that is not finite finds nothing and clears
    /// the front.
    pub fn visit(
        &mut self,
        trees: (&Tree, &Tree),
        frame: &mut PairFrame,
        visit: impl FnMut(&LeafBatch, &LeafBatch),
    ) {
        if !frame.placement.is_finite() || !frame.spheres_meet(trees.0, trees.1) {
            self.clear();
            return;
        }
        self.update(&mut TreePair { trees, frame, visit });
    }

    fn update(&mut self, pair: &mut impl PairTest) {
        if self.is_empty() {
            self.add(pair.roots());
        }
        self.test(0, pair);
    }

    /// Tests the front below a cell, then the lanes of the cell that belong to it. Lanes right
    /// above the front are tested along with these: SIMD does it at no cost.
    fn test(&mut self, cell: u32, pair: &mut impl PairTest) {
        let Cell { opening, leaves, met: before, below } = self.cells[cell as usize];
        let above = before & !leaves;
        let mut asked = opening.lanes & !above;
        for lane in bits(above) {
            self.test(below[lane], pair);
            let all_parted = self.cells[below[lane] as usize].met == 0;
            asked |= u32::from(all_parted) << lane;
        }
        let meeting = if asked == 0 { 0 } else { pair.meeting(&opening, asked) };
        for lane in bits(asked & !meeting & before) {
            self.cells[cell as usize].met &= !(1 << lane);
            if above >> lane & 1 != 0 {
                self.free.push(below[lane]);
            }
        }
        for lane in bits(meeting & !above) {
            self.cells[cell as usize].met |= 1 << lane;
            if leaves >> lane & 1 != 0 {
                pair.visit(opening.pair(lane));
            } else {
                let opened = pair.open(opening.pair(lane));
                let added = self.add(opened);
                self.cells[cell as usize].below[lane] = added;
                self.test(added, pair);
            }
        }
    }

    fn add(&mut self, (opening, leaves): (Opening, u32)) -> u32 {
        let cell = Cell { opening, leaves, met: 0, below: [0; 4] };
        if let Some(free) = self.free.pop() {
            self.cells[free as usize] = cell;
            return free;
        }
        self.cells.push(cell);
        self.cells.len() as u32 - 1
    }
}

/// Two trees at a pose, or a stand-in for them in a test.
trait PairTest {
    /// The pair of roots, as the only lane, and the mask of lanes that hold a pair of leaves.
    fn roots(&self) -> (Opening, u32);
    /// The pairs below a pair that is not a pair of leaves, and the mask of pairs of leaves.
    fn open(&self, pair: NodePair) -> (Opening, u32);
    /// Counts and visits a pair of leaves.
    fn visit(&mut self, pair: NodePair);
    /// The lanes of `lanes` whose pairs come within the margin.
    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32;
}

/// Two trees at a pose.
struct TreePair<'a, V> {
    trees: (&'a Tree, &'a Tree),
    frame: &'a mut PairFrame,
    visit: V,
}

impl<V> TreePair<'_, V> {
    fn leaves(&self, opening: &Opening) -> u32 {
        let is_pair = |lane: &usize| leaves_at(self.trees, opening.pair(*lane)).is_some();
        bits(opening.lanes).filter(is_pair).fold(0, |leaves, lane| leaves | 1 << lane)
    }
}

impl<V: FnMut(&LeafBatch, &LeafBatch)> PairTest for TreePair<'_, V> {
    fn roots(&self) -> (Opening, u32) {
        let nodes = (Slot::ROOT.node(), Slot::ROOT.node());
        let opening = Opening { nodes, sides: Sides::Both, same_lane: 0, lanes: 0b0001 };
        (opening, self.leaves(&opening))
    }

    fn open(&self, pair: NodePair) -> (Opening, u32) {
        let opening = Opening::of(self.trees, pair);
        (opening, self.leaves(&opening))
    }

    fn visit(&mut self, pair: NodePair) {
        self.frame.counts.leaf_pairs += 1;
        if let Some((leaf1, leaf2)) = leaves_at(self.trees, pair) {
            (self.visit)(leaf1, leaf2);
        }
    }

    fn meeting(&mut self, opening: &Opening, lanes: u32) -> u32 {
        opening.compare(self.trees, lanes, &mut Overlap(self.frame)).0
    }
}
