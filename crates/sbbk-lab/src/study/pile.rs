//! The paper's second experiment: time of collision detection in a pile of heads.
//!
//! Two runs of one scene soon differ, as chaos makes a different last bit of a contact into a
//! different trajectory; so the same pairs at the same poses are timed as well.

use super::Progress;
use super::turns::{in_turn, timed};
use crate::backend::{Backend, Memory, Primed, SharedDispatcher};
use crate::metrics::{
    ErrorCount, Run, RunPlan, Runner, Sequence, StepTimes, Summary, sample_indices,
};
use crate::report::{
    ERROR_NOTE, Look, Panel, Row, Scale, TIME_NOTE, Table, TableSpec, errors, faster, number, time,
};
use crate::scene::{MonkeyPile, Scene};

const RUNS: &str = "pile, whole runs";
const SAME_POSES: &str = "pile, same poses";

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

/// What to ask all backends at the same poses.
#[derive(Clone, Copy, Debug)]
pub struct SamePosesPlan {
    /// How often each is asked about all pairs.
    pub repeats: usize,
    /// At most this many pairs are judged.
    pub sample_size: usize,
}

impl PilePlan {
    /// Of so many queries one is timed: thousands are left in each step of the large piles.
    pub const QUERY_STRIDE: u64 = 8;
    /// Steps until the lowest heads land.
    pub const FREE_FALL: usize = 27;
}

/// Runs `scene` on the backends of `plan`. Times are means over a run's timed steps, in milliseconds,
/// summed up over the runs.
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
    if let Some((sample, plan)) = sample.zip(plan.same_poses) {
        let phase = format!("{}, same poses", scene.name());
        progress.phase(phase, plan.repeats * Backend::ALL.len());
        rows.extend(same_poses(scene, &sample.pairs, plan, progress));
    }
    rows
}

/// One run on each backend, all at the same time: each step is done by one world after the other,
/// so that a slow spell of the machine meets all backends. The first one changes from step to
/// step.
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
    let row = Row::new(study, backend).key("heads", scene.heads).key("scene", scene.name());
    row.key("contact_recycling", scene.contact_recycling)
}

/// Whole runs of one backend; there is one at least.
fn row(scene: &MonkeyPile, runs: &[Run]) -> Row {
    let first = &runs[0];
    let mean = |time: fn(&StepTimes) -> f64| Summary::of(runs.iter().map(|run| run.mean(time)));
    let judged_from = |count: ErrorCount| format!("{} of {}", count.mesh_pairs, count.sampled_from);
    let (fresh, updated) = (first.total(|sample| sample.fresh), first.total(|s| s.updated));
    pile_row(RUNS, first.backend, scene)
        .with("steps", first.times.len() + first.samples.len())
        .with("step", mean(|times| times.step))
        .with("broad_phase", mean(|times| times.broad_phase))
        .with("narrow_phase", mean(|times| times.narrow_phase))
        .with("collision_detection", mean(StepTimes::collision_detection))
        .with("solver", mean(|times| times.solver))
        .with("mesh_mesh", mean(|times| times.mesh_mesh))
        .with("mesh_other", mean(|times| times.mesh_other))
        .with("state", first.samples.last().map(|sample| sample.state))
        .with("fresh", fresh)
        .with("fresh_from", judged_from(fresh))
        .with("updated", updated)
        .with("updated_from", judged_from(updated))
}

