//! A contact query. A kind of pair implements [`Pair`] and [`PairQuery`], and the
//! [pipeline](super::update) calls it. A host keeps [`PairState`] between queries.
//!
//! A descent looks farther than the reach, and its candidates serve several queries: [`Slack`]
//! decides for how long. Until then no tree is touched, and candidates that cannot have come within
//! the reach are skipped. All others get the exact test, so a query without a descent finds the
//! same contacts. Losing the state costs time only.

use std::cell::Cell;
use std::sync::LazyLock;
use std::thread::LocalKey;

use parry3d::math::{Pose, Real};
use parry3d::query::details::{
    TypedWorkspaceData, VoxelsShapeContactManifoldsWorkspace, WorkspaceData,
};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::traverse::{DescentCounts, Placement, Slack, SlackLimits};

use super::pose::{Moving, PairPose};
use super::reduce::{ContactSummary, PatchPlan, Reduction};
use crate::mesh::Change;

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

    /// Returns the body whose motion limits how long candidates serve.
    fn moving(&self) -> Moving;

    /// Returns the distance up to which all contacts are found.
    fn reach(&self) -> Real;

    /// Begins a query: forgets what the last one left in the memory of the thread.
    fn begin(&self, _scratch: &mut Self::Scratch) {}

    /// Adds all contacts within `margin` at once, for a query in fast motion whose candidates serve
    /// no other one. Returns false if that costs more than candidates.
    fn contacts_without_candidates(
        &mut self,
        _margin: Real,
        _counts: &mut DescentCounts,
        _scratch: &mut Self::Scratch,
        _contacts: &mut ContactList<Self::Contact>,
    ) -> bool {
        false
    }

    /// Returns a lower bound of the distance between the shapes, if one above `margin` costs less
    /// than a descent. Asked for where the last descent has found nothing.
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

    /// Adds the contacts of candidates, in the order of subshapes: one for two subshapes, except
    /// vertices at half-spaces.
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
        candidate.touches_at <= self.reach + self.travel
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

/// Memory of a thread for one kind of pair. Empty during a query: a query inside another one makes
/// its own.
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

/// State of a pair: data `S` of its shapes, and candidates with hints `H`.
#[derive(Clone, Default)]
pub(super) struct PairState<S, H> {
    pub(super) shapes: S,
    pub(super) memory: CandidateMemory<H>,
}

/// A pair of subshapes that may be within the margin.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Candidate<H> {
    /// Numbers in shape 1 and shape 2.
    pub(super) subshapes: [u32; 2],
    /// Lower bound of the distance plus the travel of the pair, both at the last measurement. The
    /// sum minus the present travel is a lower bound of the present distance.
    pub(super) touches_at: f64,
    /// Makes the next contact cheaper. Never changes the contact.
    pub(super) hint: H,
}

impl<H: Default> Candidate<H> {
    /// A candidate at an unknown distance.
    pub(super) fn new(subshapes: [u32; 2]) -> Self {
        Self { subshapes, touches_at: f64::NEG_INFINITY, hint: H::default() }
    }
}

/// Candidates of the last descent, and the last query.
#[derive(Clone, Default)]
pub(super) struct CandidateMemory<H> {
    /// Pose, prediction distance, and number of manifolds left. `None` during a query, and after
    /// one that a panic has ended.
    last: Option<(Pose, Real, usize)>,
    /// True if the manifolds of the last query are patches.
    pub(super) has_patches: Option<bool>,
    pub(super) slack: Slack,
    calm: Option<Calm>,
    /// In the order of subshapes.
    pub(super) candidates: Vec<Candidate<H>>,
    demand: HighWaterMark,
}

/// A pair without contacts and candidates, which gets none while the moving body moves by less than
/// `rest`.
#[derive(Clone)]
struct Calm {
    moving: Moving,
    placement: Placement,
    prediction: Real,
    rest: f64,
}

impl<H> CandidateMemory<H> {
    /// Forgets the candidates after a change of the shapes. Manifolds keep their data unless a
    /// shape was replaced.
    pub(super) fn apply_change<M, C>(
        &mut self,
        change: Change,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) {
        match change {
            Change::Unchanged => return,
            Change::Unknown => {}
            Change::Replaced => manifolds.clear(),
        }
        self.forget();
    }

    /// Returns true if the last query had the same pose and left as many manifolds.
    pub(super) fn is_unchanged(&self, pose: &PairPose, manifold_count: usize) -> bool {
        self.last == Some((pose.pos12, pose.prediction, manifold_count))
    }

    /// Returns true if the last query found neither contacts nor candidates, and the pair has moved
    /// too little for any. Takes note of the placement.
    pub(super) fn is_calm(&mut self, pose: &PairPose) -> bool {
        let Some(Calm { moving, placement, prediction, rest }) = &self.calm else { return false };
        let now = moving.placement(pose);
        let motion = moving.body.motion(now, placement);
        let is_calm = pose.prediction == *prediction && motion < *rest;
        if is_calm {
            self.slack.note_placement(now);
        }
        is_calm
    }

