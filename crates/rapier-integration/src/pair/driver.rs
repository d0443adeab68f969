//! The way from a pose to contact manifolds, the same for every kind of pair.
//!
//! 1. The state of the pair is taken from the host's workspace.
//! 2. What changed since the last query is forgotten. Two meshes get their trees, if they are there
//!    or cost little.
//! 3. The same question as the last one has the same answer.
//! 4. [`Slack`](sbbk_core::traverse::Slack) says whether the candidates of the last descent still
//!    serve. If not, a descent finds new ones.
//! 5. Each candidate that may be in reach gets its exact contact, written to its manifold of the
//!    query before or to a new one.
//!
//! A [`Pair`] says what is particular to its kind in steps 1 and 2, its [`PairQuery`] in steps 4
//! and 5.

use std::cell::Cell;
use std::sync::Arc;

use parry3d::math::Real;
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::traverse::{Counters, DescentScratch, Placement, SlackPlan};
use sbbk_core::volumes::Sphere;

use super::convex::PlacedPart;
use super::merge::Lookup;
use super::order::{Candidate, OrderKey, Place};
use super::pool::{Demand, ManifoldPool, reset};
use super::pose::PairPose;
use super::state::{PairState, state_in};
use super::triangles::Regions;
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
    type Contact;

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

    /// Whether contacts that were put off may be needed, now that all candidates have been seen. Then
    /// each candidate is asked for once more, and none may be put off.
    fn needs_more(&mut self, _: &mut Scratch) -> bool {
        false
    }

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
    /// There is none.
    Nothing,
    /// Whether it is needed depends on the others.
    Later,
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
    coherence.find_places(&mut scratch.lookup, manifolds);
    scratch.regions.begin();
    let candidates = &mut coherence.candidates;
    let mut update = |query: &mut _, scratch: &mut _, manifolds: &mut _| {
        update(query, candidates, limits, scratch, &mut memory.pool, manifolds)
    };
    let has_put_off = update(&mut query, &mut scratch, manifolds);
    if query.needs_more(&mut scratch) || has_put_off {
        update(&mut query, &mut scratch, manifolds);
    }
    SCRATCH.set(Some(scratch));
    memory.end(query.pose(), manifolds.len());
    answer
}

/// Replaces `manifolds` by those of the candidates that touch, in stock order. Manifolds of
/// subshapes that still do keep their data; none is left empty. Returns whether some are still there
/// whose contacts were put off.
fn update<Q, M, C>(
    query: &mut Q,
    candidates: &mut [Candidate<Q::Hint>],
    limits: Limits,
    scratch: &mut Scratch,
    pool: &mut ManifoldPool<M, C>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) -> bool
where
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
    let mut has_put_off = false;
    let farthest = limits.reach + limits.travel;
    for candidate in candidates {
        let old = candidate.place.take().map(Place::index);
        if let Some(place) = old {
            is_done[place] = true;
        }
        let is_far = candidate.clear > farthest;
        let seen = if is_far { Seen::Nothing } else { query.contact(candidate, limits, scratch) };
        let is_kept = match (seen, old) {
            (Seen::Contact(contact), Some(place)) => {
                let (points, manifold) = (&mut pool.previous_points, &mut manifolds[place]);
                if manifold.points.is_empty() {
                    // A blank one, that a host has made or a panic has left.
                    query.name(candidate, manifold);
                }
                query.write(contact, candidate, limits, scratch, points, manifold);
                pool.keep_old(place, manifolds)
            }
            (Seen::Contact(contact), None) => {
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
            (Seen::Later, Some(place)) => {
                has_put_off = true;
                pool.keep_old(place, manifolds)
            }
            (Seen::Same, Some(place)) => pool.keep_old(place, manifolds),
            (Seen::Nothing, Some(place)) => {
                pool.retire(std::mem::take(&mut manifolds[place]));
                false
            }
            (Seen::Nothing | Seen::Later | Seen::Same, None) => false,
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
    if let Some(limit) = scratch.demand.note(is_done.len()) {
        is_done.shrink_to(limit);
        scratch.lookup.shrink_to(limit);
    }
    scratch.is_done = is_done;
    has_put_off
}
