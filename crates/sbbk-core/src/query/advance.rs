//! When two bodies on any paths first touch: conservative advancement.
//!
//! If no point of one body moves faster than `s` against the other, bodies that are `d` apart do
//! not touch before `d/s` has passed. Steps of that length approach the time of impact from below
//! (Mirtich, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 1996); the search ends
//! within the tolerance.

use crate::traverse::Placement;
use crate::tree::Tree;

use super::contacts::contacts;
use super::nearest::{Goal, nearest, search_besides};
use super::seek::SearchScratch;
use super::triangles::FoundPair;

/// Two bodies that consist of parts, at a placement of body 2 in the frame of body 1.
pub trait Bodies {
    /// A pair of parts.
    type Pair: PartPair;

    /// The nearest pair, but for those named in `besides`, in ascending order; if several touch, any
    /// of them. `None` if all are farther apart than `reach`, if that is NaN or negative, or if the
    /// placement is not finite.
    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        besides: &[[u32; 2]],
    ) -> Option<Self::Pair>;

    /// Calls `found` with all pairs that are at most `reach` apart.
    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(Self::Pair));

    /// A time, counted from `time`, in which no pair but those in `besides` meets. 0 if nothing but
    /// the distance of the nearest is known.
    fn clear_time(&mut self, _nearest: &Self::Pair, _time: f64, _besides: &[[u32; 2]]) -> f64 {
        0.0
    }
}

/// A pair of parts of two bodies.
pub trait PartPair: Copy {
    /// Their distance, or minus their depth.
    fn distance(&self) -> f64;

    /// The numbers of both parts.
    fn name(&self) -> [u32; 2];
}

/// Two meshes, with the memory to search them.
pub struct Meshes<'a> {
    /// The trees of mesh 1 and mesh 2.
    pub trees: (&'a Tree, &'a Tree),
    /// Memory of the search.
    pub scratch: &'a mut SearchScratch,
}

impl PartPair for FoundPair {
    fn distance(&self) -> f64 {
        self.contact.distance
    }

    fn name(&self) -> [u32; 2] {
        [self.triangle1, self.triangle2]
    }
}

impl Bodies for Meshes<'_> {
    type Pair = FoundPair;

    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        besides: &[[u32; 2]],
    ) -> Option<FoundPair> {
        let Self { trees, scratch } = self;
        if besides.is_empty() {
            return nearest(*trees, *placement, reach, scratch);
        }
        search_besides(*trees, *placement, reach, Goal::Nearest, besides, scratch).0
    }

    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(FoundPair)) {
        contacts(self.trees, *placement, reach, self.scratch, found);
    }
}

/// The span of time, and when to stop.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AdvanceOptions {
    /// The first time of interest.
    pub start: f64,
    /// The last one.
    pub end: f64,
    /// No point of one body moves faster than this against the other.
    pub speed_bound: f64,
    /// Bodies this close have met. Higher: fewer steps, earlier impacts.
    pub tolerance: f64,
    /// Steps at most. Motions along surfaces that never quite touch take many.
    pub step_limit: usize,
}

/// How an advancement ended.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Advance<P> {
    /// The time of impact, or a lower bound of it if the steps were used up.
    pub time: f64,
    /// The nearest pair then.
    pub pair: P,
    /// Where body 2 is in frame 1 then.
    pub placement: Placement,
    /// Whether the bodies are within the tolerance of each other then.
    pub has_converged: bool,
}

/// The first time at which body 2, at `placement_at(time)` in the frame of body 1, is within the
/// tolerance of it; `None` if there is no such time until the end, or if a number is not finite.
/// Bodies that are within the tolerance at the end, and would touch later, may have none.
pub fn advance<B: Bodies>(
    bodies: &mut B,
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
) -> Option<Advance<B::Pair>> {
    advance_besides(bodies, &[], placement_at, options)
}

/// The same but for pairs of parts, which are named in ascending order.
pub(super) fn advance_besides<B: Bodies>(
    bodies: &mut B,
    besides: &[[u32; 2]],
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
) -> Option<Advance<B::Pair>> {
    let AdvanceOptions { start, end, speed_bound, tolerance, step_limit } = options;
    let mut time = start;
    let mut last = None;
    for _ in 0..step_limit.max(1) {
        // Not "later than": a NaN is no time.
        let in_time = time <= end;
        if !in_time {
            return None;
        }
        // Bodies farther apart than they can travel until the end do not meet. No speed times a time
        // without end is NaN, of which `max` makes 0.
        let reach = (speed_bound * (end - time)).max(0.0) + tolerance;
        let placement = placement_at(time);
        let pair = bodies.nearest(&placement, reach, besides)?;
        let has_converged = pair.distance() <= tolerance;
        last = Some(Advance { time, pair, placement, has_converged });
        if has_converged {
            break;
        }
        let clear = pair.distance() / speed_bound;
        time += clear.max(bodies.clear_time(&pair, time, besides));
    }
    last
}
