use sbbk_core::contact::FeaturePair;
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{
    Counters, Descent, DescentScratch, PairFrame, Verdict, Visitor, descend,
};
use sbbk_core::tree::LeafBatch;

use crate::mesh::PreparedMesh;

/// A pair of triangles, by index in their meshes, that may come within the prediction distance.
#[derive(Copy, Clone, Debug)]
pub(super) struct Candidate {
    pub(super) key: OrderKey,
    pub(super) triangle1: u32,
    pub(super) triangle2: u32,
    /// What was closest when this was last known, to be tried first.
    pub(super) features: Option<FeaturePair>,
    /// Place among the candidates that the pair keeps.
    pub(super) place: u32,
}

impl Candidate {
    /// Found just now.
    pub(super) fn new(key: OrderKey, [triangle1, triangle2]: [u32; 2]) -> Self {
        Self { key, triangle1, triangle2, features: None, place: u32::MAX }
    }
}

/// The place of a pair of triangles in the order of stock manifolds.
///
/// Parry walks the hierarchy of the mesh with the larger box and, for each triangle there, the hierarchy of the other. The
/// order of ours depends on the two meshes only: not on the descent, a thread, or what happened before.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct OrderKey(u64);

impl OrderKey {
    /// Behind all others.
    pub(super) const LAST: Self = Self(u64::MAX);

    pub(super) fn new(
        prepared: [&PreparedMesh; 2],
        flipped: bool,
        [triangle1, triangle2]: [u32; 2],
    ) -> Self {
        let ranks = [prepared[0].rank(triangle1), prepared[1].rank(triangle2)];
        Self::of_ranks(if flipped { [ranks[1], ranks[0]] } else { ranks })
    }

    /// Of a pair with these places in the orders of the shape walked first and the other.
    pub(super) fn of_ranks([major, minor]: [u32; 2]) -> Self {
        Self(u64::from(major) << 32 | u64::from(minor))
    }

    /// Of one triangle, whatever the other shape is: stock walks the hierarchy of the mesh.
    pub(super) fn of_triangle(prepared: &PreparedMesh, triangle: u32) -> Self {
        Self(u64::from(prepared.rank(triangle)))
    }
}

/// Memory of one query, kept by each thread: after the first few queries none allocates here.
#[derive(Default)]
pub(crate) struct Scratch {
    descent: DescentScratch,
    pub(super) candidates: Vec<Candidate>,
    /// Places of the previous manifolds, in stock order.
    pub(super) previous: Vec<(OrderKey, u32)>,
}

/// Fills `scratch.candidates` with all pairs of triangles within the margin of `frame`, and few others, in stock order.
pub(super) fn collect(
    prepared: [&PreparedMesh; 2],
    frame: &mut PairFrame,
    flipped: bool,
    counters: impl Counters,
    scratch: &mut Scratch,
) {
    scratch.candidates.clear();
    let mut collector = Collector {
        prepared,
        flipped,
        test: LeafTest::new(frame),
        candidates: &mut scratch.candidates,
    };
    let trees = (&prepared[0].tree, &prepared[1].tree);
    descend(trees, frame, Descent::Simultaneous, &mut scratch.descent, counters, &mut collector);
    scratch.candidates.sort_unstable_by_key(|candidate| candidate.key);
}

struct Collector<'a> {
    prepared: [&'a PreparedMesh; 2],
    flipped: bool,
    test: LeafTest,
    candidates: &'a mut Vec<Candidate>,
}

impl Visitor for Collector<'_> {
    #[inline]
    fn leaves(&mut self, _: u32, batch1: &LeafBatch, _: u32, batch2: &LeafBatch) -> Verdict {
        self.test.survivors(batch1, batch2, |lane1, lane2| {
            let [triangle1, triangle2] = [batch1.triangles()[lane1], batch2.triangles()[lane2]];
            let [prepared1, prepared2] = self.prepared;
            if prepared1.is_broken(triangle1) || prepared2.is_broken(triangle2) {
                return;
            }
            let key = OrderKey::new(self.prepared, self.flipped, [triangle1, triangle2]);
            self.candidates.push(Candidate::new(key, [triangle1, triangle2]));
        });
        Verdict::Descend
    }
}