    /// Takes note of a query without contacts and candidates. No contact arises without candidates
    /// for a motion of `calm`.
    pub(super) fn note_calm(&mut self, pose: &PairPose, moving: Moving, reach: Real, calm: f64) {
        let (placement, PairPose { prediction, .. }) = (*moving.placement(pose), *pose);
        let reach = reach.max(prediction);
        let rest = calm.min(self.slack.rest(moving.body, &placement, reach));
        let calm = Calm { moving, placement, prediction, rest };
        self.calm = (rest > 0.0).then_some(calm);
    }

    /// Begins a query. Forgets the candidates if the last query was cut short by a panic.
    pub(super) fn begin(&mut self) {
        self.calm = None;
        if self.last.take().is_none() {
            self.forget();
        }
    }

    /// Ends a query.
    pub(super) fn end(&mut self, pose: &PairPose, manifold_count: usize) {
        self.last = Some((pose.pos12, pose.prediction, manifold_count));
        if let Some(limit) = self.demand.update(self.candidates.len()) {
            self.candidates.shrink_to(limit);
        }
    }

    /// Drops the candidates. The next query descends.
    pub(super) fn forget(&mut self) {
        (self.last, self.calm, self.slack) = (None, None, Slack::default());
        self.candidates.clear();
    }
}

impl<H: Copy + Default> CandidateMemory<H> {
    /// Replaces the candidates by those that `find` adds, and sorts them. Subshapes that were there
    /// before keep their hints.
    pub(super) fn replace(&mut self, find: impl FnOnce(&mut Vec<Candidate<H>>)) {
        let old_count = self.candidates.len();
        find(&mut self.candidates);
        let (old, new) = self.candidates.split_at_mut(old_count);
        // One number compares faster than two.
        new.sort_unstable_by_key(|candidate| {
            let [one, two] = candidate.subshapes.map(u64::from);
            one << 32 | two
        });
        let mut old = old.iter().peekable();
        for candidate in new {
            while old.next_if(|old| old.subshapes < candidate.subshapes).is_some() {}
            if let Some(old) = old.next_if(|old| old.subshapes == candidate.subshapes) {
                candidate.hint = old.hint;
            }
        }
        self.candidates.drain(..old_count);
    }
}

/// Greatest use of memory by the last queries: the memory to keep.
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct HighWaterMark {
    peak: usize,
    /// Queries since as much was used.
    age: u32,
    has_given_back: bool,
    /// Times that memory was given back too soon.
    regrets: u8,
}

impl HighWaterMark {
    /// Queries until a quarter of the memory is given back, doubled at each regret. Higher: memory
    /// is kept longer; lower: allocations where contacts come and go.
    const PATIENCE: u32 = 64;
    /// Greatest number of regrets. Higher: memory is kept longer. Lower: a thread with many light
    /// pairs and a heavy one allocates in each step.
    const MOST_REGRETS: u8 = 8;

    /// Notes what a query has used. Returns a limit if it is time to keep less.
    pub(super) fn update(&mut self, used: usize) -> Option<usize> {
        self.age += 1;
        if used >= self.peak {
            if used > self.peak && std::mem::take(&mut self.has_given_back) {
                self.regrets = (self.regrets + 1).min(Self::MOST_REGRETS);
            }
            (self.peak, self.age) = (used, 0);
        } else if self.age >= Self::PATIENCE << self.regrets {
            (self.peak, self.age) = (used.max(self.peak - self.peak.div_ceil(4)), 0);
            self.has_given_back = true;
            return Some(self.peak);
        }
        None
    }
}

/// Returns the state in `workspace`, or a new one after a call of `new_pair`.
///
/// Drops the manifolds of a pair *without* a workspace: a host removes it when a shape changes, and
/// triangles may have other numbers now. Manifolds of another dispatcher (a restored snapshot,
/// stock before) are kept: the shapes are the same.
pub(super) fn state_in<'a, M, C, S, H>(
    workspace: &'a mut Option<ContactManifoldsWorkspace>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    new_pair: impl FnOnce(),
) -> &'a mut PairState<S, H>
where
    PairState<S, H>: WorkspaceData + Default,
{
    if workspace.is_none() {
        manifolds.clear();
    }
    let is_ours = |workspace: &ContactManifoldsWorkspace| workspace.0.is::<PairState<S, H>>();
    if !workspace.as_ref().is_some_and(is_ours) {
        new_pair();
        *workspace = Some(PairState::<S, H>::default().into());
    }
    let state = workspace.as_mut().and_then(|workspace| workspace.0.downcast_mut());
    state.expect("the workspace was made of this type just now")
}

/// Stands for our state in a snapshot: an empty workspace of Parry's.
///
/// Parry can store only its own kinds of workspace; a custom one makes the whole snapshot
/// unreadable. The next query replaces this one, and keeps the manifolds.
static PLACEHOLDER: LazyLock<VoxelsShapeContactManifoldsWorkspace<2>> =
    LazyLock::new(VoxelsShapeContactManifoldsWorkspace::new);

impl<S, H> WorkspaceData for PairState<S, H>
where
    S: Clone + Send + Sync + 'static,
    H: Clone + Send + Sync + 'static,
{
    fn as_typed_workspace_data(&self) -> TypedWorkspaceData<'_> {
        TypedWorkspaceData::VoxelsShapeContactManifoldsWorkspace(&PLACEHOLDER)
    }

    fn clone_dyn(&self) -> Box<dyn WorkspaceData> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;
