//! Every answer of both dispatchers against brute force.

use std::ops::AddAssign;
use std::time::Instant;

use rapier3d::geometry::SharedShape;
use rayon::prelude::*;
use serde::Serialize;

use super::super::Progress;
use super::case::{ContactCase, PosedCase};
use super::contest::{CONTESTANTS, Contest, Memory};
use super::errors::ContactErrors;
use crate::backend::{Backend, Question, SharedDispatcher};
use crate::metrics::{Judge, Summary};

/// One case: what is true, and what both dispatchers answer when asked with nothing known.
#[derive(Clone, Debug, Serialize)]
pub struct ExactnessRow {
    /// What was asked.
    #[serde(flatten)]
    pub case: ContactCase,
    /// At how many poses.
    pub pose_count: usize,
    /// True pairs of triangles that are apart.
    pub apart: usize,
    /// True pairs of triangles that touch or cross.
    pub crossing: usize,
    /// Stock and SBBK.
    pub sides: [ExactnessSide; 2],
}

/// The answers of one dispatcher in one case.
#[derive(Clone, Debug, Serialize)]
pub struct ExactnessSide {
    /// Who answered.
    pub backend: Backend,
    /// Microseconds a query, the mean over the poses, summed up over the repeats; to free the
    /// manifolds is part of it.
    pub query: Summary,
    /// What is wrong.
    pub errors: ContactErrors,
}

/// What was found at one pose.
#[derive(Clone, Copy, Default)]
struct Found {
    apart: usize,
    crossing: usize,
    errors: [ContactErrors; 2],
}

/// True pairs in all repeats of a case together: the few cases with hundreds of thousands of
/// contacts, for which stock Parry takes seconds a query, are timed once.
const REPEATED_PAIRS: usize = 500_000;

/// Judges on all cores, then takes the times on one.
pub(super) fn exactness(
    cases: &[PosedCase],
    contest: &Contest,
    repeats: usize,
    progress: &Progress,
) -> Vec<ExactnessRow> {
    let found = judge_all(cases, contest, progress);
    progress.phase("exactness: times", cases.len());
    let rows = cases.iter().zip(found).map(|(posed, found)| {
        progress.step();
        let affordable = REPEATED_PAIRS / (found.apart + found.crossing).max(1);
        let times = race_fresh(posed, contest, affordable.clamp(1, repeats.max(1)));
        let sides = [0, 1].map(|i| ExactnessSide {
            backend: CONTESTANTS[i],
            query: times[i],
            errors: found.errors[i],
        });
        let Found { apart, crossing, .. } = found;
        let pose_count = posed.places.len();
        ExactnessRow { case: posed.case.clone(), pose_count, apart, crossing, sides }
    });
    rows.collect()
}

/// Microseconds of a first query, see [`ExactnessSide::query`].
pub(super) fn race_fresh(posed: &PosedCase, contest: &Contest, repeats: usize) -> [Summary; 2] {
    let PosedCase { case, shape, places } = posed;
    contest.race(repeats, places.len(), |dispatcher| {
        let start = Instant::now();
        for place in places {
            Memory::default().ask(dispatcher, shape, &place.pos12, case.prediction);
        }
        start.elapsed()
    })
}

/// By case. Poses are judged apart from each other, so that no core waits for a large case.
fn judge_all(cases: &[PosedCase], contest: &Contest, progress: &Progress) -> Vec<Found> {
    let judge = Judge::new(cases.iter().map(|posed| &posed.shape));
    let poses: Vec<_> = (cases.iter().enumerate())
        .flat_map(|(index, posed)| posed.places.iter().map(move |place| (index, place.pos12)))
        .collect();
    progress.phase("exactness: brute force", poses.len());
    let found = poses.par_iter().with_max_len(1).map(|&(index, pos12)| {
        let PosedCase { case, shape, .. } = &cases[index];
        let question = Question::new(&pos12, [&**shape; 2], case.prediction);
        let found = judge_pose(&judge, &contest.dispatchers, shape, question);
        progress.step();
        (index, found)
    });
    let mut by_case = vec![Found::default(); cases.len()];
    for (index, found) in found.collect::<Vec<_>>() {
        by_case[index] += found;
    }
    by_case
}

fn judge_pose(
    judge: &Judge,
    dispatchers: &[SharedDispatcher; 2],
    shape: &SharedShape,
    question: Question,
) -> Found {
    let Question { pos12, prediction, .. } = question;
    let truth = judge.truth(&question);
    let errors = dispatchers.each_ref().map(|dispatcher| {
        let mut memory = Memory::default();
        memory.ask(dispatcher, shape, &pos12, prediction);
        ContactErrors::of(&truth, question, &memory.manifolds)
    });
    let crossing = truth.contacts().filter(|pair| pair.distance <= 0.0).count();
    Found { apart: errors[0].pairs.true_pairs - crossing, crossing, errors }
}

impl AddAssign for Found {
    fn add_assign(&mut self, other: Self) {
        self.apart += other.apart;
        self.crossing += other.crossing;
        for (errors, other) in self.errors.iter_mut().zip(other.errors) {
            *errors += other;
        }
    }
}
