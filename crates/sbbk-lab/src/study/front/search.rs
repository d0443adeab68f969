//! One variant at work on one pair of equal meshes.

use std::mem::take;

use glamx::Pose3;
use sbbk_core::contact::contact;
use sbbk_core::front::{Front, FrontOptions};
use sbbk_core::leaf::LeafTest;
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::{
    Counters, Descent, DescentScratch, PairFrame, Placement, Slack, SlackLimits, SlackPlan,
    Verdict, Visitor, descend,
};
use sbbk_core::tree::{LeafBatch, Tree};

named! {
    /// A way to find the pairs of a step after those of the step before.
    pub(super) enum Variant {
        /// A descent from the roots at each query.
        Fresh = "fresh descent",
        /// The front of the paper.
        Paper = "front of the paper",
        /// The default front: with a bound of the motion, and fresh descents where they are cheaper.
        Adaptive = "adaptive front",
        /// The dispatcher's way, without a front: descents look farther by a slack, and what they find
        /// serves until it is used up.
        Slack = "slack, as the dispatcher",
    }
}

/// What a variant remembers, and its answers.
pub(super) struct Search<'a> {
    tree: &'a Tree,
    prediction: f32,
    front: Option<Front>,
    slack: Option<Slack>,
    scratch: DescentScratch,
    leaf_pairs: Vec<[u32; 2]>,
    candidates: Vec<Candidate>,
    /// Pairs of triangles within the prediction distance, in no order.
    pub pairs: Vec<(u32, u32)>,
}

/// Two triangles: leaves and lanes, and how far apart they were at the last descent.
#[derive(Clone, Copy)]
struct Candidate {
    leaves: [u32; 2],
    lanes: [usize; 2],
    distance: f64,
}

impl<'a> Search<'a> {
    pub fn new(variant: Variant, tree: &'a Tree, prediction: f32) -> Self {
        Self {
            tree,
            prediction,
            front: match variant {
                Variant::Paper => Some(Front::new(FrontOptions::Paper)),
                Variant::Adaptive => Some(Front::new(FrontOptions::Adaptive)),
                Variant::Fresh | Variant::Slack => None,
            },
            slack: (variant == Variant::Slack).then(Slack::default),
            scratch: DescentScratch::default(),
            leaf_pairs: Vec::new(),
            candidates: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// How many queries were answered from a front that was there.
    pub fn reused(&self) -> Option<u64> {
        Some(self.front.as_ref()?.stats().reused)
    }

    fn plan(&mut self, placement: &Placement) -> SlackPlan {
        let Self { tree, prediction, .. } = *self;
        match &mut self.slack {
            Some(slack) => {
                slack.plan(tree.bounding_ball(), placement, prediction, SlackLimits::TRIANGLES)
            }
            None => SlackPlan::Descend { margin: prediction, travel: 0.0 },
        }
    }

    fn descend(&mut self, frame: &mut PairFrame, counters: impl Counters, to: &mut impl Visitor) {
        let (trees, scratch) = ((self.tree, self.tree), &mut self.scratch);
        match &mut self.front {
            Some(front) => front.visit(trees, frame, scratch, counters, to),
            None => descend(trees, frame, Descent::Simultaneous, scratch, counters, to),
        }
    }

    /// Finds the pairs of leaves; how many there are.
    pub fn traverse(&mut self, pos12: &Pose3, counters: impl Counters) -> usize {
        let placement = Placement::new(pos12);
        if let SlackPlan::Descend { margin, .. } = self.plan(&placement) {
            let mut frame = PairFrame::at((self.tree, self.tree), placement, margin);
            let mut collected = Collected(take(&mut self.leaf_pairs));
            collected.0.clear();
            self.descend(&mut frame, counters, &mut collected);
            self.leaf_pairs = collected.0;
        }
        self.leaf_pairs.len()
    }

    /// Finds the pairs of triangles within the prediction distance.
    pub fn query(&mut self, pos12: &Pose3) {
        let placement = Placement::new(pos12);
        let mut tested = Tested {
            placement,
            prediction: f64::from(self.prediction),
            margin: f64::from(self.prediction),
            test: None,
            candidates: take(&mut self.candidates),
            pairs: take(&mut self.pairs),
        };
        tested.pairs.clear();
        match self.plan(&placement) {
            SlackPlan::Reuse { reach, .. } => {
                let candidates = tested.candidates.iter().filter(|c| c.distance <= reach);
                for Candidate { leaves, lanes, .. } in candidates {
                    let batches = leaves.map(|leaf| self.tree.leaf(leaf));
                    if distance(&placement, batches, *lanes, tested.margin).is_some() {
                        tested.pairs.push(triangles(batches, *lanes));
                    }
                }
            }
            SlackPlan::Descend { margin, .. } => {
                let mut frame = PairFrame::at((self.tree, self.tree), placement, margin);
                tested.margin = f64::from(margin);
                tested.test = Some(LeafTest::new(&frame));
                tested.candidates.clear();
                self.descend(&mut frame, (), &mut tested);
            }
        }
        (self.candidates, self.pairs) = (tested.candidates, tested.pairs);
    }
}

/// The distance of two triangles, if it is at most `margin`.
#[inline]
fn distance(
    placement: &Placement,
    [batch1, batch2]: [&LeafBatch; 2],
    [lane1, lane2]: [usize; 2],
    margin: f64,
) -> Option<f64> {
    let pair = TrianglePair::new(placement, batch1.corners(lane1), batch2.corners(lane2));
    let [t1, t2] = &pair.corners;
    contact(t1, t2, margin).map(|contact| contact.distance)
}

fn triangles(batches: [&LeafBatch; 2], lanes: [usize; 2]) -> (u32, u32) {
    (batches[0].triangles()[lanes[0]], batches[1].triangles()[lanes[1]])
}

struct Collected(Vec<[u32; 2]>);

impl Visitor for Collected {
    #[inline]
    fn leaves(&mut self, leaf1: u32, _: &LeafBatch, leaf2: u32, _: &LeafBatch) -> Verdict {
        self.0.push([leaf1, leaf2]);
        Verdict::Descend
    }
}

/// Tests the triangles of leaves, first in f32 over lanes, then exactly.
struct Tested {
    placement: Placement,
    prediction: f64,
    margin: f64,
    test: Option<LeafTest>,
    candidates: Vec<Candidate>,
    pairs: Vec<(u32, u32)>,
}

impl Visitor for Tested {
    #[inline]
    fn leaves(&mut self, l1: u32, batch1: &LeafBatch, l2: u32, batch2: &LeafBatch) -> Verdict {
        let Self { placement, prediction, margin, test, candidates, pairs } = self;
        let Some(test) = test else { return Verdict::Prune };
        test.survivors(batch1, batch2, |lane1, lane2| {
            let (batches, lanes) = ([batch1, batch2], [lane1, lane2]);
            let Some(distance) = distance(placement, batches, lanes, *margin) else { return };
            if margin > prediction {
                candidates.push(Candidate { leaves: [l1, l2], lanes, distance });
            }
            if distance <= *prediction {
                pairs.push(triangles(batches, lanes));
            }
        });
        Verdict::Descend
    }
}
