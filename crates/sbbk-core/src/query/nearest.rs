//! The nearest or the deepest pair of triangles.
//!
//! Pairs of triangles of two parallel faces are equally near, and rounding in `f32` lowers their
//! bounds. Leaves and nodes are therefore compared along the normal of the nearest pair in `f64`
//! ([`Toward`]).

use glamx::{DVec3, Vec3};
use wide::f32x4;

use crate::contact::contact;
use crate::leaf::LeafTest;
use crate::simd::{Spread, dot};
use crate::traverse::{
    Compare, NodeLanes, NodePair, PairFrame, Placement, Toward, expand, leaves_at,
};
use crate::tree::{LeafBatch, Tree};

use super::seek::{BestNormal, FOUND, LowerBound, Pruned, SearchScratch, seek};
use super::triangles::{FoundPair, TrianglePair};

/// The pair of triangles to find.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// The nearest one. If several touch or cross, any of them.
    Nearest,
    /// The nearest one; if several touch or cross, the deepest.
    Deepest,
}

/// The nearest pair of triangles, mesh 2 placed at `placement` in the frame of mesh 1; if several
/// touch or cross, any of them. `None` if all pairs are farther apart than `limit`, if
/// that is negative, or if the placement is not finite.
///
/// Triangles touch up to 1e-12 of their size. With a limit of zero this is the test whether the
/// surfaces meet; [`meeting`](super::meeting()) is faster.
pub fn nearest(
    trees: (&Tree, &Tree),
    placement: Placement,
    limit: f64,
    scratch: &mut SearchScratch,
) -> Option<FoundPair> {
    search(trees, placement, limit, Goal::Nearest, &[], scratch).0
}

/// Like [`nearest`], but returns the deepest pair if several touch or cross.
pub fn deepest(
    trees: (&Tree, &Tree),
    placement: Placement,
    limit: f64,
    scratch: &mut SearchScratch,
) -> Option<FoundPair> {
    search(trees, placement, limit, Goal::Deepest, &[], scratch).0
}

/// Searches all pairs of triangles at most `best` apart, except those in `excluded`, which is
/// sorted. Returns the pair, and how many pairs of nodes and of triangles were compared.
pub(super) fn search(
    trees: (&Tree, &Tree),
    placement: Placement,
    best: f64,
    goal: Goal,
    excluded: &[[u32; 2]],
    scratch: &mut SearchScratch,
) -> (Option<FoundPair>, [u64; 2]) {
    // Unlike `best < 0`, this rejects NaN.
    let admits = best >= 0.0;
    if !admits || !placement.is_finite() {
        return (None, [0; 2]);
    }
    let mut frame = PairFrame::new(trees, placement, 0.0);
    let test = LeafTest::new(&frame);
    // Bounds are f32 too: no bound of a nearer pair is above the limit, rounded to nearest.
    let gaps = &mut Gaps { frame: &mut frame, bound: SignedGaps, limit: best as f32, normal: None };
    let mut search =
        NearestSearch { trees, placement, test, goal, excluded, best, found: None, count: 0 };
    // A limit of zero cannot be lowered: the search ends with the first pair that meets.
    if best > 0.0 {
        let (leaf1, leaf2) = near_leaves(trees, gaps.frame);
        search.leaves(gaps, leaf1, leaf2);
    }
    seek(trees, gaps, scratch, |gaps, leaf1, leaf2| search.leaves(gaps, leaf1, leaf2));
    (search.found, [gaps.frame.counts.aabb_tests, search.count])
}

/// The signed distance of nodes, negative where their volumes overlap.
struct SignedGaps;

type Gaps<'a> = Pruned<'a, SignedGaps>;

impl LowerBound for SignedGaps {
    #[inline(always)]
    fn of(&self, frame: &mut PairFrame, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> f32x4 {
        frame.signed_gaps(nodes)
    }
}

struct NearestSearch<'a> {
    trees: (&'a Tree, &'a Tree),
    placement: Placement,
    test: LeafTest,
    goal: Goal,
    /// Pairs of triangles that do not count, in ascending order.
    excluded: &'a [[u32; 2]],
    /// The signed distance to beat.
    best: f64,
    found: Option<FoundPair>,
    /// Number of pairs of triangles whose contact was computed.
    count: u64,
}

impl NearestSearch<'_> {
    fn triangles(&mut self, gaps: &mut Gaps<'_>, one: (u32, [Vec3; 3]), two: (u32, [Vec3; 3])) {
        if gaps.limit == FOUND {
            return;
        }
        let indices = [one.0, two.0];
        if !self.excluded.is_empty() && self.excluded.binary_search(&indices).is_ok() {
            return;
        }
        self.count += 1;
        let pair = TrianglePair::new(&self.placement, one.1, two.1);
        let touching = pair.touching_distance();
        let margin = if self.best >= 0.0 { self.best.max(touching) } else { self.best };
        let [t1, t2] = &pair.corners;
        let Some(contact) = contact(t1, t2, margin) else {
            return;
        };
        if self.found.is_some() && contact.distance >= self.best {
            return;
        }
        self.found = Some(FoundPair::new(indices, &pair, contact));
        self.best = contact.distance;
        let is_last = self.goal == Goal::Nearest && contact.distance <= touching;
        gaps.limit = if is_last { FOUND } else { contact.distance as f32 };
        self.look_along(gaps, contact.normal);
    }

    /// Looks along the normal of the best pair from now on. Rare, and long: kept out of the way.
    #[inline(never)]
    fn look_along(&self, gaps: &mut Gaps<'_>, normal: DVec3) {
        // The normal of crossing triangles tells nothing about other pairs.
        let toward = Toward::new(gaps.frame, normal, self.best).filter(|_| self.best > 0.0);
        gaps.normal = toward.map(|toward| BestNormal { toward, target: 0.0, scale: 1.0 });
        if gaps.are_meshes_beyond(self.trees) {
            gaps.limit = FOUND;
        }
    }

    fn leaves(&mut self, gaps: &mut Gaps<'_>, batch1: &LeafBatch, batch2: &LeafBatch) {
        if gaps.are_leaves_beyond(batch1, batch2) {
            return;
        }
        let test = self.test.within(gaps.limit);
        // The axis of far triangles tells nothing about those that touch.
        let is_far = self.best > 0.0;
        let found = |lane1, lane2| {
            self.triangles(gaps, batch1.triangle(lane1), batch2.triangle(lane2));
        };
        if is_far {
            test.far_survivors(batch1, batch2, found);
        } else {
            test.survivors(batch1, batch2, found);
        }
    }
}

