//! The first touch of two bodies on any paths, by conservative advancement.
//!
//! If no point of one body moves faster than `s` against the other, bodies that are `d` apart do
//! not touch before `d/s` has passed. A step of `d/s` ends before the impact. Source:
//! Mirtich, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 1996.
//!
//! Bodies may touch at the start ([`advance_from_contact`]). A pair of parts that touches is an
//! impact if it approaches along the normal of the contact. The search excludes other such pairs
//! for good and advances to the first touch of the rest. A start deep inside makes each step as
//! expensive as a query for all contacts.

use crate::traverse::Placement;
use crate::tree::Tree;

use super::contacts::contacts;
use super::nearest::{Goal, search};
use super::seek::SearchScratch;
use super::triangles::FoundPair;

/// Two bodies that consist of parts, at a placement of body 2 in the frame of body 1.
pub trait Bodies {
    /// A pair of parts.
    type Pair: PartPair;

    /// Returns the nearest pair, or any of several that touch. `excluded` lists pairs to skip, in
    /// ascending order. `None` if all are farther apart than `reach`, if that is NaN or negative,
    /// or if the placement is not finite.
    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        excluded: &[[u32; 2]],
    ) -> Option<Self::Pair>;

    /// Calls `found` with all pairs that are at most `reach` apart.
    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(Self::Pair));

    /// Returns a time, counted from `time`, in which no pair meets. 0 if only the distance of the
    /// nearest pair is known.
    fn clear_time(&mut self, _nearest: &Self::Pair, _time: f64) -> f64 {
        0.0
    }
}

/// A pair of parts of two bodies.
pub trait PartPair: Copy {
    /// The distance, or minus the depth.
    fn distance(&self) -> f64;

    /// Indices of both parts.
    fn name(&self) -> [u32; 2];
}

/// Two meshes, with the memory to search them.
pub struct MeshBodies<'a> {
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

impl Bodies for MeshBodies<'_> {
    type Pair = FoundPair;

    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        excluded: &[[u32; 2]],
    ) -> Option<FoundPair> {
        let Self { trees, scratch } = self;
        search(*trees, *placement, reach, Goal::Nearest, excluded, scratch).0
    }

    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(FoundPair)) {
        contacts(self.trees, *placement, reach, self.scratch, found);
    }
}

/// Limits of an advancement.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AdvanceOptions {
    /// The first time of interest.
    pub start: f64,
    /// The last time of interest.
    pub end: f64,
    /// Bound of the speed of any point of one body against the other.
    pub speed_bound: f64,
    /// Distance up to which bodies have met. Higher: fewer steps, earlier impacts.
    pub tolerance: f64,
    /// Limit of steps. Motions along surfaces that never quite touch take many.
    pub step_limit: usize,
}

/// The end of an advancement.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Advance<P> {
    /// The time of impact, or a lower bound of it if the steps were used up.
    pub time: f64,
    /// The nearest pair at that time.
    pub pair: P,
    /// Placement of body 2 in frame 1 at that time.
    pub placement: Placement,
    /// True if the bodies are within the tolerance of each other at that time.
    pub has_converged: bool,
}

/// Returns the first time at which body 2, at `placement_at(time)` in the frame of body 1, is
/// within the tolerance of body 1.
///
/// Bodies that may meet before the next f64 after a time have met at that time. `None` if there is
/// no such time until the end, or if a number is not finite. Bodies that are within the tolerance
/// at the end, and would touch later, may have none. `excluded` lists pairs to skip, in ascending
/// order.
pub fn advance<B: Bodies>(
    bodies: &mut B,
    excluded: &[[u32; 2]],
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
) -> Option<Advance<B::Pair>> {
    let AdvanceOptions { start, end, speed_bound, tolerance, step_limit } = options;
    let mut time = start;
    let mut last = None;
    for _ in 0..step_limit.max(1) {
        // Unlike "time > end", this rejects a NaN.
        let in_time = time <= end;
        if !in_time {
            return None;
        }
        // Bodies farther apart than they can travel until the end do not meet. Zero speed times an
        // infinite time is NaN, which `max` replaces by 0.
        let reach = (speed_bound * (end - time)).max(0.0) + tolerance;
        let placement = placement_at(time);
        let pair = bodies.nearest(&placement, reach, excluded)?;
        let found = Advance { time, pair, placement, has_converged: pair.distance() <= tolerance };
        if found.has_converged {
            return Some(found);
        }
        let clear = (pair.distance() / speed_bound).max(bodies.clear_time(&pair, time));
        if clear == f64::INFINITY {
            return None;
        }
        if time + clear <= time {
            // An infinite speed bounds nothing.
            return Some(Advance { has_converged: speed_bound.is_finite(), ..found });
        }
        (time, last) = (time + clear, Some(found));
    }
    last
}

/// Returns the first impact of two bodies that may touch at the start.
///
/// Pairs within the tolerance of each other at the start are impacts if `approaches` accepts them;
/// the deepest one is returned. If it accepts none, these pairs are excluded from an [`advance`].
/// Allocates lists of the pairs.
pub fn advance_from_contact<B: Bodies>(
    bodies: &mut B,
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
    approaches: impl Fn(&B::Pair, &Placement) -> bool,
) -> Option<Advance<B::Pair>> {
    // Unlike "start > end", this rejects a NaN.
    let is_possible = options.start <= options.end;
    if !is_possible {
        return None;
    }
    let placement = placement_at(options.start);
    let mut touching = Vec::new();
    bodies.within(&placement, options.tolerance, |pair| touching.push(pair));
    let depth = |one: &&B::Pair, two: &&B::Pair| {
        one.distance().total_cmp(&two.distance()).then(one.name().cmp(&two.name()))
    };
    let impacts = touching.iter().filter(|pair| approaches(pair, &placement));
    if let Some(&pair) = impacts.min_by(depth) {
        return Some(Advance { time: options.start, pair, placement, has_converged: true });
    }
    let mut excluded: Vec<[u32; 2]> = touching.iter().map(PartPair::name).collect();
    excluded.sort_unstable();
    advance(bodies, &excluded, placement_at, options)
}

#[cfg(test)]
mod tests {
    use glamx::Pose3;

    use super::*;

    /// Bodies that stay at a distance, and the number of searches.
    struct Still(f64, usize);

    impl PartPair for f64 {
        fn distance(&self) -> f64 {
            *self
        }

        fn name(&self) -> [u32; 2] {
            [0; 2]
        }
    }

    impl Bodies for Still {
        type Pair = f64;

        fn nearest(&mut self, _: &Placement, _: f64, _: &[[u32; 2]]) -> Option<f64> {
            self.1 += 1;
            Some(self.0)
        }

        fn within(&mut self, _: &Placement, _: f64, _: impl FnMut(f64)) {}
    }

    /// Would catch steps that are too short to change the time, or infinite.
    #[test]
    fn no_step_leaves_the_time_as_it_is() {
        for (speed_bound, has_met) in [(1.0e12, true), (0.0, false)] {
            let bodies = &mut Still(1.0e-6, 0);
            let options = AdvanceOptions {
                start: 1.0,
                end: 2.0,
                speed_bound,
                tolerance: 1.0e-9,
                step_limit: 2000,
            };
            let found = advance(bodies, &[], |_| Placement::new(&Pose3::IDENTITY), options);
            assert_eq!(
                (found.map(|found| found.has_converged), bodies.1),
                (has_met.then_some(true), 1)
            );
        }
    }
}
