//! The triangles that a descent hands on.

use std::collections::BTreeMap;

use glamx::{Pose3, Vec3};

use super::{CANDIDATES, Colour};
use crate::leaf::LeafTest;
use crate::traverse::{Descent, DescentScratch, PairFrame, Verdict, Visitor, descend};
use crate::tree::{LeafBatch, Tree};

/// Draws the candidates of a query: the triangles of two meshes, at these poses, that volumes and
/// leaf tests do not show to be farther apart than `margin`. Each once, as three lines.
///
/// ```
/// # use sbbk_core::tree::{BuildOptions, Tree};
/// # use glamx::{Pose3, Vec3};
/// # let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// # let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
/// let poses = [&Pose3::IDENTITY, &Pose3::translation(0.0, 0.0, 1.01)];
/// let mut lines = 0;
/// sbbk_core::draw::candidates((&tree, &tree), poses, 0.02, |_, _, _| lines += 1);
/// assert_eq!(lines, 3 * (3 + 3));
/// # Ok::<(), sbbk_core::tree::BuildError>(())
/// ```
pub fn candidates(
    trees: (&Tree, &Tree),
    poses: [&Pose3; 2],
    margin: f32,
    mut line: impl FnMut(Vec3, Vec3, Colour),
) {
    let mut frame = PairFrame::new(trees.0, trees.1, &poses[0].inv_mul(poses[1]), margin);
    let mut found = Candidates { test: LeafTest::new(&frame), sides: Default::default() };
    let scratch = &mut DescentScratch::default();
    descend(trees, &mut frame, Descent::Simultaneous, scratch, (), &mut found);
    for (side, triangles) in found.sides.into_iter().enumerate() {
        for corners in triangles.into_values() {
            let [a, b, c] = corners.map(|corner| poses[side] * corner);
            [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| line(a, b, CANDIDATES[side]));
        }
    }
}

struct Candidates {
    test: LeafTest,
    /// Corners by the numbers of triangles.
    sides: [BTreeMap<u32, [Vec3; 3]>; 2],
}

impl Visitor for Candidates {
    fn leaves(&mut self, _: u32, batch1: &LeafBatch, _: u32, batch2: &LeafBatch) -> Verdict {
        let [one, two] = &mut self.sides;
        self.test.survivors(batch1, batch2, |lane1, lane2| {
            one.insert(batch1.triangles()[lane1], batch1.corners(lane1));
            two.insert(batch2.triangles()[lane2], batch2.corners(lane2));
        });
        Verdict::Descend
    }
}
