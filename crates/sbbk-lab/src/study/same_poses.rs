//! The same questions to every backend.

use std::convert::Infallible;
use std::time::Duration;

use serde::Serialize;

use super::Progress;
use super::turns::in_turn;
use crate::backend::{Backend, Primed, SharedDispatcher};
use crate::metrics::{ErrorCount, Judge, PosePairs, Summary, Sweep, sample_indices};

/// One backend asked about all mesh pairs of one moment of a run.
#[derive(Clone, Debug, Serialize)]
pub struct SamePosesRow {
    /// Who answered.
    pub backend: Backend,
    /// Step of the stock run from which the poses are.
    pub step: usize,
    /// Number of mesh pairs asked.
    pub pair_count: usize,
    /// All pairs, nothing known about them: milliseconds, summed up over the repeats.
    pub fresh: Summary,
    /// All pairs a step later, their last contacts known.
    pub steady: Summary,
    /// Error of the fresh answers, on sampled pairs.
    pub fresh_error: ErrorCount,
    /// Error of the steady answers, on the same pairs.
    pub steady_error: ErrorCount,
}

/// How often to ask, and how much to judge.
#[derive(Clone, Copy, Debug)]
pub struct SamePosesPlan {
    /// Who is asked, in turn.
    pub backends: [Backend; 4],
    /// How often each is asked about all pairs.
    pub repeats: usize,
    /// At most this many pairs are judged.
    pub sample_size: usize,
}

/// Asks the backends about all of `pairs`, captured at `step`.
pub fn same_poses(
    pairs: &PosePairs,
    step: usize,
    plan: &SamePosesPlan,
    progress: &Progress,
) -> Vec<SamePosesRow> {
    let dispatchers = plan.backends.map(Backend::dispatcher);
    let _primed = dispatchers.each_ref().map(|dispatcher| Primed::new(dispatcher, pairs.shapes()));
    let errors = judge_all(pairs, &dispatchers, plan.sample_size);
    let Ok(sweeps) = in_turn(&dispatchers, plan.repeats, |dispatcher, _| {
        progress.step();
        Ok::<_, Infallible>(pairs.sweep(dispatcher))
    });
    let answered = plan.backends.into_iter().zip(sweeps).zip(errors);
    answered
        .filter_map(|((backend, sweeps), [fresh_error, steady_error])| {
            Some(SamePosesRow {
                backend,
                step,
                pair_count: pairs.pair_count(),
                fresh: milliseconds(&sweeps, |sweep| sweep.fresh)?,
                steady: milliseconds(&sweeps, |sweep| sweep.steady)?,
                fresh_error,
                steady_error,
            })
        })
        .collect()
}

fn milliseconds(sweeps: &[Sweep], time: impl Fn(&Sweep) -> Duration) -> Option<Summary> {
    Summary::of(sweeps.iter().map(|sweep| 1e3 * time(sweep).as_secs_f64()))
}

/// Fresh and steady error of each dispatcher; the truth of each question is worked out once.
fn judge_all(
    pairs: &PosePairs,
    dispatchers: &[SharedDispatcher],
    sample_size: usize,
) -> Vec<[ErrorCount; 2]> {
    let judge = Judge::new(pairs.shapes());
    let mut errors = vec![[ErrorCount::default(); 2]; dispatchers.len()];
    for index in sample_indices(pairs.pair_count(), sample_size) {
        let truths = [0, 1].map(|pose_index| judge.truth(&pairs.question(index, pose_index)));
        for (dispatcher, errors) in dispatchers.iter().zip(&mut errors) {
            let answers = pairs.answers(dispatcher, index);
            for ((answer, truth), error) in answers.iter().zip(&truths).zip(errors) {
                *error += truth.judge(answer);
            }
        }
    }
    for error in errors.iter_mut().flatten() {
        error.sampled_from = pairs.pair_count();
    }
    errors
}
