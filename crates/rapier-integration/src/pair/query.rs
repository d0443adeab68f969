//! The pipeline of a contact query, from the pose of a pair to its manifolds, and what a kind of pair implements ([`Pair`], [`PairQuery`]).
//!
//! 1. The state of the pair comes from the host's workspace ([`state`](super::state)).
//! 2. A change of the shapes since the last query drops what no longer holds.
//! 3. An equal pose leaves the manifolds as they are. Shapes that were apart, and have moved by less than their distance,
//!    have none.
//! 4. If the candidates of the last descent no longer serve, a descent finds new ones. If there were none, the distance of
//!    the shapes may tell for how long there will be none.
//! 5. Candidates in reach become contacts ([`PairQuery::contacts`]).
//! 6. Contacts become manifolds: one each, or a few for all ([`write`](super::write)).

use std::cell::Cell;
use std::sync::Arc;
use std::thread::LocalKey;

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::traverse::{DescentCounts, SlackLimits, SlackPlan};

use super::pose::{Moving, PairPose};
use super::reduce::{ContactSummary, PatchPlan, Reduction};
use super::state::{Candidate, CandidateMemory, HighWaterMark, PairState, state_in};
use super::write::Writer;
use crate::mesh::{Change, MeshStore};

/// A kind of pair: a mesh and another shape.
pub(crate) trait Pair: Copy {
    /// Data of the shapes, kept from query to query.
    type State: Clone + Default + Send + Sync + 'static;
    /// See [`Candidate::hint`].
    type Hint: Copy + Default + Send + Sync + 'static;
    /// The pair during a query.
    type Query<'q>: PairQuery<Hint = Self::Hint>
    where
        Self: 'q;

    fn pose(&self) -> &PairPose;

    /// Stores the shapes of a query. Returns their change since the last query.
    fn update(&self, state: &mut Self::State) -> Change;

    /// Begins a query. Call [`update`](Self::update) first.
    fn open<'q>(&'q self, state: &'q mut Self::State) -> Self::Query<'q>;
}

/// A query of a pair. Passes over candidates and memory for them are private to the kind.
pub(crate) trait PairQuery {
    type Hint: Copy + Default;
    /// A contact before its points are made.
    type Contact: Copy + 'static;
    /// Memory of a thread for queries of this kind.
    type Scratch: Default + 'static;

    /// Slack of descents beyond [`reach`](Self::reach).
    const SLACK: SlackLimits;

    /// Returns where the thread keeps the memory.
    fn memory() -> &'static LocalKey<Memory<Self>>;

    fn pose(&self) -> &PairPose;

    /// Returns the body whose motion limits how long candidates serve.
    fn moving(&self) -> Moving;

    /// Returns the distance up to which all contacts are found.
    fn reach(&self) -> Real {
        self.pose().prediction
    }

    /// Adds all contacts at once if these cost less than keeping candidates. Returns true if so. Called
    /// first in each query.
    fn contacts_without_candidates(
        &mut self,
        _counts: &mut DescentCounts,
        _scratch: &mut Self::Scratch,
        _contacts: &mut ContactList<Self::Contact>,
    ) -> bool {
        false
    }

    /// Returns a lower bound of the distance between the shapes, if one above `margin` costs less than a descent. Asked for
    /// where the last descent has found nothing.
    fn clearance(&self, _margin: Real) -> Option<Real> {
        None
    }

    /// Returns a motion of the moving body for which no contact arises without candidates. Queries
    /// without contacts call this.
    fn calm(&self) -> f64;

    /// Adds all pairs of subshapes within `margin`, and few others, in any order.
    fn descend(
        &mut self,
        margin: Real,
        counts: &mut DescentCounts,
        scratch: &mut Self::Scratch,
        found: &mut Vec<Candidate<Self::Hint>>,
    );

    /// Adds the contacts of candidates, in the order of subshapes, at most one for two subshapes.
    fn contacts(
        &mut self,
        candidates: &mut [Candidate<Self::Hint>],
        limits: Limits,
        scratch: &mut Self::Scratch,
        contacts: &mut ContactList<Self::Contact>,
    );

    /// Returns how contacts are reduced; `None` if each has its manifold.
    fn reduction(&self, contacts: &ContactList<Self::Contact>) -> Option<PatchPlan>;

    /// Returns the summary of a contact for contact reduction; `None` if it has no points.
    /// `points` is memory.
    fn summary(
        &mut self,
        contact: &([u32; 2], Self::Contact),
        scratch: &mut Self::Scratch,
        points: &mut ContactPoints,
    ) -> Option<ContactSummary>;

    /// Replaces `points` by the points of a contact, which may have none.
    fn points(
        &mut self,
        contact: &([u32; 2], Self::Contact),
        scratch: &mut Self::Scratch,
        points: &mut ContactPoints,
    );
}

/// Contacts with their subshapes.
pub(crate) type ContactList<C> = Vec<([u32; 2], C)>;

/// Distances of a query.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Limits {
    /// [`PairQuery::reach`].
    pub(super) reach: f64,
    /// Margin of the descent that found the candidates.
    pub(super) margin: f64,
    /// Bound of the motion of the pair since that descent.
    pub(super) travel: f64,
}

