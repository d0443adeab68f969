//! The paper's second experiment: time of collision detection in a pile of heads.
//!
//! Two runs of one scene soon differ, as chaos turns a different last bit into another trajectory.
//! So the same pairs at the same poses are timed as well.

use super::turns::{in_turn, timed};
use crate::metrics::{Run, RunPlan, Runner};
use crate::prelude::*;

/// Study of the rows of whole runs.
pub const RUNS: &str = "pile, whole runs";
const SAME_POSES: &str = "pile, same poses";

/// Runs of a pile.
#[derive(Clone, Debug)]
pub struct PilePlan {
    /// Backends that run the whole scene. The first one gives the poses for all.
    pub backends: Vec<Backend>,
    /// Runs of each backend.
    pub repeats: usize,
    /// Steps, samples and their size. Only the first run of each backend is sampled.
    pub run: RunPlan,
    /// Sweeps of each backend over all pairs at the same poses, if any.
    pub same_poses: usize,
}

/// Pairs at the same poses that are judged at most.
const JUDGED: usize = 200;

impl PilePlan {
    /// Steps until the lowest heads land.
    pub const FREE_FALL: usize = 27;
}

/// Runs `scene` on the backends of `plan`. Times are means over the timed steps of a run, in
/// milliseconds, summed up over the runs.
pub fn pile(scene: &MonkeyPile, plan: &PilePlan, progress: &Progress) -> Vec<Row> {
    let mut runs: Vec<Vec<Run>> = plan.backends.iter().map(|_| Vec::new()).collect();
    for repeat in 0..plan.repeats {
        progress.phase(scene.name(), plan.run.step_count());
        let sample_every = if repeat == 0 { plan.run.sample_every } else { 0 };
        let run_plan = RunPlan { sample_every, ..plan.run };
        let ended = side_by_side(scene, &plan.backends, run_plan, progress);
        ended.into_iter().zip(&mut runs).for_each(|(run, runs)| runs.push(run));
    }
    let mut rows: Vec<Row> = runs.iter().map(|runs| row(scene, runs)).collect();
    let sample = runs.first().and_then(|runs| runs.first()?.samples.last());
    if let Some(sample) = sample.filter(|_| plan.same_poses > 0) {
        let phase = format!("{}, same poses", scene.name());
        progress.phase(phase, plan.same_poses * Backend::ALL.len());
        rows.extend(same_poses(scene, &sample.pairs, plan.same_poses, progress));
    }
    rows
}

/// Runs one pile as a study of its own.
pub fn one_pile(scene: &MonkeyPile, plan: &PilePlan, progress: &Progress) -> Results {
    let rows = pile(scene, plan, progress);
    let steps = rows.iter().map(|row| format!("{} {:.2}", row.backend, row.number("step.median")));
    let steps = steps.collect::<Vec<_>>().join(", ");
    Results::new("pile", format!("{}, ms a whole step: {steps}", scene.name()), rows)
}

/// Runs all backends step by step in turns, so that a slow spell of the machine slows all of them.
fn side_by_side(
    scene: &MonkeyPile,
    backends: &[Backend],
    plan: RunPlan,
    progress: &Progress,
) -> Vec<Run> {
    let runners = backends.iter().map(|&backend| Runner::new(scene, backend, plan));
    let mut runners = runners.collect::<Vec<Runner>>();
    for step in 0..plan.step_count() {
        for turn in 0..runners.len() {
            let index = (step + turn) % runners.len();
            runners[index].step();
        }
        progress.step();
    }
    runners.into_iter().map(Runner::finish).collect()
}

fn pile_row(study: &'static str, backend: Backend, scene: &MonkeyPile) -> Row {
    Row::new(study, backend).key("heads", scene.heads).key("scene", scene.name())
}

