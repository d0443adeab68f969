//! The way from a pose to contact manifolds, the same for every kind of pair.
//!
//! 1. Meshes that cannot have a tree are left to Parry.
//! 2. The state of the pair is taken from the host's workspace.
//! 3. If its trees are not known yet, the boxes of the whole shapes are compared, as stock does.
//! 4. The trees are looked up, and what changed since the last query is forgotten.
//! 5. The same question as the last one has the same answer.
//! 6. [`Slack`](sbbk_core::traverse::Slack) says whether the candidates of the last descent still
//!    serve. If not, a descent finds new ones.
//! 7. Each candidate that may be in reach gets its exact contact, written to its manifold of the
//!    query before or to a new one.
//!
//! A [`Pair`] says what is particular to its kind in steps 3 and 4, its [`PairQuery`] in steps 6
//! and 7.

use std::cell::Cell;
use std::sync::Arc;

use parry3d::math::Real;
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::field::FieldScratch;
use sbbk_core::traverse::{Counters, DescentScratch, Placement, ProbeScratch, SlackPlan};
use sbbk_core::volumes::Sphere;

use super::convex::PlacedPart;
use super::merge::{Place, Previous};
use super::order::{Candidate, OrderKey};
use super::pool::{Demand, ManifoldPool, reset};
use super::pose::PairPose;
use super::state::{PairState, state_in};
use crate::mesh::{Change, TreeCache};

/// A mesh and another shape, of whose contacts a host asks.
pub(crate) trait Pair: Copy {
    /// What is known of the shapes from query to query.
    type Known: Clone + Default + Send + Sync + 'static;
    /// See [`Candidate::hint`].
    type Hint: Copy + Default + PartialEq + Send + Sync + 'static;
    /// The pair with its trees.
    type Query<'q>: PairQuery<Hint = Self::Hint>
    where
        Self: 'q;

    /// Whether a mesh is known not to have a tree.
    fn is_unsupported(&self, cache: &TreeCache) -> bool;

    /// Whether the trees have yet to be looked up or built.
    fn needs_trees(known: &Self::Known) -> bool;

    /// Whether the boxes of the whole shapes come within the prediction distance, or about.
    fn boxes_meet(&self, counters: &mut impl Counters) -> bool;

    /// Looks up or builds the trees, refitted where a mesh has deformed, and says what changed
    /// since the last query. `None` if a mesh cannot have a tree.
    fn open<'q>(
        &'q self,
        cache: &Arc<TreeCache>,
        known: &'q mut Self::Known,
    ) -> Option<(Change, Self::Query<'q>)>;
}

/// A query of a pair whose trees are known.
pub(crate) trait PairQuery {
    type Hint: Copy;
    /// What is known of the contact of a candidate before its manifold is at hand.
    type Contact;

    /// Greatest slack of a descent as a share of [`reach`](Self::reach).
    const GREATEST_SLACK: f64;

    fn pose(&self) -> &PairPose;

    /// What moves, as the slack of descents has it.
    fn moving(&self) -> Moving;

    /// The distance up to which there may be contacts.
    fn reach(&self) -> Real {
        self.pose().prediction
    }

    /// Adds all candidates within `margin`, and few others, in any order.
    fn descend(
        &mut self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        candidates: &mut Vec<Candidate<Self::Hint>>,
    );

    /// The key of a pair of subshapes. Numbers that no subshape has sort somewhere.
    fn key(&self, subshapes: [u32; 2]) -> OrderKey;

    /// The contact of a candidate; `None` if it is surely out of reach. May raise what the
    /// candidate knows.
    fn contact(
        &mut self,
        candidate: &mut Candidate<Self::Hint>,
        limits: Limits,
        scratch: &mut Scratch,
    ) -> Option<Self::Contact>;

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

/// A ball that holds the moving shape in its own frame, and where that frame is in the other's.
pub(crate) struct Moving {
    pub(super) ball: Sphere,
    pub(super) placement: Placement,
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
    /// By the boxes of the whole shapes alone.
    Apart,
    /// By what the last query left: nothing has moved.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
    /// Not at all: a mesh cannot have a tree, and Parry must answer.
    Unsupported,
}

/// Memory of one query, kept by each thread: after the first few queries none allocates here.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(super) descent: DescentScratch,
    pub(super) probe: ProbeScratch,
    pub(super) field: FieldScratch,
    /// The parts of convex shapes that this query has come across.
    pub(super) parts: Vec<Option<PlacedPart>>,
    /// The manifolds of the query before.
    places: Vec<Place>,
    demand: Demand,
}