/// Returns a pair of leaves that is probably near the answer. Goes down both trees to the children
/// whose centres are nearest to each other. A search prunes by the best pair of triangles so far,
/// so an early good one is worth most.
fn near_leaves<'a>(
    trees: (&'a Tree, &'a Tree),
    frame: &PairFrame,
) -> (&'a LeafBatch, &'a LeafBatch) {
    let mut next = NodePair::ROOTS;
    loop {
        if let Some(leaves) = leaves_at(trees, next) {
            return leaves;
        }
        let mut nearest = f32::INFINITY;
        let pair = next;
        expand(trees, pair, &mut Centres(frame), |children, squared| {
            // The first one even if all are NaN.
            if next == pair || squared < nearest {
                (next, nearest) = (children, squared);
            }
        });
    }
}

/// Compares nodes by the squared distance of their centres.
struct Centres<'a>(&'a PairFrame);

impl Compare for Centres<'_> {
    #[inline(always)]
    fn compare(&mut self, nodes: &NodeLanes<'_, impl Spread, impl Spread>) -> (u32, [f32; 4]) {
        let offset = self.0.along1(nodes, f32x4::ZERO).offset;
        (nodes.lanes, dot(offset, offset).to_array())
    }
}

#[cfg(test)]
mod tests {
    use glamx::Pose3;

    use super::*;
    use crate::support::{Random, bumpy_ball};

    /// The meshes have 16 million pairs of triangles.
    #[test]
    fn searches_of_large_meshes_test_few_pairs() {
        let ball = bumpy_ball(32, 0.1);
        let tree = Tree::build(&ball.vertices, &ball.triangles, None).unwrap();
        let mut random = Random(7);
        let mut scratch = SearchScratch::default();
        for (distance, limit, goal) in [
            (2.3, f64::INFINITY, Goal::Nearest),
            (6.0, f64::INFINITY, Goal::Nearest),
            (1.0, f64::INFINITY, Goal::Nearest),
            (2.3, 0.0, Goal::Nearest),
            (1.9, 0.0, Goal::Deepest),
        ] {
            for _ in 0..20 {
                let direction = random.vector(1.0).normalize();
                let pose = Pose3::from_parts(distance * direction, random.rotation());
                let placement = Placement::new(&pose);
                let (_, counts) = search((&tree, &tree), placement, limit, goal, &[], &mut scratch);
                assert!(counts[0] < 8000 && counts[1] < 600, "{counts:?} at {distance}");
            }
        }
    }

    /// Planes of 8192 and 32,768 triangles over each other, flat and tilted, without and with a
    /// wall beside them. Would catch comparisons of all pairs that are equally near.
    #[test]
    fn few_pairs_of_parallel_faces_are_compared() {
        // All coordinates are exact.
        let plane = |cells: u32, size: f32, slope: f32, wall: bool| -> Tree {
            let at = |i: u32| size * (i as f32 / cells as f32 - 0.5);
            let places = (0..=cells).flat_map(|i| (0..=cells).map(move |j| [at(i), at(j)]));
            let vertices = places.map(|[x, z]| Vec3::new(x, slope * (x + 0.5 * z), z));
            let walls = [[2.0, -3.0, 0.0], [2.0, 3.0, 0.0], [2.0, -3.0, 1.0]].map(Vec3::from_array);
            let all: Vec<_> = vertices.chain(walls).collect();
            let corners = (0..cells).flat_map(|i| (0..cells).map(move |j| i * (cells + 1) + j));
            let cell = |a: u32| [[a, a + 1, a + cells + 1], [a + 1, a + cells + 2, a + cells + 1]];
            let mut triangles: Vec<_> = corners.flat_map(cell).collect();
            let first = all.len() as u32 - 3;
            triangles.extend(wall.then_some([first, first + 1, first + 2]));
            Tree::build(&all, &triangles, None).unwrap()
        };
        let mut scratch = SearchScratch::default();
        for (slope, wall, most) in
            [(0.0, false, 0), (0.0, true, 4000), (0.5, false, 60_000), (0.5, true, 60_000)]
        {
            let (large, small) = (plane(128, 2.0, slope, wall), plane(64, 0.5, slope, false));
            let normal = Vec3::new(-slope, 1.0, -0.5 * slope).normalize();
            for (trees, offset) in [((&large, &small), 1.4), ((&small, &large), -1.4)] {
                let placement =
                    Placement::new(&Pose3 { translation: offset * normal, ..Pose3::IDENTITY });
                let (found, counts) =
                    search(trees, placement, f64::INFINITY, Goal::Nearest, &[], &mut scratch);
                let distance = found.unwrap().contact.distance;
                assert!((distance - 1.4).abs() < 1e-6, "{distance}");
                assert!(counts[0] <= most && counts[1] < 64, "{counts:?} for {slope}, {wall}");
            }
        }
    }
}
