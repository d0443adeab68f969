//! A contact query: what a kind of pair implements ([`Pair`], [`PairQuery`]), and what the [pipeline](super::update) hands it.

use std::cell::Cell;
use std::thread::LocalKey;

use parry3d::math::{Pose, Real};
use parry3d::query::TrackedContact;
use sbbk_core::traverse::{DescentCounts, SlackLimits};

use super::pose::{Moving, PairPose};
use super::reduce::{ContactSummary, PatchPlan, Reduction};
use super::state::{Candidate, HighWaterMark};
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