thread_local! {
    static SCRATCH: Cell<Scratch> = Cell::default();
}

/// Brings the manifolds of a pair up to date.
pub(crate) fn answer<P, M, C>(
    pair: P,
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
    if pair.is_unsupported(cache) {
        return Answer::Unsupported;
    }
    let PairState::<M, C, P::Known, P::Hint> { shapes, memory } = state_in(workspace, manifolds);
    if P::needs_trees(shapes) && !pair.boxes_meet(&mut counters) {
        manifolds.clear();
        return Answer::Apart;
    }
    let Some((change, mut query)) = pair.open(cache, shapes) else {
        return Answer::Unsupported;
    };
    memory.follow(change, manifolds);
    if memory.coherence.is_answered(query.pose(), manifolds.len()) {
        return Answer::Unchanged;
    }
    let mut coherence = std::mem::take(&mut memory.coherence);
    let mut scratch = SCRATCH.take();
    scratch.parts.clear();
    let (moving, reach) = (query.moving(), query.reach());
    let plan =
        coherence.slack.plan(moving.ball, &moving.placement, reach, P::Query::GREATEST_SLACK);
    let (answer, margin) = match plan {
        SlackPlan::Reuse { margin, .. } => (Answer::Reused, margin),
        SlackPlan::Descend { margin } => {
            coherence.find(|candidates| {
                query.descend(margin, &mut counters, &mut scratch, candidates);
            });
            (Answer::Descended, margin)
        }
    };
    let limits = Limits {
        reach: f64::from(reach),
        margin: f64::from(margin),
        travel: coherence.slack.travel(),
    };
    update(
        &mut query,
        &mut coherence.candidates,
        limits,
        &mut scratch,
        &mut memory.pool,
        manifolds,
    );
    SCRATCH.set(scratch);
    coherence.answered(query.pose(), manifolds.len());
    memory.keep(coherence);
    answer
}

/// Replaces `manifolds` by those of the candidates that touch, in stock order. Manifolds of
/// subshapes that still do keep their data; none is left empty.
fn update<Q, M, C>(
    query: &mut Q,
    candidates: &mut [Candidate<Q::Hint>],
    limits: Limits,
    scratch: &mut Scratch,
    pool: &mut ManifoldPool<M, C>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) where
    Q: PairQuery,
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    pool.begin();
    let mut places = std::mem::take(&mut scratch.places);
    let mut previous = Previous::new(manifolds, |subshapes| query.key(subshapes), &mut places);
    // A new manifold that has no points yet.
    let mut blank = None;
    let farthest = limits.reach + limits.travel;
    for candidate in candidates {
        let old = previous.find(candidate.key, manifolds, pool);
        let is_far = candidate.clear > farthest;
        let contact = if is_far { None } else { query.contact(candidate, limits, scratch) };
        match (contact, old) {
            (Some(contact), Some(place)) => {
                let (points, manifold) = (&mut pool.previous_points, &mut manifolds[place]);
                if manifold.points.is_empty() {
                    // A blank one, that a host has made or a panic has left.
                    query.name(candidate, manifold);
                }
                query.write(contact, candidate, limits, scratch, points, manifold);
                pool.keep_old(place, manifolds);
            }
            (Some(contact), None) => {
                let manifold = blank.get_or_insert_with(|| pool.take());
                query.name(candidate, manifold);
                let points = &mut pool.previous_points;
                query.write(contact, candidate, limits, scratch, points, manifold);
                if manifold.points.is_empty() {
                    reset(manifold);
                } else {
                    pool.keep_new(blank.take(), manifolds);
                }
            }
            (None, Some(place)) => pool.retire(std::mem::take(&mut manifolds[place])),
            (None, None) => {}
        }
    }
    if let Some(blank) = blank {
        pool.retire(blank);
    }
    previous.retire_rest(manifolds, pool);
    pool.end(manifolds);
    if let Some(limit) = scratch.demand.note(places.len()) {
        places.shrink_to(limit);
    }
    scratch.places = places;
}
