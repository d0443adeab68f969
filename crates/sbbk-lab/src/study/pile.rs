//! The paper's second experiment on all backends: time of collision detection in the pile.

use serde::Serialize;

use super::{Progress, SamePosesPlan, SamePosesRow, same_poses};
use crate::backend::Backend;
use crate::metrics::{ErrorCount, Run, RunPlan, Runner, StepTimes, Summary, WorldState};
use crate::scene::{MonkeyPile, Scene, SceneError, SceneWorld};

/// Of so many queries of a pile one is timed: thousands are left in each step of the large piles.
pub const PILE_QUERY_STRIDE: u64 = 8;

/// How often and how long to run a pile.
#[derive(Clone, Debug)]
pub struct PilePlan {
    /// Backends that run the whole scene. Poses for the others are from the first one's run.
    pub backends: Vec<Backend>,
    /// Runs of each backend.
    pub repeats: usize,
    /// Steps, samples and their size. Samples are taken in the first run of each backend only.
    pub run: RunPlan,
    /// What to ask at the same poses, if anything.
    pub same_poses: Option<SamePosesPlan>,
}

/// What was measured on one pile.
#[derive(Clone, Debug, Serialize)]
pub struct PileStudy {
    /// Number of heads.
    pub heads: usize,
    /// What the scene calls itself.
    pub scene: String,
    /// Whether Rapier recycled contacts.
    pub contact_recycling: bool,
    /// Whole runs, one row for each backend.
    pub runs: Vec<PileRow>,
    /// All backends at the same poses: those of the last sample of the first backend's run.
    pub same_poses: Vec<SamePosesRow>,
}

/// Whole runs of one backend. Times are means over a run's timed steps, in milliseconds, summed
/// up over the runs.
#[derive(Clone, Debug, Serialize)]
pub struct PileRow {
    /// Who answered.
    pub backend: Backend,
    /// Steps of each run.
    pub steps: usize,
    /// Whole step.
    pub step: Summary,
    /// Broad phase.
    pub broad_phase: Summary,
    /// Narrow phase, queries included.
    pub narrow_phase: Summary,
    /// Broad and narrow phase: the paper's "whole time of CD process".
    pub collision_detection: Summary,
    /// Constraint solver.
    pub solver: Summary,
    /// Queries between two heads.
    pub mesh_mesh: Summary,
    /// Queries between a head and the floor.
    pub mesh_other: Summary,
    /// The world at the last sample.
    pub state: WorldState,
    /// Error of fresh answers on this backend's own trajectory.
    pub fresh: ErrorCount,
    /// Error of the answers that Rapier got.
    pub updated: ErrorCount,
}

/// Runs `scene` on the backends of `plan`; `at_end` sees each world after its last step.
///
/// Errors: the scene cannot be built.
pub fn pile(
    scene: &MonkeyPile,
    plan: &PilePlan,
    progress: &Progress,
    at_end: &mut dyn FnMut(&SceneWorld),
) -> Result<PileStudy, SceneError> {
    let mut runs: Vec<Vec<Run>> = plan.backends.iter().map(|_| Vec::new()).collect();
    for repeat in 0..plan.repeats {
        progress.phase(scene.name(), plan.run.step_count());
        let sample_every = if repeat == 0 { plan.run.sample_every } else { 0 };
        let run_plan = RunPlan { sample_every, ..plan.run };
        let ended = side_by_side(scene, &plan.backends, run_plan, progress)?;
        for ((world, run), runs) in ended.into_iter().zip(&mut runs) {
            at_end(&world);
            runs.push(run);
        }
    }
    let sample = runs.first().and_then(|runs| runs.first()?.samples.last());
    let same_poses = sample.zip(plan.same_poses.as_ref()).map(|(sample, plan)| {
        let message = format!("{}, same poses", scene.name());
        progress.phase(message, plan.repeats * plan.backends.len());
        same_poses(&sample.pairs, sample.step, plan, progress)
    });
    Ok(PileStudy {
        heads: scene.heads,
        scene: scene.name(),
        contact_recycling: scene.contact_recycling,
        runs: runs.iter().filter_map(|runs| row(runs)).collect(),
        same_poses: same_poses.unwrap_or_default(),
    })
}

/// One run on each backend, all at the same time: each step is done by one world after the other,
/// so that a slow spell of the machine meets all backends. The first one changes from step to
/// step.
fn side_by_side(
    scene: &MonkeyPile,
    backends: &[Backend],
    plan: RunPlan,
    progress: &Progress,
) -> Result<Vec<(SceneWorld, Run)>, SceneError> {
    let runners = backends.iter().map(|&backend| Runner::new(scene, backend, plan));
    let mut runners = runners.collect::<Result<Vec<Runner>, _>>()?;
    for step in 0..plan.step_count() {
        for turn in 0..runners.len() {
            let index = (step + turn) % runners.len();
            runners[index].step();
        }
        progress.step();
    }
    Ok(runners.into_iter().map(Runner::finish).collect())
}

/// `None` without runs.
fn row(runs: &[Run]) -> Option<PileRow> {
    let first = runs.first()?;
    let mean = |time: fn(&StepTimes) -> f64| Summary::of(runs.iter().map(|run| run.mean(time)));
    Some(PileRow {
        backend: first.backend,
        steps: first.times.len() + first.samples.len(),
        step: mean(|times| times.step)?,
        broad_phase: mean(|times| times.broad_phase)?,
        narrow_phase: mean(|times| times.narrow_phase)?,
        collision_detection: mean(StepTimes::collision_detection)?,
        solver: mean(|times| times.solver)?,
        mesh_mesh: mean(|times| times.mesh_mesh)?,
        mesh_other: mean(|times| times.mesh_other)?,
        state: first.samples.last().map(|sample| sample.state).unwrap_or_default(),
        fresh: first.total(|sample| sample.fresh),
        updated: first.total(|sample| sample.updated),
    })
}
