//! When two meshes on any paths touch, not counting what they touch already and are about to leave.
//!
//! A pair of triangles that touches at the start is an impact if it approaches: if its velocities
//! along the normal of the contact deepen it. Otherwise it is left out for good, and the others are
//! advanced to their first touch (`advance.rs`). So this is an answer about pairs of triangles, not
//! about bodies: where a mesh that sinks into another is pulled out again, triangles that did not
//! touch before can be met on the way.
//!
//! The pairs at the start keep overlapping in each step of the search: a start deep inside makes
//! all steps as dear as a query for all contacts.

use crate::traverse::Placement;
use crate::tree::Tree;
use crate::volumes::{DirectionSet, Directions};

use super::advance::{Advance, AdvanceOptions, advance_by};
use super::contacts::contacts;
use super::nearest::{Goal, search_besides};
use super::seek::SearchScratch;
use super::triangles::FoundPair;

/// The first impact of two meshes that may touch at the start, as of [`advance`](fn@super::advance)
/// but for the pairs of triangles within the tolerance of each other at the start. Those of them
/// that `approaches` accepts are impacts at the start, and the deepest one is returned. The others
/// do not count, whatever becomes of them.
///
/// `None` if there is no impact until the end, or if a number is not finite. Allocates lists of the
/// pairs that touch at the start.
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
    let mut touching = Vec::new();
    contacts(trees, placement, options.tolerance, scratch, |pair| touching.push(pair));
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
        search_besides(trees, placement, reach, Goal::Nearest, &besides, scratch).0
    })
}
