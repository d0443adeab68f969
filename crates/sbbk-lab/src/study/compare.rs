//! Both experiments of the paper on all backends.

use super::runs::{self, RunPlan, pile};
use crate::prelude::*;
use crate::scene::HelicopterBallDrop;

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct ComparePlan {
    /// Runs of each backend in the first experiment; the paper has 30.
    pub drops: usize,
    /// Sizes of the piles of the second experiment.
    pub heads: Vec<usize>,
    /// Plan of each pile. Only piles of up to 200 heads are repeated.
    pub pile: RunPlan,
}

/// Piles of up to this many heads are repeated. Higher: a longer study; lower: noisier times.
const CHEAP_HEADS: usize = 200;

impl ComparePlan {
    /// The paper's sizes; about two minutes on two cores.
    pub fn standard() -> Self {
        Self {
            drops: 30,
            heads: vec![200, 2000],
            pile: RunPlan {
                backends: Backend::ALL.to_vec(),
                repeats: 2,
                warm_up: RunPlan::FREE_FALL,
                steps: 43,
                judge_every: 21,
                judged_pairs: 100,
                same_poses: 3,
            },
        }
    }

    /// Both experiments on a small scale, some ten seconds: for trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        Self { drops: 5, heads: vec![200], pile: RunPlan { repeats: 1, ..standard.pile } }
    }
}

/// Runs both experiments.
pub fn compare(plan: &ComparePlan, progress: &Progress) -> Results {
    let mut rows = drops(plan, progress);
    for &heads in &plan.heads {
        let repeats = if heads <= CHEAP_HEADS { plan.pile.repeats } else { 1 };
        let plan = RunPlan { repeats, ..plan.pile.clone() };
        rows.extend(pile(&MonkeyPile::with_heads(heads), &plan, progress));
    }
    Results::new("compare", rows)
}

/// Runs the first experiment: the fall, the bounces and the rolling.
fn drops(plan: &ComparePlan, progress: &Progress) -> Vec<Row> {
    // The scene has one mesh pair, so every other step of the first run can be judged.
    let plan = RunPlan {
        repeats: plan.drops,
        warm_up: 1,
        steps: 120,
        judge_every: 2,
        judged_pairs: 1,
        ..plan.pile.clone()
    };
    let row = Row::new("helicopter", "").key("ball", "mesh");
    let runs = runs::run(&HelicopterBallDrop, &plan, progress);
    runs.iter().map(|runs| runs::summed_up(&row, runs)).collect()
}