/// Sums up the runs of one backend; there must be a run.
fn row(scene: &MonkeyPile, runs: &[Run]) -> Row {
    let first = &runs[0];
    type Time = fn(&StepTimes) -> f64;
    let times: [(&str, Time); 5] = [
        ("step", |times| times.step),
        ("broad_phase", |times| times.broad_phase),
        ("narrow_phase", |times| times.narrow_phase),
        ("collision_detection", StepTimes::collision_detection),
        ("solver", |times| times.solver),
    ];
    let row = pile_row(RUNS, first.backend, scene);
    let row = times.into_iter().fold(row, |row, (name, time)| {
        row.with(name, Summary::of(runs.iter().map(|run| run.mean(time))))
    });
    let state = first.samples.last().map(|sample| sample.state).unwrap_or_default();
    row.with("steps", first.times.len() + first.samples.len())
        .with("manifolds", state.contact_manifold_count)
        .with("points", state.point_count)
        .with("mean_height", state.mean_height)
        .with("mean_depth", state.mean_penetration)
        .with("max_depth", state.max_penetration)
        .with("fresh", first.total(|sample| sample.fresh))
        .with("updated", first.total(|sample| sample.updated))
}

/// Times every backend on all of `pairs`: milliseconds for all.
fn same_poses(
    scene: &MonkeyPile,
    pairs: &[Sequence],
    repeats: usize,
    progress: &Progress,
) -> Vec<Row> {
    let dispatchers = Backend::ALL.map(Backend::per_triangle);
    let shapes = pairs.iter().flat_map(|pair| &pair.shapes);
    let _primed = dispatchers.each_ref().map(|d| Primed::new(d, shapes.clone()));
    let sampled = sample_indices(pairs.len(), JUDGED).into_iter();
    let sampled: Vec<Sequence> = sampled.map(|index| pairs[index].clone()).collect();
    let shared = dispatchers.each_ref().map(|dispatcher| &dispatcher.shared);
    let [fresh_errors, steady_errors] = [0, 1].map(|judged| {
        Sequence::errors(&sampled, shared, |index, step| {
            (step == judged).then(|| sampled[index].truth(step))
        })
    });
    let sweeps = in_turn(&dispatchers, repeats, |dispatcher| {
        progress.step();
        sweep(dispatcher, pairs)
    });
    let errors = fresh_errors.iter().zip(&steady_errors);
    let rows = Backend::ALL.into_iter().zip(sweeps).zip(errors);
    let rows = rows.map(|((backend, sweeps), (fresh_error, steady_error))| {
        let times = |pose: usize| Summary::of(sweeps.iter().map(|times| times[pose]));
        pile_row(SAME_POSES, backend, scene)
            .with("pair_count", pairs.len())
            .with("fresh", times(0))
            .with("steady", times(1))
            .with("fresh_error", fresh_error.pairs)
            .with("steady_error", steady_error.pairs)
    });
    rows.collect()
}

/// Milliseconds of all pairs at their first poses, and then at their second ones.
fn sweep(dispatcher: &SharedDispatcher, pairs: &[Sequence]) -> [f64; 2] {
    let mut memories: Vec<Memory> = pairs.iter().map(|_| Memory::default()).collect();
    [0, 1].map(|pose| {
        let asked = pairs.iter().zip(&mut memories);
        let (time, ()) =
            timed(|| asked.for_each(|(pair, memory)| pair.ask(memory, dispatcher, pose)));
        1e3 * time.as_secs_f64()
    })
}

/// Adds up the wrong contacts of a backend, and those that were judged.
pub(super) fn wrong_of(rows: &[Row], backend: Backend) -> [u64; 2] {
    let rows = rows.iter().filter(|row| row.is("backend", backend));
    let paths = ["fresh", "updated", "fresh_error", "steady_error"];
    rows.flat_map(|row| {
        paths.map(|path| [row.wrong(path), row.count(&format!("{path}.true_pairs"))])
    })
    .fold([0, 0], |[wrong, all], [w, a]| [wrong + w, all + a])
}
