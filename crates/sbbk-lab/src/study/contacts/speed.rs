//! What first and steady queries cost, and whether their answers are right.

use std::time::{Duration, Instant};

use glamx::Pose3;
use rapier3d::math::Real;
use rayon::prelude::*;
use serde::Serialize;

use super::super::Progress;
use super::case::PosedCase;
use super::contest::{CONTESTANTS, Contest, Memory};
use super::errors::ContactErrors;
use super::exactness::{ExactnessRow, race_fresh};
use super::motion::{FAST, SLOW, STEP_COUNT, motion};
use crate::backend::{Backend, Question, SharedDispatcher};
use crate::metrics::{Judge, Summary};

/// One mesh against itself: first queries, and queries in motion.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedRow {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// Poses of the first queries.
    pub pose_count: usize,
    /// Motions of [`STEP_COUNT`] steps each, through some of these poses.
    pub motion_count: usize,
    /// Stock and SBBK.
    pub sides: [SpeedSide; 2],
}

/// One dispatcher.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedSide {
    /// Who answered.
    pub backend: Backend,
    /// With nothing known; to free the manifolds is part of the time.
    pub fresh: Measured,
    /// In motion by [`SLOW`] prediction distances a step, with what the query before left.
    pub slow: Measured,
    /// In motion by [`FAST`] prediction distances a step.
    pub fast: Measured,
}

/// Time and error of the same queries.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measured {
    /// Microseconds a query or nanoseconds a pair of triangles, summed up over the repeats.
    pub time: Summary,
    /// Errors of all first answers, or of those in the middle and at the end of each motion.
    pub errors: ContactErrors,
}

/// At most this many motions a mesh: those through the places of the first four approaches.
const MOTION_LIMIT: usize = 20;

/// Measures one case; its first answers were judged before.
pub(super) fn speed(
    posed: &PosedCase,
    judged: &ExactnessRow,
    contest: &Contest,
    repeats: usize,
    progress: &Progress,
) -> SpeedRow {
    let fresh = race_fresh(posed, contest, repeats);
    progress.step();
    let [slow, fast] = [SLOW, FAST].map(|share| {
        let motions = motions(posed, share);
        let times = race_steady(posed, &motions, contest, repeats);
        progress.step();
        let errors = judge_steady(posed, &motions, contest);
        [0, 1].map(|i| Measured { time: times[i], errors: errors[i] })
    });
    SpeedRow {
        mesh: posed.case.mesh.clone(),
        triangle_count: posed.case.triangle_count,
        pose_count: posed.places.len(),
        motion_count: posed.places.len().min(MOTION_LIMIT),
        sides: [0, 1].map(|i| SpeedSide {
            backend: CONTESTANTS[i],
            fresh: Measured { time: fresh[i], errors: judged.sides[i].errors },
            slow: slow[i],
            fast: fast[i],
        }),
    }
}

/// Motions through places of a case, each step this share of the prediction distance.
pub(super) fn motions(posed: &PosedCase, share: Real) -> Vec<Vec<Pose3>> {
    let step = share * posed.case.prediction;
    let places = posed.places.iter().take(MOTION_LIMIT);
    places.map(|place| motion(&posed.shape, place, step, STEP_COUNT)).collect()
}

/// Microseconds of a query in motion. The first one of each motion is not timed.
fn race_steady(
    posed: &PosedCase,
    motions: &[Vec<Pose3>],
    contest: &Contest,
    repeats: usize,
) -> [Summary; 2] {
    let PosedCase { case, shape, .. } = posed;
    contest.race(repeats, motions.len() * STEP_COUNT, |dispatcher| {
        let mut time = Duration::ZERO;
        for poses in motions {
            let mut memory = Memory::default();
            memory.ask(dispatcher, shape, &poses[0], case.prediction);
            let start = Instant::now();
            for pose in &poses[1..] {
                memory.ask(dispatcher, shape, pose, case.prediction);
            }
            time += start.elapsed();
        }
        time
    })
}

fn judge_steady(
    posed: &PosedCase,
    motions: &[Vec<Pose3>],
    contest: &Contest,
) -> [ContactErrors; 2] {
    let judge = Judge::new([&posed.shape]);
    let errors = motions.par_iter().with_max_len(1).map(|poses| {
        let judged = [STEP_COUNT / 2, STEP_COUNT];
        let questions = judged
            .map(|step| Question::new(&poses[step], [&*posed.shape; 2], posed.case.prediction));
        let truths = questions.map(|question| judge.truth(&question));
        let judge_side = |dispatcher: &SharedDispatcher| {
            let mut memory = Memory::default();
            let mut errors = ContactErrors::default();
            for (step, pose) in poses.iter().enumerate() {
                memory.ask(dispatcher, &posed.shape, pose, posed.case.prediction);
                for i in (0..judged.len()).filter(|&i| judged[i] == step) {
                    errors += ContactErrors::of(&truths[i], questions[i], &memory.manifolds);
                }
            }
            errors
        };
        contest.dispatchers.each_ref().map(judge_side)
    });
    let errors: Vec<_> = errors.collect();
    [0, 1].map(|i| errors.iter().map(|sides| sides[i]).sum())
}
