//! What the kinds of pairs have in common: a [`Pair`] says what is particular to its kind in steps 1
//! and 2 of the way of a query ([`answer`](super::answer)), its [`PairQuery`] in the others.

use std::sync::Arc;

use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use sbbk_core::traverse::{Counters, DescentScratch, Placement, SlackLimits};
use sbbk_core::volumes::Sphere;

use super::convex::{GhostContacts, PartContact, PlacedPart};
use super::merge::Lookup;
use super::order::Candidate;
use super::outline::{Outline, PatchPlan, Patches};
use super::pool::{Demand, ManifoldPool};
use super::pose::PairPose;
use super::triangles::{Found, Regions};
use crate::mesh::{Change, TreeCache};

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

    /// How much farther than [`reach`](Self::reach) descents may look.
    const SLACK: SlackLimits;

    fn pose(&self) -> &PairPose;

    /// What moves, as the slack of descents has it.
    fn moving(&self) -> Moving<'_>;

    /// The distance up to which there may be contacts.
    fn reach(&self) -> Real {
        self.pose().prediction
    }

    /// Where contacts cost less than to keep candidates does: replaces `manifolds` by one for each, and
    /// keeps nothing. Whether it has.
    fn write_at_once<M, C>(
        &self,
        _: &mut impl Counters,
        _: &mut Scratch,
        _: &mut ManifoldPool<M, C>,
        _: &mut Vec<ContactManifold<M, C>>,
    ) -> bool
    where
        M: Default + 'static,
        C: Default + Copy + 'static,
    {
        false
    }

    /// Adds all candidates within `margin`, and few others, in any order.
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

    /// Makes contacts, now that all are known, those of the shapes as a whole: some are along other
    /// normals than their own, and what is inside of something has one that takes it out. It may be of a
    /// new candidate. `outside` is a lower bound of the travel of the pair at which it may be needed.
    fn settle(
        &mut self,
        candidates: &mut Vec<Candidate<Self::Hint>>,
        contacts: &mut ContactList<Self::Contact>,
        limits: Limits,
        outside: &mut f64,
        scratch: &mut Scratch,
    );

    /// Memory for contacts, lent from query to query.
    fn contacts(scratch: &mut Scratch) -> &mut [ContactList<Self::Contact>; 2];

    /// How patches are made; `None` if every contact has a manifold.
    fn patch_plan(&self, contacts: &[(u32, Self::Contact)]) -> Option<PatchPlan>;

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

/// A ball around the shape that moves, in its own frame, and the pose of that frame in the other's.
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
    /// Triangles that a walk has found.
    pub(super) near: Vec<u32>,
    /// Where surfaces cross.
    pub(super) regions: Regions,
    pub(super) triangle_contacts: [ContactList<Found>; 2],
    pub(super) convex_contacts: [ContactList<PartContact>; 2],
    pub(super) patches: Patches,
    pub(super) ghosts: GhostContacts,
    pub(super) lookup: Lookup,
    /// Which manifolds of the query before are dealt with.
    pub(super) is_done: Vec<bool>,
    pub(super) demand: Demand,
}

impl Scratch {
    /// Gives back memory beyond so many contacts. Candidates come and go more than these do: some hundred
    /// kilobytes a thread stay.
    pub(super) fn shrink_to(&mut self, limit: usize) {
        let Self { near, regions, patches, ghosts, lookup, is_done, .. } = self;
        let many = limit.max(1024);
        shrink(&mut self.triangle_contacts, many);
        shrink(&mut self.convex_contacts, many);
        shrink([near], many);
        regions.shrink_to(many);
        patches.shrink_to(limit);
        ghosts.shrink_to(limit);
        lookup.shrink_to(limit);
        is_done.shrink_to(limit);
    }
}

/// Gives back memory of lists whose content has served.
fn shrink<'a, T: 'a>(lists: impl IntoIterator<Item = &'a mut Vec<T>>, limit: usize) {
    for list in lists {
        list.clear();
        list.shrink_to(limit);
    }
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