/// Every backend asked about all of `pairs`: milliseconds for all.
fn same_poses(
    scene: &MonkeyPile,
    pairs: &[Sequence],
    plan: SamePosesPlan,
    progress: &Progress,
) -> Vec<Row> {
    let dispatchers = Backend::ALL.map(Backend::per_triangle);
    let shapes = pairs.iter().flat_map(|pair| &pair.shapes);
    let _primed = dispatchers.each_ref().map(|d| Primed::new(d, shapes.clone()));
    let sampled = sample_indices(pairs.len(), plan.sample_size).into_iter();
    let sampled: Vec<Sequence> = sampled.map(|index| pairs[index].clone()).collect();
    let shared = dispatchers.each_ref().map(|dispatcher| &dispatcher.shared);
    let [fresh_errors, steady_errors] = [0, 1].map(|judged| {
        Sequence::errors(&sampled, shared, |index, step| {
            (step == judged).then(|| sampled[index].truth(step))
        })
    });
    let sweeps = in_turn(&dispatchers, plan.repeats, |dispatcher| {
        progress.step();
        sweep(dispatcher, pairs)
    });
    let answered =
        Backend::ALL.into_iter().zip(sweeps).zip(fresh_errors.iter().zip(&steady_errors));
    let rows = answered.map(|((backend, sweeps), (fresh_error, steady_error))| {
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

/// Milliseconds of all pairs at their first poses, without the time to free the manifolds, and then
/// of all at their second ones.
fn sweep(dispatcher: &SharedDispatcher, pairs: &[Sequence]) -> [f64; 2] {
    let mut memories: Vec<Memory> = pairs.iter().map(|_| Memory::default()).collect();
    [0, 1].map(|pose| {
        let asked = pairs.iter().zip(&mut memories);
        let (time, ()) =
            timed(|| asked.for_each(|(pair, memory)| pair.ask(memory, dispatcher, pose)));
        1e3 * time.as_secs_f64()
    })
}

/// What tables call the paper's pile, its size, and its "whole time of CD process" in milliseconds;
/// it is not said whether this is a frame's time.
const PAPERS: &str = "the paper's";
const PAPERS_HEADS: usize = 2000;
const PAPERS_TIMES: [(Backend, f64); 2] = [(Backend::AabbOnly, 71.8), (Backend::Sbbk, 34.5)];

/// The paper's results.
pub(super) fn papers() -> [Row; 2] {
    PAPERS_TIMES.map(|(backend, milliseconds)| {
        let row = Row::new(RUNS, backend).key("heads", PAPERS_HEADS).key("scene", PAPERS);
        row.with("collision_detection", Summary::of([milliseconds]))
    })
}

/// The paper's Table 2 and the numbers behind its Diagram 1, and the errors.
pub fn runs(rows: &[Row], plan: &RunPlan) -> [Table; 2] {
    let keys = &["scene", "contact_recycling", "backend"];
    let stock = |path| faster("vs stock", path, Backend::Stock);
    let aabb_only = |path| faster("vs aabb-only", path, Backend::AabbOnly);
    let times = TableSpec::new(
        "Table 2 and Diagram 1. Heads in a pile: milliseconds a step",
        RUNS,
        keys,
        [
            time("broad + narrow", "collision_detection"),
            stock("collision_detection.median"),
            aabb_only("collision_detection.median"),
            time("head-head queries", "mesh_mesh"),
            stock("mesh_mesh.median"),
            aabb_only("mesh_mesh.median"),
            time("head-floor queries", "mesh_other"),
            time("solver", "solver"),
            time("step", "step"),
            stock("step.median"),
        ],
    )
    .note(format!(
        "mean of the {} steps after the first heads land, in which one query in {} is \
                 timed; times: min / median over the runs; ratios: of medians",
        plan.steps, plan.query_stride
    ))
    .note(
        "contact recycling: Rapier's default is true; backends side by side, each on its own \
             trajectory",
    );
    let accuracy = TableSpec::new(
        "Accuracy in whole runs",
        RUNS,
        keys,
        [
            number("mesh pairs, fresh", "fresh_from"),
            errors("errors", "fresh"),
            number("mesh pairs, in the run", "updated_from"),
            errors("errors", "updated"),
            number("manifolds", "state.contact_manifold_count"),
            number("points", "state.point_count"),
            number("mean height", "state.mean_height"),
            number("mean depth", "state.mean_penetration"),
            number("max depth", "state.max_penetration"),
        ],
    )
    .note(
        "fresh: sampled from all pairs of the broad phase, asked anew for all contacts of \
         triangles; in the run: sampled from those that Rapier updated in the sampled steps, as it \
         got them; of surfaces: none without contacts that cross, and none that are not true",
    )
    .note(
        "manifolds and the rest: after the last sampled step, recycled contacts included; depth: \
             units, of the deepest point of touching pairs",
    )
    .note(ERROR_NOTE);
    let papers = |row: &Row| row.is("scene", PAPERS);
    let ours: Vec<Row> = rows.iter().filter(|row| !papers(row)).cloned().collect();
    [times.of(rows), accuracy.of(&ours)]
}

/// All backends at the same poses.
pub(super) fn same_poses_table(rows: &[Row]) -> Table {
    TableSpec::new(
        "The same head-head pairs at the same poses, milliseconds for all",
        SAME_POSES,
        &["heads", "backend"],
        [
            number("pairs", "pair_count"),
            time("fresh", "fresh"),
            faster("vs stock", "fresh.median", Backend::Stock),
            time("steady", "steady"),
            faster("vs stock", "steady.median", Backend::Stock),
            faster("vs aabb-only", "steady.median", Backend::AabbOnly),
            errors("errors, fresh", "fresh_error"),
            errors("errors, steady", "steady_error"),
        ],
    )
    .note(
        "all contacts of triangles at the poses of the stock run's last sampled step; fresh: \
         nothing known about a pair; steady: a step later, with what is kept from the first query",
    )
    .note("no pair is left out as recycled, so that steady is Rapier with recycling off")
    .note(TIME_NOTE)
    .note(ERROR_NOTE)
    .of(rows)
}

/// Time of collision detection, and Diagram 1: the ratios of these times by number of heads.
pub(super) fn panels(rows: &[Row]) -> [Panel; 2] {
    let medians = |backend: Backend| -> Vec<[f64; 2]> {
        let is_shown = |row: &&Row| {
            row.study == RUNS
                && row.is("backend", backend)
                && row.get("contact_recycling") == Some(&true.into())
        };
        let point = |row: &Row| [row.number("heads"), row.number("collision_detection.median")];
        rows.iter().filter(is_shown).map(point).collect()
    };
    let labels = ["monkey heads", "ms a step, whole runs"];
    let times = Panel::new("Broad and narrow phase", labels, Scale::Linear);
    let times = Backend::ALL.into_iter().fold(times, |panel, backend| {
        panel.line(&backend.to_string(), Look::of(backend), medians(backend).into_iter())
    });
    let labels = ["monkey heads", "ratio of times, broad and narrow phase"];
    let ratios = Panel::new("Diagram 1: how many times faster", labels, Scale::Linear);
    let ratios = [Backend::Stock, Backend::AabbOnly].into_iter().fold(ratios, |panel, backend| {
        let pairs = medians(backend).into_iter().zip(medians(Backend::Sbbk));
        let points = pairs.map(|([heads, time], [_, sbbk])| [heads, time / sbbk]);
        panel.line(&format!("{backend} : sbbk"), Look::of(backend), points)
    });
    let [(_, aabb), (_, sbbk)] = PAPERS_TIMES;
    let papers = [[PAPERS_HEADS as f64, aabb / sbbk]].into_iter();
    [times, ratios.points("the paper's aabb : sbbk", Look::ALL[4], papers)]
}
