//! The paper's first experiment on all backends: frames per second of the ball and helicopter.

use super::Progress;
use super::turns::in_turn;
use crate::backend::Backend;
use crate::metrics::{Run, RunPlan, StepTimes, Summary, run};
use crate::report::{ERROR_NOTE, Row, TIME_NOTE, Table, TableSpec, errors, faster, number, time};
use crate::scene::{HelicopterBallDrop, Scene};

const FRAMES: &str = "helicopter";

/// How often and how long to run the helicopter scene.
#[derive(Clone, Copy, Debug)]
pub struct HelicopterPlan {
    /// Timed runs of each backend; the paper has 30.
    pub repeats: usize,
    /// Steps of each run: the fall takes about 30, the bounces and the roll over the rotor the
    /// rest of the first two seconds.
    pub steps: usize,
}

/// Runs `scene` on the given backends in turn. Times are means over a run's steps, in milliseconds,
/// summed up over the repeats; errors are of a run of its own.
pub fn helicopter(
    scene: &HelicopterBallDrop,
    backends: &[Backend],
    plan: &HelicopterPlan,
    progress: &Progress,
) -> Vec<Row> {
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let timed = RunPlan { warm_up: 1, steps: plan.steps, ..RunPlan::default() };
    // One mesh pair: every other step can be judged.
    let judged = RunPlan { sample_every: 2, sample_size: 1, ..timed };
    let runs = in_turn(backends, plan.repeats, |&backend| {
        progress.step();
        run(scene, backend, timed)
    });
    let rows = backends.iter().zip(&runs).map(|(&backend, runs)| {
        let judged = run(scene, backend, judged);
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| Summary::of(runs.iter().map(|run| run.mean(time)));
        Row::new(FRAMES, backend)
            .key("ball", scene.ball.to_string())
            .with("steps", plan.steps)
            .with("frames_per_second", Summary::of(runs.iter().map(Run::frames_per_second)))
            .with("collision_detection", mean(StepTimes::collision_detection))
            .with("queries", mean(|times| times.mesh_mesh + times.mesh_other))
            .with("fresh", judged.total(|sample| sample.fresh))
            .with("updated", judged.total(|sample| sample.updated))
    });
    rows.collect()
}

/// The paper's results: frames a second, drawing included.
pub(super) fn papers() -> [Row; 2] {
    [(Backend::AabbOnly, 162.0), (Backend::Sbbk, 180.0)].map(|(backend, fps)| {
        let row = Row::new(FRAMES, backend).key("ball", "the paper's");
        row.with("frames_per_second", Summary::of([fps]))
    })
}

/// The paper's Table 1.
pub fn frames(rows: &[Row], plan: &HelicopterPlan) -> Table {
    let against = |backend: Backend| {
        faster(&format!("vs {backend}"), "frames_per_second.median", backend).inverse()
    };
    TableSpec::new(
        "Table 1. A ball falls on the rotor: frames a second",
        FRAMES,
        &["ball", "backend"],
        [
            number("fps, median", "frames_per_second.median"),
            number("best", "frames_per_second.max"),
            against(Backend::Stock),
            against(Backend::AabbOnly),
            time("broad + narrow, ms", "collision_detection"),
            time("queries, ms", "queries"),
            errors("errors, fresh", "fresh"),
            errors("errors, in the run", "updated"),
        ],
    )
    .note(format!(
        "{} runs of {} steps each, backends in turn; contact recycling on",
        plan.repeats, plan.steps
    ))
    .note("a frame is a step: nothing is drawn, unlike in the paper")
    .note(TIME_NOTE)
    .note(ERROR_NOTE)
    .of(rows)
}
