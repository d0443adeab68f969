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
//! A [`Pair`] says what is particular to its kind in steps 1 and 2, its [`PairQuery`] in steps 4
//! and 5.

use std::cell::Cell;
use std::sync::Arc;

use parry3d::math::Real;
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::traverse::{Counters, DescentScratch, Placement, SlackPlan};
use sbbk_core::volumes::Sphere;

use super::convex::{Near, PlacedPart};
use super::merge::Lookup;
use super::order::{Candidate, OrderKey, Place};
use super::patches::{Outline, Patches, write_patches};
use super::pool::{Demand, ManifoldPool, reset};
use super::pose::PairPose;
use super::state::{PairState, state_in};
use super::triangles::{Found, Regions};
use crate::mesh::{Change, Ranks, TreeCache};

/// A mesh and another shape, of whose contacts a host asks.
pub(crate) trait Pair: Copy {
    /// What is known of the shapes from query to query.
    type Known: Clone + Default + Send + Sync + 'static;
    /// See [`Candidate::hint`].
    type Hint: Copy + Default + PartialEq + Send + Sync + 'static;
    /// The pair as it is now.
    type Query<'q>: PairQuery<Hint = Self::Hint>
    where
        Self: 'q;

    /// Whether nothing is known of the shapes.
    fn is_unknown(known: &Self::Known) -> bool;

    /// Says what changed since the last query, and opens this one.
    fn open<'q>(
        &'q self,
        cache: &'q Arc<TreeCache>,
        known: &'q mut Self::Known,
    ) -> (Change, Self::Query<'q>);
}

/// A query of a pair.
pub(crate) trait PairQuery {
    type Hint: Copy;
    /// What is known of the contact of a candidate before its manifold is at hand.
    type Contact: Copy;

    /// Greatest slack of a descent as a share of [`reach`](Self::reach).
    const GREATEST_SLACK: f64;

    fn pose(&self) -> &PairPose;

    /// What moves, as the slack of descents has it.
    fn moving(&self) -> Moving<'_>;

    /// The distance up to which there may be contacts.
    fn reach(&self) -> Real {
        self.pose().prediction
    }

    /// Adds all candidates within `margin`, and few others, in the order of stock's manifolds.
    fn descend(
        &mut self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        candidates: &mut Vec<Candidate<Self::Hint>>,
    );

    /// The contact of a candidate. May raise what the candidate knows.
    fn contact(
        &mut self,
        candidate: &mut Candidate<Self::Hint>,
        limits: Limits,
        scratch: &mut Scratch,
    ) -> Seen<Self::Contact>;

    /// Whether contacts may be others, now that all candidates have been seen. Then each candidate
    /// is asked for once more.
    fn needs_more(&mut self, _: &mut Scratch) -> bool {
        false
    }

    /// Memory for contacts, lent from query to query.
    fn contacts(scratch: &mut Scratch) -> &mut [ContactList<Self::Contact>; 2];

    /// Up to how far apart contacts may be in one patch; `None` if every contact has a manifold.
    fn patch_size(&self) -> Option<Real>;

    /// What a patch needs to know of a contact. `None` if it has no points after all.
    fn outline(
        &self,
        contact: &Self::Contact,
        candidate: &Candidate<Self::Hint>,
        scratch: &mut Scratch,
    ) -> Option<Outline>;

    /// Says which subshapes a manifold without points is of.
    fn name<M, C>(&self, candidate: &Candidate<Self::Hint>, manifold: &mut ContactManifold<M, C>) {
        [manifold.subshape1, manifold.subshape2] = candidate.subshapes;
    }

    /// Writes the contact to the manifold of its subshapes; no points if there is none after all.
    /// Points that were there before keep their data.
    fn write<M, C>(
        &mut self,
        contact: Self::Contact,
        candidate: &mut Candidate<Self::Hint>,
        limits: Limits,
        scratch: &mut Scratch,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync;
}

/// What is known of the contact of a candidate.
pub(crate) enum Seen<C> {
    /// There is none, or none before a second round.
    Nothing,
    /// In a second round: what it was in the first.
    Same,
    Contact(C),
}

impl<C> From<Option<C>> for Seen<C> {
    fn from(contact: Option<C>) -> Self {
        contact.map_or(Self::Nothing, Self::Contact)
    }
}

/// A ball that holds the moving shape in its own frame, and where that frame is in the other's.
pub(crate) struct Moving<'a> {
    pub(super) ball: Sphere,
    pub(super) placement: &'a Placement,
}

/// How far a query looks.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Limits {
    /// [`PairQuery::reach`].
    pub(super) reach: f64,
    /// The margin of the descent that found the candidates.
    pub(super) margin: f64,
    /// What the pair has moved since.
    pub(super) travel: f64,
}

/// How a query was answered; with more effort further down.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// By Parry's hierarchy and a box alone.
    Apart,
    /// By what the last query left: nothing has moved.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
    /// Not at all: Parry must answer.
    Unsupported,
}

