//! Soft heads on a rigid helicopter, stock beside SBBK.

use serde::Serialize;

use super::plan::SoftPlan;
use crate::backend::Backend;
use crate::metrics::{ErrorCount, Judge, StepTimes, Summary, timed_step};
use crate::scene::{Scene, SceneError, SoftHeads};
use crate::study::Progress;
use crate::study::turns::in_turn;

/// One backend with soft heads. Times are means over the steps of a run, in milliseconds, summed up over the repeats.
#[derive(Clone, Debug, Serialize)]
pub struct SoftHeadsRow {
    /// Who answered.
    pub backend: Backend,
    /// The whole step.
    pub step: Summary,
    /// The queries of heads and helicopter.
    pub queries: Summary,
    /// Milliseconds of these queries in each step, the median over the repeats.
    pub queries_by_step: Vec<f64>,
    /// Queries in all steps of a run.
    pub calls: u64,
    /// Of the answers that Rapier got in the judged run, against the vertices of that step.
    pub errors: ErrorCount,
}

/// Runs the scene under both backends, in turn.
pub(super) fn soft_heads(
    scene: &SoftHeads,
    plan: &SoftPlan,
    progress: &Progress,
) -> Result<Vec<SoftHeadsRow>, SceneError> {
    let backends = [Backend::Stock, Backend::Sbbk];
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let runs = in_turn(&backends, plan.repeats, |&backend, _| {
        progress.step();
        let mut built = scene.build()?;
        let installed = backend.install(&mut built.world);
        let step = |_| timed_step(&mut built.world, &installed.probe);
        Ok::<Vec<StepTimes>, SceneError>((0..plan.steps).map(step).collect())
    })?;
    let mut rows = Vec::new();
    for (&backend, runs) in backends.iter().zip(&runs) {
        let errors = judged(scene, backend, plan)?;
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| {
            let of_run =
                |run: &Vec<StepTimes>| run.iter().map(time).sum::<f64>() / run.len() as f64;
            Summary::of(runs.iter().map(of_run))
        };
        if let (Some(step), Some(queries)) = (mean(|t| t.step), mean(|t| t.mesh_mesh)) {
            let calls = runs[0].iter().map(|times| times.mesh_mesh_calls).sum();
            let in_step = |step: usize| Summary::of(runs.iter().map(|run| run[step].mesh_mesh));
            let queries_by_step = (0..plan.steps).filter_map(in_step).map(|times| times.median);
            let queries_by_step = queries_by_step.collect();
            rows.push(SoftHeadsRow { backend, step, queries, queries_by_step, calls, errors });
        }
    }
    Ok(rows)
}

/// The answers of some steps, judged by the vertices at the start of the step, where Rapier asks.
fn judged(scene: &SoftHeads, backend: Backend, plan: &SoftPlan) -> Result<ErrorCount, SceneError> {
    let mut built = scene.build()?;
    let installed = backend.install(&mut built.world);
    let mut errors = ErrorCount::default();
    for step in 1..=plan.steps {
        if !step.is_multiple_of(plan.judged_every) {
            built.world.step();
            continue;
        }
        let shapes = built.world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let judge = Judge::new(shapes);
        installed.probe.start_recording();
        built.world.step();
        for answer in installed.probe.take_answers() {
            errors += judge.truth(&answer.question).judge(&answer);
        }
    }
    Ok(errors)
}
