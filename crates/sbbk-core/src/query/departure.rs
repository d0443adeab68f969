//! When two bodies on any paths touch, not counting what they touch already and are about to leave.
//!
//! A pair of parts that touches at the start is an impact if it approaches: if its velocities
//! along the normal of the contact deepen it. Otherwise it is left out for good, and the others are
//! advanced to their first touch (`advance.rs`). So this is an answer about pairs of parts, not
//! about bodies: where a mesh that sinks into another is pulled out again, triangles that did not
//! touch before can be met on the way.
//!
//! The pairs at the start keep overlapping in each step of the search: a start deep inside makes
//! all steps as dear as a query for all contacts.

use crate::traverse::Placement;

use super::advance::{Advance, AdvanceOptions, Bodies, PartPair, advance_besides};

/// The first impact of two bodies that may touch at the start, as of [`advance`](fn@super::advance)
/// but for the pairs of parts within the tolerance of each other at the start. Those of them
/// that `approaches` accepts are impacts at the start, and the deepest one is returned. The others
/// do not count, whatever becomes of them.
///
/// `None` if there is no impact until the end, or if a number is not finite. Allocates lists of the
/// pairs that touch at the start.
pub fn advance_from_contact<B: Bodies>(
    bodies: &mut B,
    placement_at: impl Fn(f64) -> Placement,
    options: AdvanceOptions,
    approaches: impl Fn(&B::Pair, &Placement) -> bool,
) -> Option<Advance<B::Pair>> {
    // Not "later than": a NaN is no time.
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
    let mut besides: Vec<[u32; 2]> = touching.iter().map(PartPair::name).collect();
    besides.sort_unstable();
    advance_besides(bodies, &besides, placement_at, options)
}
