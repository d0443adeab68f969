//! Meshes that deform: soft monkey heads on a rigid helicopter, stock beside SBBK.

use super::Progress;
use super::pair::Contest;
use super::turns::in_turn;
use crate::backend::Backend;
use crate::metrics::{ErrorCount, StepTimes, Summary, judged_step, timed_step};
use crate::report::{
    ERROR_NOTE, Look, Panel, Results, Row, Scale, TIME_NOTE, Table, TableSpec, errors, faster,
    number, time,
};
use crate::scene::{Scene, SoftHeads};

const HEADS: &str = "soft heads, ms";

/// How much to measure.
#[derive(Clone, Copy, Debug)]
pub struct SoftPlan {
    /// Soft heads.
    pub heads: usize,
    /// Steps of each run.
    pub steps: usize,
    /// Timed runs of each backend.
    pub repeats: usize,
    /// Every so many steps of a run of its own are judged.
    pub judged_every: usize,
}

impl SoftPlan {
    /// Within two minutes on two cores.
    pub fn standard() -> Self {
        Self { heads: 6, steps: 90, repeats: 3, judged_every: 10 }
    }

    /// Some seconds.
    pub fn quick() -> Self {
        Self { heads: 3, repeats: 1, judged_every: 15, ..Self::standard() }
    }
}

/// Measures them.
pub fn soft(plan: &SoftPlan, progress: &Progress) -> Results {
    let scene = SoftHeads::with_heads(plan.heads);
    let rows = heads(&scene, plan, progress);
    progress.finish();
    let (tables, panels) = (vec![table(&rows, &scene)], vec![panel(&rows)]);
    Results::new(rows, tables, panels)
}

/// Runs the scene under both backends. Times are means over the steps of a run.
fn heads(scene: &SoftHeads, plan: &SoftPlan, progress: &Progress) -> Vec<Row> {
    let backends = Contest::BACKENDS;
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let runs = in_turn(&backends, plan.repeats, |&backend| {
        progress.step();
        let mut built = scene.build();
        let installed = backend.install(&mut built.world);
        let step = |_| timed_step(&mut built.world, &installed.probe);
        (0..plan.steps).map(step).collect()
    });
    let rows = backends.into_iter().zip(&runs).map(|(backend, runs)| {
        let errors = judged(scene, backend, plan);
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| {
            let total = |run: &Vec<StepTimes>| run.iter().map(time).sum::<f64>();
            Summary::of(runs.iter().map(|run| total(run) / run.len() as f64))
        };
        let in_step = |step: usize| Summary::of(runs.iter().map(|run| run[step].mesh_mesh));
        let by_step: Vec<f64> = (0..plan.steps).filter_map(in_step).map(|t| t.median).collect();
        Row::new(HEADS, backend)
            .key("scene", scene.name())
            .with("step", mean(|times| times.step))
            .with("queries", mean(|times| times.mesh_mesh))
            .with("queries_by_step", by_step)
            .with("calls", runs[0].iter().map(|times| times.mesh_mesh_calls).sum::<u64>())
            .with("errors", errors)
    });
    rows.collect()
}

/// The answers of some steps.
fn judged(scene: &SoftHeads, backend: Backend, plan: &SoftPlan) -> ErrorCount {
    let mut built = scene.build();
    let installed = backend.install(&mut built.world);
    let mut errors = ErrorCount::default();
    for step in 1..=plan.steps {
        if step.is_multiple_of(plan.judged_every) {
            errors += judged_step(&mut built.world, &installed.probe, usize::MAX, false);
        } else {
            built.world.step();
        }
    }
    errors
}

fn table(rows: &[Row], scene: &SoftHeads) -> Table {
    TableSpec::new(
        format!("{}; milliseconds a step", scene.name()),
        HEADS,
        &["backend"],
        [
            time("step", "step"),
            faster("ratio", "step.min", Backend::Stock),
            time("queries", "queries"),
            faster("ratio", "queries.min", Backend::Stock),
            number("calls", "calls"),
            errors("errors", "errors"),
        ],
    )
    .note(
        "heads are Rapier's soft bodies, which deform their meshes in each step; queries: of \
             heads and helicopter; heads against heads are not a dispatcher's",
    )
    .note(TIME_NOTE)
    .note(ERROR_NOTE)
    .of(rows)
}

/// Time of the queries of soft heads.
fn panel(rows: &[Row]) -> Panel {
    let labels = ["step", "ms a step in queries"];
    let panel = Panel::new("Soft heads fall on a helicopter", labels, Scale::Linear);
    rows.iter().zip(Look::ALL).fold(panel, |panel, (row, look)| {
        let values = row.get("queries_by_step").and_then(|values| values.as_array());
        let values = values.into_iter().flatten().filter_map(|value| value.as_f64());
        panel.line(&row.backend, look, curve(&values.collect::<Vec<_>>()))
    })
}

/// Values by their index, a few at a time, so that the markers of several curves can be told apart.
fn curve(values: &[f64]) -> impl Iterator<Item = [f64; 2]> {
    const MARKER_COUNT: usize = 18;
    let length = values.len().div_ceil(MARKER_COUNT).max(1);
    values.chunks(length).enumerate().filter_map(move |(chunk, values)| {
        let middle = (chunk * length) as f64 + 0.5 * (values.len() - 1) as f64;
        Some([middle, Summary::of(values.iter().copied())?.median])
    })
}
