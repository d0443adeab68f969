//! Both experiments of the paper on all backends.

use super::pair::Sides;
use super::pile::{self, PilePlan, pile, wrong_of};
use super::turns::in_turn;
use crate::metrics::{Run, RunPlan, run};
use crate::prelude::*;
use crate::scene::HelicopterBallDrop;

const FRAMES: &str = "helicopter";
/// Steps of a run of the first experiment, for the fall, the bounces and the rolling.
const DROP_STEPS: usize = 120;

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct ComparePlan {
    /// Timed runs of each backend in the first experiment; the paper has 30.
    pub drops: usize,
    /// Sizes of the piles of the second experiment.
    pub heads: Vec<usize>,
    /// Plan of each pile. Only piles of up to 200 heads are repeated.
    pub pile: PilePlan,
}

/// Piles of up to this many heads are repeated. Higher: a longer study; lower: noisier times.
const CHEAP_HEADS: usize = 200;

impl ComparePlan {
    /// The paper's sizes; about two minutes on two cores.
    pub fn standard() -> Self {
        Self {
            drops: 30,
            heads: vec![200, 2000],
            pile: PilePlan {
                backends: Backend::ALL.to_vec(),
                repeats: 2,
                run: RunPlan {
                    warm_up: PilePlan::FREE_FALL,
                    steps: 43,
                    sample_every: 21,
                    sample_size: 100,
                },
                same_poses: 3,
            },
        }
    }

    /// Both experiments on a small scale, some ten seconds: for trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        Self { drops: 5, heads: vec![200], pile: PilePlan { repeats: 1, ..standard.pile } }
    }
}

/// Runs both experiments.
pub fn compare(plan: &ComparePlan, progress: &Progress) -> Results {
    let mut rows = drops(plan, progress);
    for &heads in &plan.heads {
        let repeats = if heads <= CHEAP_HEADS { plan.pile.repeats } else { 1 };
        let plan = PilePlan { repeats, ..plan.pile.clone() };
        rows.extend(pile(&MonkeyPile::with_heads(heads), &plan, progress));
    }
    Results::new("compare", verdict(plan, &rows), rows)
}

fn verdict(plan: &ComparePlan, rows: &[Row]) -> String {
    let heads = plan.heads.iter().copied().max().unwrap_or(0);
    let largest =
        Sides::of(rows, |row| row.study == pile::RUNS && row.count("heads") == heads as u64);
    let ([wrong, all], [stocks_wrong, stocks_all]) =
        (wrong_of(rows, Backend::Sbbk), wrong_of(rows, Backend::Stock));
    format!(
        "in a pile of {heads} heads a whole step is {:.1} times as fast as stock's, collision \
         detection {:.1} times; wrong contacts: SBBK {wrong} of {all}, stock {stocks_wrong} of \
         {stocks_all}",
        largest.ratio("step.median"),
        largest.ratio("collision_detection.median"),
    )
}

/// Runs the first experiment on all backends in turn. Times are means over the steps of a run, in
/// milliseconds; another run is judged.
fn drops(plan: &ComparePlan, progress: &Progress) -> Vec<Row> {
    let scene = HelicopterBallDrop;
    progress.phase(scene.name(), (plan.drops + 1) * Backend::ALL.len());
    let timed = RunPlan { warm_up: 1, steps: DROP_STEPS, ..RunPlan::default() };
    // The scene has one mesh pair, so every other step can be judged.
    let judged = RunPlan { sample_every: 2, sample_size: 1, ..timed };
    let runs = in_turn(&Backend::ALL, plan.drops, |&backend| {
        progress.step();
        run(&scene, backend, timed)
    });
    let rows = Backend::ALL.into_iter().zip(&runs).map(|(backend, runs)| {
        let judged = run(&scene, backend, judged);
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| Summary::of(runs.iter().map(|run| run.mean(time)));
        Row::new(FRAMES, backend)
            .key("ball", "mesh")
            .with("frames_per_second", Summary::of(runs.iter().map(Run::frames_per_second)))
            .with("collision_detection", mean(StepTimes::collision_detection))
            .with("fresh", judged.total(|sample| sample.fresh))
            .with("updated", judged.total(|sample| sample.updated))
    });
    rows.collect()
}
