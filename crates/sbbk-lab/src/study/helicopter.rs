//! The paper's first experiment on all backends: frames per second of the ball and helicopter.

use serde::Serialize;

use super::Progress;
use super::turns::in_turn;
use crate::backend::Backend;
use crate::metrics::{ErrorCount, Run, RunPlan, Sample, StepTimes, Summary, run};
use crate::scene::{BallKind, HelicopterBallDrop, Scene, SceneError};

/// How often and how long to run the helicopter scene.
#[derive(Clone, Copy, Debug)]
pub struct HelicopterPlan {
    /// Timed runs of each backend; the paper has 30.
    pub repeats: usize,
    /// Steps of each run: the fall takes about 30, the bounces and the roll over the rotor the
    /// rest of the first two seconds.
    pub steps: usize,
}

/// One backend in the helicopter scene. Times are means over a run's steps, in milliseconds,
/// summed up over the repeats.
#[derive(Clone, Debug, Serialize)]
pub struct HelicopterRow {
    /// What the ball is made of.
    pub ball: BallKind,
    /// Who answered.
    pub backend: Backend,
    /// Steps of each run.
    pub steps: usize,
    /// Steps a second; nothing is drawn.
    pub frames_per_second: Summary,
    /// Broad and narrow phase.
    pub collision_detection: Summary,
    /// The queries of the ball and the helicopter alone.
    pub queries: Summary,
    /// Error of fresh answers, in a run of its own (see [`Sample::fresh`]).
    pub fresh: ErrorCount,
    /// Error of the answers that Rapier got, in that run (see [`Sample::updated`]).
    pub updated: ErrorCount,
}

/// Runs `scene` on the given backends in turn.
///
/// Errors: the scene cannot be built.
pub fn helicopter(
    scene: &HelicopterBallDrop,
    backends: &[Backend],
    plan: &HelicopterPlan,
    progress: &Progress,
) -> Result<Vec<HelicopterRow>, SceneError> {
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let timed = RunPlan { warm_up: 1, steps: plan.steps, ..RunPlan::default() };
    // One mesh pair: every other step can be judged.
    let judged = RunPlan { sample_every: 2, sample_size: 1, ..timed };
    let runs = in_turn(backends, plan.repeats, |&backend, _| {
        progress.step();
        run(scene, backend, timed)
    })?;
    let mut rows = Vec::new();
    for (&backend, runs) in backends.iter().zip(&runs) {
        let judged = run(scene, backend, judged)?;
        progress.step();
        rows.extend(row(scene.ball, runs, &judged));
    }
    Ok(rows)
}

/// `None` without runs.
fn row(ball: BallKind, runs: &[Run], judged: &Run) -> Option<HelicopterRow> {
    let mean = |time: fn(&StepTimes) -> f64| Summary::of(runs.iter().map(|run| run.mean(time)));
    Some(HelicopterRow {
        ball,
        backend: judged.backend,
        steps: runs.first()?.times.len(),
        frames_per_second: Summary::of(runs.iter().map(Run::frames_per_second))?,
        collision_detection: mean(StepTimes::collision_detection)?,
        queries: mean(|times| times.mesh_mesh + times.mesh_other)?,
        fresh: judged.total(|sample: &Sample| sample.fresh),
        updated: judged.total(|sample: &Sample| sample.updated),
    })
}
