//! The way from a pose to contact manifolds, the same for every kind of pair.
//!
//! 1. The state of the pair is taken from the host's workspace.
//! 2. What changed since the last query is forgotten. Two meshes get their trees, if they are there
//!    or cost little.
//! 3. The same question as the last one has the same answer.
//! 4. [`Slack`](sbbk_core::traverse::Slack) says whether the candidates of the last descent still
//!    serve. If not, a descent finds new ones.
//! 5. Each candidate that may be in reach gets its exact contact.
//! 6. Each contact is written to its manifold of the query before or to a new one; or
//!    [`patches`](super::patches) are made of all.
//!
//! A kind may have steps 4 to 6 in one ([`PairQuery::write_at_once`]), and keep no candidates.

use std::cell::Cell;
use std::sync::Arc;

use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use sbbk_core::traverse::{Counters, SlackPlan};

use super::driver::{Answer, ContactList, Contacts, Limits, Pair, PairQuery, Scratch, Seen};
use super::memory::Coherence;
use super::order::{Candidate, Place};
use super::patches::write_patches;
use super::pool::{ManifoldPool, reset};
use super::state::{PairState, state_in};
use crate::mesh::TreeCache;

thread_local! {
    /// Taken while a query uses it: one within another makes its own.
    static SCRATCH: Cell<Option<Box<Scratch>>> = Cell::default();
}

/// Brings the manifolds of a pair up to date.
pub(crate) fn answer<P, M, C>(
    pair: &P,
    cache: &Arc<TreeCache>,
    mut counters: impl Counters,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> Answer
where
    P: Pair,
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    let PairState::<P::Known, P::Hint> { shapes, memory } = state_in(workspace, manifolds);
    if P::is_unknown(shapes) {
        cache.count_pair();
    }
    let (change, mut query) = pair.open(cache, shapes);
    memory.follow(change, manifolds);
    if memory.coherence.is_answered(query.pose(), manifolds.len()) {
        return Answer::Unchanged;
    }
    let coherence = memory.coherence.begin();
    let mut scratch = SCRATCH.take().unwrap_or_default();
    scratch.parts.clear();
    let mut pool = ManifoldPool::borrow();
    if query.write_at_once(&mut counters, &mut scratch, &mut pool, manifolds) {
        *coherence = Coherence::default();
        if let Some(limit) = scratch.demand.note(manifolds.len()) {
            scratch.shrink_to(limit);
            pool.shrink_to(limit);
        }
        pool.give_back();
        SCRATCH.set(Some(scratch));
        memory.end(query.pose(), manifolds.len());
        return Answer::Descended;
    }
    let (moving, reach) = (query.moving(), query.reach());
    let plan = coherence.slack.plan(moving.ball, moving.placement, reach, P::Query::SLACK);
    let (answer, margin) = match plan {
        SlackPlan::Reuse { margin } => (Answer::Reused, margin),
        SlackPlan::Descend { margin, travel } => {
            coherence.outside -= travel;
            let mut lookup = std::mem::take(&mut scratch.lookup);
            coherence.find(&mut lookup, |candidates| {
                query.descend(margin, &mut counters, &mut scratch, candidates);
            });
            scratch.lookup = lookup;
            (Answer::Descended, margin)
        }
    };
    let limits = Limits {
        reach: f64::from(reach),
        margin: f64::from(margin),
        travel: coherence.slack.travel(),
    };
    let [mut contacts, mut spare] = std::mem::take(P::Query::contacts(&mut scratch));
    let candidates = &mut coherence.candidates;
    let found = candidates.len();
    find_contacts(&mut query, candidates, limits, &mut scratch, [&mut contacts, &mut spare]);
    query.settle(candidates, &mut contacts, limits, &mut coherence.outside, &mut scratch);
    for Candidate { subshapes, place, .. } in &mut candidates[found..] {
        let of_it = |m: &ContactManifold<M, C>| [m.subshape1, m.subshape2] == *subshapes;
        *place = place.or_else(|| Place::new(manifolds.iter().position(of_it)?));
    }
    if let Some(plan) = query.patch_plan(&contacts) {
        let found = Contacts { query: &mut query, candidates, contacts: &contacts, limits };
        write_patches(found, plan, &mut scratch, &mut pool, manifolds);
    } else {
        coherence.find_places(&mut scratch.lookup, manifolds);
        let (candidates, query) = (&mut coherence.candidates, &mut query);
        let found = Contacts { query, candidates, contacts: &contacts, limits };
        write_every(found, &mut scratch, &mut pool, manifolds);
    }
    coherence.candidates.truncate(found);
    let needed = contacts.len();
    *P::Query::contacts(&mut scratch) = [contacts, spare];
    if let Some(limit) = scratch.demand.note(needed) {
        scratch.shrink_to(limit);
        pool.shrink_to(limit);
    }
    pool.give_back();
    SCRATCH.set(Some(scratch));
    memory.end(query.pose(), manifolds.len());
    answer
}

