//! Both experiments of the paper on all backends, and what lies behind their times.

use super::Progress;
use super::helicopter::{self, HelicopterPlan, frames, helicopter};
use super::meshes::{self, meshes};
use super::pile::{self, PilePlan, SamePosesPlan, pile, same_poses_table};
use crate::backend::Backend;
use crate::mesh::{self, Mesh};
use crate::metrics::RunPlan;
use crate::report::Results;
use crate::scene::{BallKind, HelicopterBallDrop, MonkeyPile};

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ComparePlan {
    /// The first experiment.
    pub helicopter: HelicopterPlan,
    /// Sizes of the piles of the second experiment.
    pub heads: Vec<usize>,
    /// Size of the pile that is run with contact recycling off as well.
    pub heads_without_recycling: usize,
    /// How each pile is run. Only piles of up to 200 heads are repeated, and only with recycling.
    pub pile: PilePlan,
    /// The head, or `None` for the monkey.
    pub head: Option<Mesh>,
    /// Resolutions of the monkey heads that are measured on their own, see
    /// [`mesh::monkey_head_with`].
    pub details: Vec<u32>,
}

/// Piles of up to this many heads are cheap enough for repeats.
const CHEAP_HEADS: usize = 200;

impl ComparePlan {
    /// The paper's sizes; within three minutes on two cores.
    pub fn standard() -> Self {
        Self {
            helicopter: HelicopterPlan { repeats: 30, steps: 120 },
            heads: vec![100, 200, 500, 1000, 2000],
            heads_without_recycling: 200,
            pile: PilePlan {
                backends: vec![Backend::Stock, Backend::AabbOnly, Backend::Sbbk],
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
            // 288, 968, 4232, 17,672 and 69,192 triangles.
            details: vec![6, 11, 23, 47, 93],
        }
    }

    /// The same experiments on a small scale, within half a minute: for trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        Self {
            helicopter: HelicopterPlan { repeats: 5, ..standard.helicopter },
            heads: vec![50, 100],
            heads_without_recycling: 50,
            pile: PilePlan { repeats: 1, ..standard.pile },
            details: vec![6, 11, 23],
            ..standard
        }
    }

    /// The pile of so many heads.
    pub fn scene(&self, heads: usize) -> MonkeyPile {
        match &self.head {
            Some(head) => MonkeyPile::of(heads, head.clone()),
            None => MonkeyPile::with_heads(heads),
        }
    }

    /// The head asked for, monkeys in all resolutions, and the helicopter.
    fn meshes(&self) -> Vec<Mesh> {
        let head = self.head.iter().map(|_| self.scene(1).mesh);
        let monkeys = self.details.iter().map(|&detail| mesh::monkey_head_with(detail));
        head.chain(monkeys).chain([HelicopterBallDrop::default().helicopter]).collect()
    }
}

/// Does all experiments.
pub fn compare(plan: &ComparePlan, progress: &Progress) -> Results {
    let mut rows = helicopter::papers().to_vec();
    for ball in [BallKind::Mesh, BallKind::Primitive] {
        let scene = HelicopterBallDrop { ball, ..HelicopterBallDrop::default() };
        rows.extend(helicopter(&scene, &Backend::ALL, &plan.helicopter, progress));
    }
    rows.extend(pile::papers());
    let recycled = plan.heads.iter().map(|&heads| (heads, true));
    for (heads, contact_recycling) in recycled.chain([(plan.heads_without_recycling, false)]) {
        let scene = MonkeyPile { contact_recycling, ..plan.scene(heads) };
        let is_cheap = heads <= CHEAP_HEADS && contact_recycling;
        let repeats = if is_cheap { plan.pile.repeats } else { 1 };
        let same_poses = plan.pile.same_poses.filter(|_| contact_recycling);
        let plan = PilePlan { repeats, same_poses, ..plan.pile.clone() };
        rows.extend(pile(&scene, &plan, progress));
    }
    rows.extend(meshes(&plan.meshes(), progress));
    progress.finish();
    let [times, accuracy] = pile::runs(&rows, &plan.pile.run);
    let tables = vec![
        frames(&rows, &plan.helicopter),
        times,
        same_poses_table(&rows),
        accuracy,
        meshes::table(&rows),
    ];
    let [detection, ratios] = pile::panels(&rows);
    let panels = vec![detection, ratios, meshes::panel(&rows)];
    Results::new(rows, tables, panels)
}