/// Memory of one query, kept by each thread: after the first few queries none allocates here.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(super) descent: DescentScratch,
    /// The parts of convex shapes that this query has come across.
    pub(super) parts: Vec<Option<PlacedPart>>,
    /// Pairs of subshapes and their places in the order of manifolds.
    pub(super) ordered: Vec<(OrderKey, [u32; 2])>,
    /// Places of triangles in the order of their mesh.
    pub(super) ranks: [Ranks; 2],
    /// Triangles that a walk has found.
    pub(super) near: Vec<u32>,
    /// Where surfaces cross.
    pub(super) regions: Regions,
    pub(super) triangle_contacts: [ContactList<Found>; 2],
    pub(super) convex_contacts: [ContactList<Near>; 2],
    pub(super) patches: Patches,
    lookup: Lookup,
    /// Which manifolds of the query before are dealt with.
    is_done: Vec<bool>,
    demand: Demand,
}

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
    let PairState::<M, C, P::Known, P::Hint> { shapes, memory } = state_in(workspace, manifolds);
    if P::is_unknown(shapes) {
        cache.met();
    }
    let (change, mut query) = pair.open(cache, shapes);
    memory.follow(change, manifolds);
    if memory.coherence.is_answered(query.pose(), manifolds.len()) {
        return Answer::Unchanged;
    }
    let coherence = memory.coherence.begin();
    let mut scratch = SCRATCH.take().unwrap_or_default();
    scratch.parts.clear();
    let (moving, reach) = (query.moving(), query.reach());
    let plan = coherence.slack.plan(moving.ball, moving.placement, reach, P::Query::GREATEST_SLACK);
    let (answer, margin) = match plan {
        SlackPlan::Reuse { margin, .. } => (Answer::Reused, margin),
        SlackPlan::Descend { margin } => {
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
    find_contacts(&mut query, candidates, limits, &mut scratch, [&mut contacts, &mut spare]);
    if let Some(size) = query.patch_size() {
        let found = Contacts { query: &mut query, candidates, contacts: &contacts, limits };
        write_patches(found, size, &mut scratch, &mut memory.pool, manifolds);
    } else {
        coherence.find_places(&mut scratch.lookup, manifolds);
        let (candidates, query) = (&mut coherence.candidates, &mut query);
        let found = Contacts { query, candidates, contacts: &contacts, limits };
        write_every(found, &mut scratch, &mut memory.pool, manifolds);
    }
    if let Some(limit) = scratch.demand.note(contacts.len()) {
        // Candidates come and go more than manifolds do: some hundred kilobytes a thread stay.
        for list in [&mut contacts, &mut spare] {
            list.shrink_to(limit.max(1024));
        }
        scratch.is_done.shrink_to(limit);
        scratch.lookup.shrink_to(limit);
        scratch.patches.shrink_to(limit);
    }
    *P::Query::contacts(&mut scratch) = [contacts, spare];
    SCRATCH.set(Some(scratch));
    memory.end(query.pose(), manifolds.len());
    answer
}

/// Contacts and the candidates that they are of, by their places, in order. Most candidates have
/// none.
pub(crate) type ContactList<C> = Vec<(u32, C)>;

/// The contacts of a query, before their manifolds.
pub(super) struct Contacts<'c, Q: PairQuery> {
    pub(super) query: &'c mut Q,
    pub(super) candidates: &'c mut [Candidate<Q::Hint>],
    pub(super) contacts: &'c [(u32, Q::Contact)],
    pub(super) limits: Limits,
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
    before.clear();
    let farthest = limits.reach + limits.travel;
    loop {
        contacts.clear();
        let mut before_now = before.iter().copied().peekable();
        for (index, candidate) in (0..).zip(&mut *candidates) {
            let same = before_now.next_if(|&(of, _)| of == index);
            if candidate.clear <= farthest {
                match query.contact(candidate, limits, scratch) {
                    Seen::Nothing => {}
                    Seen::Same => contacts.extend(same),
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

/// Replaces `manifolds` by one for each contact, in stock order. Manifolds of subshapes that still
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
    pool.begin();
    let mut is_done = std::mem::take(&mut scratch.is_done);
    is_done.clear();
    is_done.resize(manifolds.len(), false);
    // A new manifold that has no points yet.
    let mut blank = None;
    let mut count = 0;
    let mut contacts = contacts.iter().copied().peekable();
    for (index, candidate) in (0..).zip(&mut *candidates) {
        let contact = contacts.next_if(|&(of, _)| of == index).map(|(_, contact)| contact);
        let old = candidate.place.take().map(Place::index);
        if let Some(place) = old {
            is_done[place] = true;
        }
        let is_kept = match (contact, old) {
            (Some(contact), Some(place)) => {
                let (points, manifold) = (&mut pool.previous_points, &mut manifolds[place]);
                if manifold.points.is_empty() {
                    // A blank one, that a host has made or a panic has left.
                    query.name(candidate, manifold);
                }
                query.write(contact, candidate, limits, scratch, points, manifold);
                pool.keep_old(place, manifolds)
            }
            (Some(contact), None) => {
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
