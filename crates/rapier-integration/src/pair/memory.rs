//! What a pair keeps from query to query, besides what it knows of its shapes.
//!
//! A descent may look farther than the prediction distance, and what it finds then serves for
//! several queries: [`Slack`] says for how long. Until then no hierarchy is touched, and candidates
//! that cannot have come within the prediction distance are skipped. Each of the others gets the
//! exact test, so the contacts are those of a descent.
//!
//! Dropped in a pile of 1000 heads: a separating plane between the hulls of 64 boxes of each mesh
//! (Gilbert's algorithm) before a descent halves the number of descents and takes as long, as those
//! that find nothing end after a few tests; a larger slack for pairs that do not touch makes their
//! queries up to 1.5 times slower.

use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use sbbk_core::traverse::Slack;

use super::merge::{Lookup, are_in_place};
use super::order::Candidate;
use super::pool::Demand;
use super::pose::PairPose;
use crate::mesh::Change;

/// The memory of a pair whose candidates have hints `H`. Losing it costs time only.
#[derive(Clone)]
pub(super) struct PairMemory<H> {
    pub(super) coherence: Coherence<H>,
    demand: Demand,
}

/// What the last queries found.
#[derive(Clone)]
pub(super) struct Coherence<H> {
    last: Option<Answered>,
    /// Whether no query is under way.
    is_whole: bool,
    /// Until when the candidates serve.
    pub(super) slack: Slack,
    /// Those of the last descent, in the order of subshapes.
    pub(super) candidates: Vec<Candidate<H>>,
    /// See [`PairQuery::settle`](super::driver::PairQuery::settle).
    pub(super) outside: f64,
}

/// A query, and how many manifolds it left.
#[derive(Copy, Clone, Debug, PartialEq)]
struct Answered {
    pos12: Pose,
    prediction: Real,
    manifold_count: usize,
}

impl<H> Default for PairMemory<H> {
    fn default() -> Self {
        Self { coherence: Coherence::default(), demand: Demand::default() }
    }
}

impl<H> Default for Coherence<H> {
    fn default() -> Self {
        let outside = f64::NEG_INFINITY;
        Self { last: None, is_whole: false, slack: Slack::default(), candidates: vec![], outside }
    }
}

impl<H> PairMemory<H> {
    /// Forgets what a change of the shapes makes worthless: the candidates, and the manifolds if
    /// their triangles are others now. Where only vertices moved, or another dispatcher answered
    /// before, manifolds keep their data.
    pub(super) fn follow<M, C: Default + Copy>(
        &mut self,
        change: Change,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) {
        match change {
            Change::Unchanged => return,
            Change::Unknown | Change::Deformed => {}
            Change::Replaced => manifolds.clear(),
        }
        self.coherence = Coherence::default();
    }

    /// Ends a query, which has left so many manifolds.
    pub(super) fn end(&mut self, pose: &PairPose, manifold_count: usize) {
        let Coherence { last, is_whole, candidates, .. } = &mut self.coherence;
        (*last, *is_whole) = (Some(Answered::new(pose, manifold_count)), true);
        if let Some(limit) = self.demand.note(candidates.len()) {
            candidates.shrink_to(limit);
        }
    }
}

impl<H> Coherence<H> {
    /// Whether the last query asked the same and left as many manifolds.
    pub(super) fn is_answered(&self, pose: &PairPose, manifold_count: usize) -> bool {
        self.is_whole && self.last == Some(Answered::new(pose, manifold_count))
    }

    /// Begins a query. If the one before was cut short, by a panic of a type of the host, what it has
    /// left half done is forgotten.
    pub(super) fn begin(&mut self) -> &mut Self {
        if !std::mem::take(&mut self.is_whole) {
            *self = Self::default();
        }
        self
    }
}

impl<H: Copy + Default + PartialEq> Coherence<H> {
    /// Replaces the candidates by those that `find` adds, in the order of subshapes. What was known
    /// of the same subshapes is handed on.
    pub(super) fn find(&mut self, lookup: &mut Lookup, find: impl FnOnce(&mut Vec<Candidate<H>>)) {
        let old_count = self.candidates.len();
        find(&mut self.candidates);
        let (old, new) = self.candidates.split_at_mut(old_count);
        new.sort_unstable_by_key(|candidate| candidate.subshapes);
        lookup.hand_on(old, new);
        self.candidates.drain(..old_count);
    }

    /// Makes sure that candidates know the places of their manifolds in the host's list, which a
    /// host may have changed since, and of which a lost memory knows nothing.
    pub(super) fn find_places<M, C>(
        &mut self,
        lookup: &mut Lookup,
        manifolds: &[ContactManifold<M, C>],
    ) {
        let has_as_many = self.last.is_some_and(|last| last.manifold_count == manifolds.len());
        if !has_as_many || !are_in_place(manifolds, &self.candidates) {
            lookup.find_places(manifolds, &mut self.candidates);
        }
    }
}

impl Answered {
    fn new(pose: &PairPose, manifold_count: usize) -> Self {
        Self { pos12: pose.pos12, prediction: pose.prediction, manifold_count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch an answer taken for that of another question, of a query that was cut short, or of
    /// a host that has removed manifolds since; and what such a query left half done.
    #[test]
    fn only_the_question_that_was_answered_is() {
        let pose = |x: Real, prediction| PairPose::new(&Pose::translation(x, 0.0, 0.0), prediction);
        let mut memory = PairMemory::<()>::default();
        assert!(!memory.coherence.is_answered(&pose(1.0, 0.1), 0));
        memory.coherence.begin().candidates.push(Candidate::new([1, 2]));
        memory.end(&pose(1.0, 0.1), 3);
        let is_answered = |memory: &PairMemory<()>, x, prediction, count| {
            memory.coherence.is_answered(&pose(x, prediction), count)
        };
        assert!(is_answered(&memory, 1.0, 0.1, 3) && !is_answered(&memory, 1.0, 0.1, 2));
        assert!(!is_answered(&memory, 1.1, 0.1, 3) && !is_answered(&memory, 1.0, 0.2, 3));
        assert_eq!(memory.coherence.begin().candidates.len(), 1);
        assert!(!is_answered(&memory, 1.0, 0.1, 3), "it has not ended");
        assert!(memory.coherence.begin().candidates.is_empty());
    }

    /// Would catch candidates of one great overlap whose memory a pair keeps for ever.
    #[test]
    fn memory_of_candidates_is_given_back() {
        let mut memory = PairMemory::<()>::default();
        let pose = PairPose::new(&Pose::IDENTITY, 0.1);
        let mut query = |count: u32| {
            let candidates = &mut memory.coherence.begin().candidates;
            candidates.clear();
            candidates.extend((0..count).map(|i| Candidate::new([i, 0])));
            memory.end(&pose, 0);
            memory.coherence.candidates.capacity()
        };
        assert!(query(1000) >= 1000 && query(0) >= 1000);
        assert!((0..3000).map(|_| query(0)).last() < Some(10));
    }
}