/// Makes `contacts` those of the candidates.
fn find_contacts<Q: PairQuery>(
    query: &mut Q,
    candidates: &mut [Candidate<Q::Hint>],
    limits: Limits,
    scratch: &mut Scratch,
    [contacts, before]: [&mut ContactList<Q::Contact>; 2],
) {
    scratch.regions.begin();
    let farthest = limits.reach + limits.travel;
    loop {
        contacts.clear();
        let mut before_now = InStep(before);
        for (index, candidate) in (0..).zip(&mut *candidates) {
            let same = before_now.next_of(index);
            if candidate.clear <= farthest {
                match query.contact(candidate, limits, scratch) {
                    Seen::Nothing => {}
                    Seen::Same => contacts.extend(same.map(|&same| (index, same))),
                    Seen::Contact(contact) => contacts.push((index, contact)),
                }
            }
        }
        if !query.needs_more(scratch) {
            return;
        }
        std::mem::swap(contacts, before);
    }
}

/// What is left of a list of contacts, on the way through the candidates that they are of. (A peeked
/// iterator copies a contact for each candidate: a tenth of a query.)
struct InStep<'c, C>(&'c [(u32, C)]);

impl<'c, C> InStep<'c, C> {
    /// The contact of a candidate, if there is one.
    #[inline(always)]
    fn next_of(&mut self, candidate: u32) -> Option<&'c C> {
        let ((of, contact), rest) = self.0.split_first()?;
        (*of == candidate).then(|| {
            self.0 = rest;
            contact
        })
    }
}

/// Replaces `manifolds` by one for each contact, in the order of subshapes. Manifolds of subshapes that still
/// touch keep their data; none is left empty.
fn write_every<Q, M, C>(
    Contacts { query, candidates, contacts, limits }: Contacts<'_, Q>,
    scratch: &mut Scratch,
    pool: &mut ManifoldPool<M, C>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) where
    Q: PairQuery,
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    let mut is_done = std::mem::take(&mut scratch.is_done);
    is_done.clear();
    is_done.resize(manifolds.len(), false);
    // A new manifold that has no points yet.
    let mut blank = None;
    let mut count = 0;
    let mut contacts = InStep(contacts);
    for (index, candidate) in (0..).zip(&mut *candidates) {
        let contact = contacts.next_of(index);
        let old = candidate.place.take().map(Place::index);
        if let Some(place) = old {
            is_done[place] = true;
        }
        let is_kept = match (contact, old) {
            (Some(&contact), Some(place)) => {
                let (points, manifold) = (&mut pool.previous_points, &mut manifolds[place]);
                if manifold.points.is_empty() {
                    // A blank one, that a host has made or a panic has left.
                    query.name(candidate, manifold);
                }
                query.write(contact, candidate, limits, scratch, points, manifold);
                pool.keep_old(place, manifolds)
            }
            (Some(&contact), None) => {
                let manifold = blank.get_or_insert_with(|| pool.take());
                query.name(candidate, manifold);
                let points = &mut pool.previous_points;
                query.write(contact, candidate, limits, scratch, points, manifold);
                let has_points = !manifold.points.is_empty();
                if has_points {
                    pool.keep_new(blank.take(), manifolds);
                } else {
                    reset(manifold);
                }
                has_points
            }
            (None, Some(place)) => {
                pool.retire(std::mem::take(&mut manifolds[place]));
                false
            }
            (None, None) => false,
        };
        if is_kept {
            candidate.place = Place::new(count);
            count += 1;
        }
    }
    if let Some(blank) = blank {
        pool.retire(blank);
    }
    for (manifold, _) in manifolds.iter_mut().zip(&is_done).filter(|(_, is_done)| !**is_done) {
        pool.retire(std::mem::take(manifold));
    }
    pool.end(manifolds);
    scratch.is_done = is_done;
}
