//! When two meshes on any paths first touch: conservative advancement.
//!
//! If no point of one mesh moves faster than `s` against the other, meshes that are `d` apart do
//! not touch before `d/s` has passed. Steps of that length approach the time of impact from below
//! (Mirtich, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 1996); the search ends
//! within the tolerance.

use crate::traverse::Placement;
use crate::tree::Tree;
use crate::volumes::{DirectionSet, Directions};

use super::nearest::nearest;
use super::seek::SearchScratch;
use super::triangles::FoundPair;

/// The span of time, and when to stop.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AdvanceOptions {
    /// The first time of interest.
    pub start: f64,
    /// The last one.
    pub end: f64,
    /// No point of one mesh moves faster than this against the other.
    pub speed_bound: f64,
    /// Meshes this close have met. Higher: fewer steps, earlier impacts.
    pub tolerance: f64,
    /// Steps at most. Motions along surfaces that never quite touch take many.
    pub step_limit: usize,
}

/// How an advancement ended.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Advance {
    /// The time of impact, or a lower bound of it if the steps were used up.
    pub time: f64,
    /// The nearest triangles then.
    pub pair: FoundPair,
    /// Where mesh 2 is in frame 1 then.
    pub placement: Placement,
    /// Whether the meshes are within the tolerance of each other then.
    pub has_converged: bool,
}

/// The first time at which mesh 2, at `placement_at(time)` in the frame of mesh 1, is within the
/// tolerance of it; `None` if there is no such time until the end, or if a number is not finite.
/// Meshes that are within the tolerance at the end, and would touch later, may have none.
pub fn advance<const AXES: usize>(
    trees: (&Tree<AXES>, &Tree<AXES>),
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
    scratch: &mut SearchScratch,
) -> Option<Advance>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    advance_by(placement_at, options, |placement, reach| nearest(trees, placement, reach, scratch))
}

/// The same with the nearest pair up to a distance from `nearest`.
pub(super) fn advance_by(
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
    mut nearest: impl FnMut(Placement, f64) -> Option<FoundPair>,
) -> Option<Advance> {
    let AdvanceOptions { start, end, speed_bound, tolerance, step_limit } = options;
    let mut time = start;
    let mut last = None;
    for _ in 0..step_limit.max(1) {
        // Beyond what can be travelled until the end nothing matters.
        let reach = speed_bound * (end - time) + tolerance;
        let placement = placement_at(time);
        let pair = nearest(placement, reach)?;
        let distance = pair.contact.distance;
        let has_converged = distance <= tolerance;
        last = Some(Advance { time, pair, placement, has_converged });
        if has_converged {
            break;
        }
        time += distance / speed_bound;
        // Not "later than": a NaN is no time.
        let in_time = time <= end;
        if !in_time {
            return None;
        }
    }
    last
}
