//! Both experiments of the paper on all backends.

use super::pair::Sides;
use super::pile::{self, PilePlan, SamePosesPlan, pile, same_poses_table, wrong_of};
use super::turns::in_turn;
use crate::metrics::{Run, RunPlan, run};
use crate::prelude::*;
use crate::report::{ERROR_NOTE, greater};
use crate::scene::HelicopterBallDrop;

const FRAMES: &str = "helicopter";

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct ComparePlan {
    /// Timed runs of each backend in the first experiment; the paper has 30.
    pub drops: usize,
    /// Steps of a run, for the fall, the bounces and the rolling.
    pub drop_steps: usize,
    /// Sizes of the piles of the second experiment.
    pub heads: Vec<usize>,
    /// Size of the pile that is also run without contact recycling.
    pub heads_without_recycling: usize,
    /// Plan of each pile. Only piles of up to 200 heads with recycling are repeated.
    pub pile: PilePlan,
    /// The head, or `None` for the monkey.
    pub head: Option<Mesh>,
}

/// Piles of up to this many heads are repeated. Higher: a longer study; lower: noisier times.
const CHEAP_HEADS: usize = 200;

impl ComparePlan {
    /// The paper's sizes; about three minutes on two cores.
    pub fn standard() -> Self {
        Self {
            drops: 30,
            drop_steps: 120,
            heads: vec![100, 200, 500, 1000, 2000],
            heads_without_recycling: 200,
            pile: PilePlan {
                backends: Backend::ALL.to_vec(),
                repeats: 2,
                run: RunPlan {
                    warm_up: PilePlan::FREE_FALL,
                    steps: 43,
                    sample_every: 21,
                    sample_size: 100,
                    query_stride: PilePlan::QUERY_STRIDE,
                },
                same_poses: Some(SamePosesPlan { repeats: 3, sample_size: 200 }),
            },
            head: None,
        }
    }

    /// Both experiments on a small scale, some ten seconds: for trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        Self {
            drops: 5,
            heads: vec![50, 100],
            heads_without_recycling: 50,
            pile: PilePlan { repeats: 1, ..standard.pile },
            ..standard
        }
    }

    pub fn scene(&self, heads: usize) -> MonkeyPile {
        match &self.head {
            Some(head) => MonkeyPile::of(heads, head.clone()),
            None => MonkeyPile::with_heads(heads),
        }
    }
}

/// Runs both experiments.
pub fn compare(plan: &ComparePlan, progress: &Progress) -> Results {
    let mut rows = drops(plan, progress);
    rows.extend(papers());
    let recycled = plan.heads.iter().map(|&heads| (heads, true));
    for (heads, contact_recycling) in recycled.chain([(plan.heads_without_recycling, false)]) {
        let scene = MonkeyPile { contact_recycling, ..plan.scene(heads) };
        let is_cheap = heads <= CHEAP_HEADS && contact_recycling;
        let repeats = if is_cheap { plan.pile.repeats } else { 1 };
        let same_poses = plan.pile.same_poses.filter(|_| contact_recycling);
        let plan = PilePlan { repeats, same_poses, ..plan.pile.clone() };
        rows.extend(pile(&scene, &plan, progress));
    }
    rows.extend(pile::papers());
    let [times, state] = pile::runs(&rows, &plan.pile.run);
    let tables = vec![times, state, same_poses_table(&rows), frames(&rows, plan)];
    Results::new(verdict(plan, &rows), rows, tables)
}

fn verdict(plan: &ComparePlan, rows: &[Row]) -> String {
    let heads = plan.heads.iter().copied().max().unwrap_or(0);
    let largest = Sides::of(rows, |row| {
        row.study == pile::RUNS
            && row.count("heads") == heads as u64
            && row.get("contact_recycling") == Some(&true.into())
    });
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
    let scene = HelicopterBallDrop::default();
    progress.phase(scene.name(), (plan.drops + 1) * Backend::ALL.len());
    let timed = RunPlan { warm_up: 1, steps: plan.drop_steps, ..RunPlan::default() };
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

/// The results of the paper: frames a second, drawing included.
fn papers() -> [Row; 2] {
    [(Backend::AabbOnly, 162.0), (Backend::Sbbk, 180.0)].map(|(backend, fps)| {
        let row = Row::new(FRAMES, backend).key("ball", "the paper's");
        row.with("frames_per_second", Summary::of([fps]))
    })
}

/// The paper's Table 1.
fn frames(rows: &[Row], plan: &ComparePlan) -> Table {
    let against =
        |backend: Backend| greater(&format!("vs {backend}"), "frames_per_second.median", backend);
    TableSpec::new(
        "Table 1. A ball falls on a rotor: frames a second",
        FRAMES,
        &["ball", "backend"],
        [
            number("median", "frames_per_second.median"),
            number("best", "frames_per_second.max"),
            against(Backend::Stock),
            against(Backend::AabbOnly),
            time("broad + narrow, ms", "collision_detection"),
            errors("wrong, fresh", "fresh"),
            errors("wrong, in the run", "updated"),
        ],
    )
    .note(format!(
        "{} runs of {} steps each, in turn; a frame is a step without drawing, unlike the paper's",
        plan.drops, plan.drop_steps
    ))
    .note(ERROR_NOTE)
    .of(rows)
}
