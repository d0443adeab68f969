//! When two meshes on any paths touch, not counting what they touch already and are about to leave.
//!
//! A pair of triangles that touches at the start is an impact then if it approaches: if its velocities along the normal of the
//! contact deepen it. Otherwise it is left out for good, and the others are advanced to their first touch (`advance.rs`). So this
//! is an answer about pairs of triangles, not about bodies: where a mesh that sinks into another is pulled out again, triangles
//! that did not touch before can be met on the way.
//!
//! The pairs at the start come from one descent. They keep overlapping in each step of the search, so a start deep inside
//! makes all steps as dear as a query for all contacts.

use crate::contact::contact;
use crate::leaf::LeafTest;
use crate::traverse::{Descent, DescentScratch, PairFrame, Placement, Verdict, Visitor, descend};
use crate::tree::{LeafBatch, Tree};
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

use super::advance::{Advance, AdvanceOptions, advance_by};
use super::nearest::{Goal, nearest_besides};
use super::seek::SearchScratch;
use super::triangles::{FoundPair, LocalPair};

/// The first impact of two meshes that may touch at the start, as of [`advance`](fn@super::advance) but for the pairs of triangles
/// within the tolerance of each other at the start. Of these, those that `approaches` says are impacts at the start; the deepest
/// one is returned. The others do not count, whatever becomes of them.
///
/// `None` if there is no impact until the end, or if a number is not finite. Allocates lists of the pairs that touch at the
/// start.
pub fn advance_from_contact<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
    approaches: impl Fn(&FoundPair, &Placement) -> bool,
    scratch: &mut SearchScratch,
) -> Option<Advance>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    // Not "later than": a NaN is no time.
    let is_possible = options.start <= options.end;
    if !is_possible {
        return None;
    }
    let placement = placement_at(options.start);
    let touching = touching(trees, placement, options.tolerance);
    let depth = |one: &&FoundPair, two: &&FoundPair| {
        let of = |pair: &FoundPair| (pair.contact.distance, [pair.triangle1, pair.triangle2]);
        let ((depth1, triangles1), (depth2, triangles2)) = (of(one), of(two));
        depth1.total_cmp(&depth2).then(triangles1.cmp(&triangles2))
    };
    let impacts = touching.iter().filter(|pair| approaches(pair, &placement));
    if let Some(&pair) = impacts.min_by(depth) {
        return Some(Advance { time: options.start, pair, placement, has_converged: true });
    }
    let mut besides: Vec<[u32; 2]> =
        touching.iter().map(|pair| [pair.triangle1, pair.triangle2]).collect();
    besides.sort_unstable();
    advance_by(placement_at, options, |placement, reach| {
        nearest_besides(trees, placement, reach, Goal::Nearest, &besides, scratch).0
    })
}

/// All pairs of triangles within a distance, of zero or more; none at a pose that is not finite.
fn touching<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement: Placement,
    distance: f64,
) -> Vec<FoundPair>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    if !placement.is_finite() {
        return Vec::new();
    }
    let margin = distance as f32 * (1.0 + gamma(4)) + f32::MIN_POSITIVE;
    let mut frame = PairFrame::at(trees, placement, margin);
    let mut collector =
        Collector { test: LeafTest::new(&frame), placement, distance, found: Vec::new() };
    let scratch = &mut DescentScratch::default();
    descend(trees, &mut frame, Descent::Simultaneous, scratch, (), &mut collector);
    collector.found
}

struct Collector {
    test: LeafTest,
    placement: Placement,
    distance: f64,
    found: Vec<FoundPair>,
}

impl Visitor for Collector {
    fn leaves(&mut self, _: u32, batch1: &LeafBatch, _: u32, batch2: &LeafBatch) -> Verdict {
        self.test.survivors(batch1, batch2, |lane1, lane2| {
            let pair = LocalPair::new(&self.placement, (batch1, lane1), (batch2, lane2));
            let [t1, t2] = &pair.corners;
            let touching = pair.touching_distance();
            if let Some(contact) = contact(t1, t2, self.distance.max(touching)) {
                let is_touching = contact.distance <= touching;
                let [triangle1, triangle2] = [batch1.triangles()[lane1], batch2.triangles()[lane2]];
                let origin = pair.origin;
                self.found.push(FoundPair { triangle1, triangle2, contact, origin, is_touching });
            }
        });
        Verdict::Descend
    }
}