impl Limits {
    /// Returns true if a candidate may be within reach.
    #[inline(always)]
    pub(super) fn may_touch<H>(&self, candidate: &Candidate<H>) -> bool {
        candidate.clear <= self.reach + self.travel
    }
}

/// Normals and points of a contact, as a manifold has them.
#[derive(Default)]
pub(crate) struct ContactPoints {
    /// Unit vectors from each shape to the other, in its frame.
    pub(super) normals: [parry3d::math::Vector; 2],
    /// Poses of subshapes in whose frames the points are, instead of the frames of the shapes.
    pub(super) poses: [Option<Pose>; 2],
    pub(super) points: Vec<TrackedContact<()>>,
}

/// Memory of a thread for one kind of pair. Empty during a query: a query inside another one makes its
/// own.
pub(crate) type Memory<Q> =
    Cell<Option<Box<QueryMemory<<Q as PairQuery>::Scratch, <Q as PairQuery>::Contact>>>>;

pub(crate) struct QueryMemory<S, C> {
    pub(super) scratch: S,
    pub(super) contacts: ContactList<C>,
    pub(super) reduction: Reduction,
    pub(super) points: ContactPoints,
    pub(super) demand: HighWaterMark,
}

impl<S: Default, C> Default for QueryMemory<S, C> {
    fn default() -> Self {
        Self {
            scratch: S::default(),
            contacts: Vec::new(),
            reduction: Reduction::default(),
            points: ContactPoints::default(),
            demand: HighWaterMark::default(),
        }
    }
}

/// Way in which a query was answered.
pub(crate) enum QueryOutcome {
    /// By the distance of the shapes: Parry's hierarchy and a box or a ball, or the motion since.
    Apart,
    /// By the manifolds of the last query.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
}

/// Number of contacts for which a thread always keeps its memory. Higher: more memory; lower: more allocations.
const LEAST_KEPT: usize = 1024;

/// Brings the manifolds of a pair up to date.
pub(crate) fn update_manifolds<P, M, C>(
    pair: &P,
    store: &Arc<MeshStore>,
    counts: &mut DescentCounts,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> QueryOutcome
where
    P: Pair,
    M: Default + 'static,
    C: Default + Copy + 'static,
{
    let new_pair = || store.counters.pairs.raise();
    let state: &mut PairState<P::State, P::Hint> = state_in(workspace, manifolds, new_pair);
    let PairState { shapes, memory } = state;
    memory.apply_change(pair.update(shapes), manifolds);
    let pose = pair.pose();
    if memory.is_unchanged(pose, manifolds.len()) {
        return QueryOutcome::Unchanged;
    }
    if manifolds.is_empty() && memory.is_calm(pose) {
        return QueryOutcome::Apart;
    }
    let mut query = pair.open(shapes);
    memory.begin();
    let mut lent = P::Query::memory().take().unwrap_or_default();
    let outcome = update_contacts(&mut query, memory, counts, &mut lent);
    let plan = query.reduction(&lent.contacts);
    let had_patches = memory.has_patches.replace(plan.is_some());
    let mut writer = Writer::begin(manifolds, had_patches);
    if let Some(plan) = plan {
        writer.write_patches(&mut query, &mut lent, plan);
    } else {
        writer.write_every(&mut query, &mut lent);
    }
    writer.end();
    if lent.demand.update(lent.contacts.len()).is_some_and(|limit| limit >= LEAST_KEPT) {
        *lent = QueryMemory { demand: lent.demand, ..QueryMemory::default() };
    }
    P::Query::memory().set(Some(lent));
    memory.end(pose, manifolds.len());
    if manifolds.is_empty() && memory.candidates.is_empty() {
        memory.note_calm(pose, query.moving(), query.reach(), query.calm());
    }
    outcome
}

/// Computes the contacts of a query, in the memory of the thread.
fn update_contacts<Q: PairQuery>(
    query: &mut Q,
    memory: &mut CandidateMemory<Q::Hint>,
    counts: &mut DescentCounts,
    QueryMemory { scratch, contacts, .. }: &mut QueryMemory<Q::Scratch, Q::Contact>,
) -> QueryOutcome {
    contacts.clear();
    if query.contacts_without_candidates(counts, scratch, contacts) {
        memory.forget();
        return QueryOutcome::Descended;
    }
    let (moving, reach) = (query.moving(), query.reach());
    let had_none = !memory.slack.is_new() && memory.candidates.is_empty();
    let plan = memory.slack.plan(moving.ball, moving.placement(query.pose()), reach, Q::SLACK);
    let (outcome, margin) = match plan {
        SlackPlan::Reuse { margin, .. } => (QueryOutcome::Reused, margin),
        SlackPlan::Descend { margin, .. } => {
            if let Some(clearance) = had_none.then(|| query.clearance(margin)).flatten() {
                memory.slack.note_clear(clearance);
                (QueryOutcome::Apart, clearance)
            } else {
                memory.replace(|found| query.descend(margin, counts, scratch, found));
                (QueryOutcome::Descended, margin)
            }
        }
    };
    let (reach, margin) = (f64::from(reach), f64::from(margin));
    let limits = Limits { reach, margin, travel: memory.slack.travel() };
    query.contacts(&mut memory.candidates, limits, scratch, contacts);
    outcome
}
