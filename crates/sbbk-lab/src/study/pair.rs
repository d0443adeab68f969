//! Stock Parry and SBBK, asked about the same pairs of shapes in turn: of two meshes, for the contacts
//! of each two triangles.
//!
//! Dispatchers are called as the narrow phase calls them, but directly: contact skins, soft-CCD
//! margins and contact recycling are Rapier's, and have no part in it.

use std::time::Duration;

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rayon::prelude::*;

use super::turns::{race, timed};
use crate::backend::{Backend, Dispatcher, Memory, Primed, Question, SharedDispatcher};
use crate::metrics::{ContactErrors, Judge, Summary, Truth};

/// How dispatchers are called, for notes.
pub(super) const DIRECT_NOTE: &str = "dispatchers called directly: contact skins and contact \
                                      recycling, which are Rapier's, have no part in it; all \
                                      contacts of triangles, not those of surfaces alone";

/// Stock and SBBK, the trees built that SBBK builds unasked.
pub(super) struct Contest {
    pub dispatchers: [Dispatcher; 2],
    _primed: [Primed; 2],
}

/// Two shapes, asked for their contacts at one pose after the other, each with what the query
/// before left.
pub(super) struct Sequence<'a> {
    pub shapes: [&'a SharedShape; 2],
    pub poses: Vec<Pose3>,
    pub prediction: Real,
}

impl Contest {
    /// Whom the dispatchers are of.
    pub const BACKENDS: [Backend; 2] = [Backend::Stock, Backend::Sbbk];

    pub fn new<'a>(shapes: impl IntoIterator<Item = &'a SharedShape> + Clone) -> Self {
        let dispatchers = Self::BACKENDS.map(Backend::per_triangle);
        let primed = dispatchers.each_ref().map(|d| Primed::new(d, shapes.clone()));
        Self { dispatchers, _primed: primed }
    }

    pub fn sbbk(&self) -> &SharedDispatcher {
        &self.dispatchers[1]
    }

    /// Microseconds a query of both.
    pub fn race(&self, repeats: usize, sequences: &[Sequence]) -> Vec<Summary> {
        race(&self.dispatchers, repeats, 1e6 / query_count(sequences), |dispatcher| {
            sweep(dispatcher, sequences)
        })
    }

    /// Errors of both, where `truth` tells it of a step of a sequence, both by their numbers.
    pub fn errors(
        &self,
        sequences: &[Sequence],
        truth: impl Fn(usize, usize) -> Option<Truth> + Sync,
    ) -> [ContactErrors; 2] {
        errors(self.dispatchers.each_ref().map(|dispatcher| &dispatcher.shared), sequences, truth)
    }

    /// Errors of both in some steps of sequences of meshes.
    pub fn mesh_errors(
        &self,
        sequences: &[Sequence],
        is_judged: impl Fn(usize) -> bool + Sync,
    ) -> [ContactErrors; 2] {
        self.errors(sequences, |index, step| is_judged(step).then(|| sequences[index].truth(step)))
    }
}

/// Errors of each dispatcher, where `truth` tells it of a step of a sequence, both by their numbers.
pub(super) fn errors<const N: usize>(
    dispatchers: [&SharedDispatcher; N],
    sequences: &[Sequence],
    truth: impl Fn(usize, usize) -> Option<Truth> + Sync,
) -> [ContactErrors; N] {
    let of_sequence = |(index, sequence): (usize, &Sequence)| {
        let steps = (0..sequence.poses.len()).into_par_iter().with_max_len(1);
        let truths: Vec<Option<Truth>> = steps.map(|step| truth(index, step)).collect();
        dispatchers.map(|dispatcher| {
            let mut errors = ContactErrors::default();
            sequence.walk(dispatcher, |step, manifolds| {
                errors += (truths[step].iter()).map(|t| t.judge_manifolds(manifolds)).sum();
            });
            errors
        })
    };
    let errors = sequences.par_iter().enumerate().with_max_len(1).map(of_sequence);
    let errors: Vec<[ContactErrors; N]> = errors.collect();
    std::array::from_fn(|side| errors.iter().map(|sides| sides[side]).sum())
}

/// Number of queries that [`sweep`] times.
pub(super) fn query_count(sequences: &[Sequence]) -> f64 {
    sequences.iter().map(|sequence| (sequence.poses.len() - 1).max(1)).sum::<usize>() as f64
}

/// Time of all queries but the first of each sequence; of that, if it is the only one, and then
/// with the time to free the manifolds.
pub(super) fn sweep(dispatcher: &SharedDispatcher, sequences: &[Sequence]) -> Duration {
    let time = |sequence: &Sequence| {
        let mut memory = Memory::default();
        let mut ask = |pose: &Pose3| sequence.ask(&mut memory, dispatcher, pose);
        match &sequence.poses[..] {
            [pose] => timed(|| sequence.ask(&mut Memory::default(), dispatcher, pose)).0,
            [first, rest @ ..] => {
                ask(first);
                timed(|| rest.iter().for_each(ask)).0
            }
            [] => Duration::ZERO,
        }
    };
    sequences.iter().map(time).sum()
}

impl Sequence<'_> {
    /// The truth about a step of two meshes.
    fn truth(&self, step: usize) -> Truth {
        let shapes = self.shapes.map(|shape| &**shape);
        let question = Question::new(&self.poses[step], shapes, self.prediction);
        Judge::new(self.shapes).truth(&question)
    }

    fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, pose: &Pose3) {
        memory.ask(dispatcher, self.shapes.map(|shape| &**shape), pose, self.prediction);
    }

    /// Asks everything, and shows the manifolds after each query, by its number.
    pub fn walk(
        &self,
        dispatcher: &SharedDispatcher,
        mut seen: impl FnMut(usize, &[ContactManifold]),
    ) {
        let mut memory = Memory::default();
        for (index, pose) in self.poses.iter().enumerate() {
            self.ask(&mut memory, dispatcher, pose);
            seen(index, &memory.manifolds);
        }
    }
}
