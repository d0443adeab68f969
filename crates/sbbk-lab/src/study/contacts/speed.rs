//! What first and steady queries cost, and whether their answers are right.

use std::time::{Duration, Instant};

use glamx::Pose3;
use rapier3d::math::Real;
use rayon::prelude::*;
use serde::Serialize;

use super::super::Progress;
use super::case::PosedCase;
use super::contest::{Contest, Memory};
use super::errors::ContactErrors;
use super::exactness::{ExactnessRow, race_fresh};
use super::motion::{FAST, SLOW, STEP_COUNT, motion};
use super::side::{Measured, Side};
use crate::backend::{Question, SharedDispatcher};
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
    pub sides: [Side<ContactErrors>; 2],
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
    let errors = judged.sides.each_ref().map(|side| side.errors);
    let fresh = Measured::both(fresh, errors);
    let [slow, fast] = [SLOW, FAST].map(|share| {
        let motions = motions(posed, share);
        let times = race_steady(posed, &motions, contest, repeats);
        progress.step();
        Measured::both(times, judge_steady(posed, &motions, contest))
    });
    SpeedRow {
        mesh: posed.case.mesh.clone(),
        triangle_count: posed.case.triangle_count,
        pose_count: posed.places.len(),
        motion_count: posed.places.len().min(MOTION_LIMIT),
        sides: Side::both([fresh, slow, fast]),
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
