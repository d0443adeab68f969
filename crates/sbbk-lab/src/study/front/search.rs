//! One variant at work on one pair.

use glamx::Pose3;
use sbbk_core::contact::contact;
use sbbk_core::front::Front;
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{
    Counters, Descent, DescentScratch, GREATEST_SLACK, PairFrame, Placement, Slack, SlackPlan,
    Verdict, Visitor, descend,
};
use sbbk_core::tree::{LeafBatch, Tree};

use super::variant::Variant;

/// What a variant remembers of a pair of equal meshes, and its answers.
pub(super) struct Search {
    front: Option<Front>,
    slack: Option<Slack>,
    scratch: DescentScratch,
    /// Pairs of leaves of the last descent.
    pub leaf_pairs: Vec<(u32, u32)>,
    /// Pairs of triangles of the last descent: leaves and lanes, and how far apart they were.
    known: Vec<Known>,
    /// Pairs of triangles within the prediction distance, in no order.
    pub pairs: Vec<(u32, u32)>,
}

#[derive(Clone, Copy)]
struct Known {
    places: [(u32, u32); 2],
    distance: f64,
}

impl Search {
    pub fn new(variant: Variant) -> Self {
        Self {
            front: variant.front(),
            slack: variant.has_slack().then(Slack::default),
            scratch: DescentScratch::default(),
            leaf_pairs: Vec::new(),
            known: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// The front, if it has one.
    pub fn front(&self) -> Option<&Front> {
        self.front.as_ref()
    }

    fn plan(&mut self, tree: &Tree, placement: &Placement, prediction: f32) -> SlackPlan {
        match &mut self.slack {
            Some(slack) => slack.plan(tree.bounding_ball(), placement, prediction, GREATEST_SLACK),
            None => SlackPlan::Descend { margin: prediction },
        }
    }

    fn visit(
        &mut self,
        tree: &Tree,
        frame: &mut PairFrame,
        counters: impl Counters,
        visitor: &mut impl Visitor,
    ) {
        let (trees, scratch) = ((tree, tree), &mut self.scratch);
        match &mut self.front {
            Some(front) => front.visit(trees, frame, scratch, counters, visitor),
            None => descend(trees, frame, Descent::Simultaneous, scratch, counters, visitor),
        }
    }

    /// Finds the pairs of leaves.
    pub fn traverse(
        &mut self,
        tree: &Tree,
        pos12: &Pose3,
        prediction: f32,
        counters: impl Counters,
    ) {
        let placement = Placement::new(pos12);
        if let SlackPlan::Descend { margin } = self.plan(tree, &placement, prediction) {
            let mut frame = PairFrame::at((tree, tree), placement, margin);
            let mut collected = Collected(std::mem::take(&mut self.leaf_pairs));
            collected.0.clear();
            self.visit(tree, &mut frame, counters, &mut collected);
            self.leaf_pairs = collected.0;
        }
    }

    /// Finds the pairs of triangles within the prediction distance.
    pub fn query(&mut self, tree: &Tree, pos12: &Pose3, prediction: f32, counters: impl Counters) {
        self.pairs.clear();
        let placement = Placement::new(pos12);
        match self.plan(tree, &placement, prediction) {
            SlackPlan::Reuse { reach, .. } => {
                for known in self.known.iter().filter(|known| known.distance <= reach) {
                    let [(leaf1, lane1), (leaf2, lane2)] = known.places;
                    let batches = [tree.leaf(leaf1), tree.leaf(leaf2)];
                    let lanes = [lane1 as usize, lane2 as usize];
                    let distance = distance(&placement, batches, lanes, f64::from(prediction));
                    if distance.is_some() {
                        self.pairs.push((
                            batches[0].triangles()[lanes[0]],
                            batches[1].triangles()[lanes[1]],
                        ));
                    }
                }
            }
            SlackPlan::Descend { margin } => {
                let mut frame = PairFrame::at((tree, tree), placement, margin);
                let mut tested = Tested {
                    test: LeafTest::new(&frame),
                    placement,
                    margin: f64::from(margin),
                    prediction: f64::from(prediction),
                    keeps: self.slack.is_some(),
                    known: std::mem::take(&mut self.known),
                    pairs: std::mem::take(&mut self.pairs),
                };
                tested.known.clear();
                self.visit(tree, &mut frame, counters, &mut tested);
                (self.known, self.pairs) = (tested.known, tested.pairs);
            }
        }
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
    let corners1 = batch1.corners(lane1);
    let origin = corners1[0];
    let t1 = corners1.map(|x| (x - origin).as_dvec3());
    let t2 = batch2.corners(lane2).map(|x| placement.to_frame1(x, origin));
    contact(&t1, &t2, margin).map(|contact| contact.distance)
}

struct Collected(Vec<(u32, u32)>);

impl Visitor for Collected {
    #[inline]
    fn leaves(&mut self, leaf1: u32, _: &LeafBatch, leaf2: u32, _: &LeafBatch) -> Verdict {
        self.0.push((leaf1, leaf2));
        Verdict::Descend
    }
}

/// Tests the triangles of leaves, first in f32 over lanes, then exactly.
struct Tested {
    test: LeafTest,
    placement: Placement,
    margin: f64,
    prediction: f64,
    keeps: bool,
    known: Vec<Known>,
    pairs: Vec<(u32, u32)>,
}

impl Visitor for Tested {
    #[inline]
    fn leaves(
        &mut self,
        leaf1: u32,
        batch1: &LeafBatch,
        leaf2: u32,
        batch2: &LeafBatch,
    ) -> Verdict {
        let Self { test, placement, margin, prediction, keeps, known, pairs } = self;
        test.survivors(batch1, batch2, |lane1, lane2| {
            let Some(distance) = distance(placement, [batch1, batch2], [lane1, lane2], *margin)
            else {
                return;
            };
            if *keeps {
                let places = [(leaf1, lane1 as u32), (leaf2, lane2 as u32)];
                known.push(Known { places, distance });
            }
            if distance <= *prediction {
                pairs.push((batch1.triangles()[lane1], batch2.triangles()[lane2]));
            }
        });
        Verdict::Descend
    }
}
