//! Candidates kept from query to query.
//!
//! A descent may look farther than the prediction distance, and what it finds then serves for several queries:
//! [`Slack`] says for how long. Until then no tree and no leaf is touched, and candidates that were too far
//! apart to have come within the prediction distance are not looked at either. Every candidate that could
//! touch gets the exact test, so the contacts are those of a descent.
//!
//! Dropped in a pile of 1000 heads: a separating plane between the hulls of 64 boxes of each mesh (Gilbert's algorithm)
//! before a descent halves the number of descents and takes as long, as those that find nothing end after a few tests; a
//! larger slack for pairs that do not touch makes their queries up to 1.5 times slower.

use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use sbbk_core::contact::TriangleContact;
use sbbk_core::traverse::{Placement, Slack, SlackPlan};
use sbbk_core::volumes::Sphere;

use super::candidates::Candidate;
use crate::mesh::Change;

/// The candidates of a descent and when they are still good.
#[derive(Clone, Debug)]
pub(super) struct Coherence<T> {
    /// Pose and prediction distance of the query before this one.
    last: Option<(Pose, Real)>,
    /// Whether the candidates are still good.
    slack: Slack,
    candidates: Vec<KnownCandidate<T>>,
}

/// A candidate, and how much travel it stays out of reach.
#[derive(Copy, Clone, Debug)]
pub(super) struct KnownCandidate<T> {
    pub(super) candidate: T,
    /// Its distance when it was last known, or less, plus the travel of the pair then. The travel now subtracted, a lower
    /// bound of its distance now is left.
    pub(super) clear: f64,
}

/// What a query has to do.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) enum Plan {
    /// Nothing: same pose, same prediction distance.
    Nothing,
    /// Test the known candidates, up to this margin.
    Reuse {
        /// That of the descent.
        margin: Real,
    },
    /// Descend, with this margin.
    Descend {
        /// The prediction distance plus the slack.
        margin: Real,
    },
}

impl<T> Default for Coherence<T> {
    fn default() -> Self {
        Self { last: None, slack: Slack::default(), candidates: Vec::new() }
    }
}

impl<T> Coherence<T> {
    /// Forgets everything: the shapes changed.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Decides how to answer for this pose, and remembers it. One of the shapes is in `ball` of its own frame, and that
    /// is at `placement`, as `pos12` says, in the frame of the other. `greatest_slack` is a share of the prediction
    /// distance.
    pub(super) fn plan(
        &mut self,
        ball: Sphere,
        (pos12, placement): (&Pose, Placement),
        prediction: Real,
        greatest_slack: f64,
    ) -> Plan {
        let now = (*pos12, prediction);
        if self.last.replace(now) == Some(now) {
            return Plan::Nothing;
        }
        match self.slack.plan(ball, &placement, prediction, greatest_slack) {
            SlackPlan::Reuse { margin, .. } => Plan::Reuse { margin },
            SlackPlan::Descend { margin } => {
                self.candidates.clear();
                Plan::Descend { margin }
            }
        }
    }

    /// Forgets what a change of the shapes makes worthless: the candidates, and the manifolds if their triangles are others
    /// now. If vertices moved or another dispatcher was here before, the manifolds keep their data, but no generator must take
    /// their points for its own.
    pub(super) fn follow<M, C: Default + Copy>(
        &mut self,
        change: Change,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) {
        if change != Change::Unchanged {
            self.clear();
        }
        match change {
            Change::Unchanged => {}
            Change::Unknown | Change::Deformed => {
                manifolds.iter_mut().for_each(ContactManifold::mark_shapes_deformed);
            }
            Change::Replaced => manifolds.clear(),
        }
    }

    /// What the pair has moved since the descent, along its path.
    pub(super) fn travel(&self) -> f64 {
        self.slack.travel()
    }

    /// Keeps the candidates of the descent under way, in stock order.
    pub(super) fn keep(&mut self, candidates: impl IntoIterator<Item = KnownCandidate<T>>) {
        if self.slack.margin().is_some() {
            self.candidates.extend(candidates);
        }
    }

    /// The candidates of the last descent, to raise `clear` where more is known.
    pub(super) fn candidates_mut(&mut self) -> &mut [KnownCandidate<T>] {
        &mut self.candidates
    }
}

impl Coherence<Candidate> {
    /// The candidates of the last descent that may have come within the prediction distance, in stock order.
    pub(super) fn near(&self, prediction: Real, near: &mut Vec<Candidate>) {
        let reach = f64::from(prediction) + self.travel();
        near.clear();
        let is_near = |known: &&KnownCandidate<Candidate>| known.clear <= reach;
        near.extend(self.candidates.iter().filter(is_near).map(|known| known.candidate));
    }

    /// Remembers what was found for a candidate, of the descent under way or one of [`near`](Self::near).
    #[inline]
    pub(super) fn note(&mut self, candidate: &Candidate, contact: Option<&TriangleContact>) {
        let Some(margin) = self.slack.margin() else {
            return;
        };
        let features = contact.map_or(candidate.features, |contact| Some(contact.features));
        let distance = contact.map_or(f64::from(margin), |contact| contact.distance);
        let clear = distance + self.travel();
        match self.candidates.get_mut(candidate.place as usize) {
            Some(known) => (known.candidate.features, known.clear) = (features, clear),
            None if contact.is_some() => {
                let place = self.candidates.len() as u32;
                let candidate = Candidate { features, place, ..*candidate };
                self.candidates.push(KnownCandidate { candidate, clear });
            }
            None => {}
        }
    }
}
