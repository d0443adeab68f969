//! All experiments in one go.

use serde::Serialize;

use super::{
    CutStudy, HelicopterPlan, HelicopterRow, MeshRow, PILE_QUERY_STRIDE, PilePlan, PileStudy,
    Progress, SamePosesPlan, StudyError, cut, helicopter, meshes, pile,
};
use crate::backend::Backend;
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, RunPlan};
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
                // The lowest heads reach the floor at step 27.
                run: RunPlan {
                    warm_up: 27,
                    steps: 43,
                    sample_every: 21,
                    sample_size: 100,
                    query_stride: PILE_QUERY_STRIDE,
                },
                same_poses: Some(SamePosesPlan {
                    backends: Backend::ALL,
                    repeats: 3,
                    sample_size: 200,
                }),
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

    fn scene(&self, heads: usize) -> MonkeyPile {
        match &self.head {
            Some(head) => MonkeyPile::of(heads, head.clone()),
            None => MonkeyPile::with_heads(heads),
        }
    }

    fn piles(&self, progress: &Progress) -> Result<Vec<PileStudy>, StudyError> {
        let recycled = self.heads.iter().map(|&heads| (heads, true));
        let variants = recycled.chain([(self.heads_without_recycling, false)]);
        let studies = variants.map(|(heads, contact_recycling)| {
            let scene = MonkeyPile { contact_recycling, ..self.scene(heads) };
            let is_cheap = heads <= CHEAP_HEADS && contact_recycling;
            let repeats = if is_cheap { self.pile.repeats } else { 1 };
            let same_poses = self.pile.same_poses.filter(|_| contact_recycling);
            let plan = PilePlan { repeats, same_poses, ..self.pile.clone() };
            Ok(pile(&scene, &plan, progress, &mut |_| ())?)
        });
        studies.collect()
    }

    /// The head asked for, monkeys in all resolutions, and the helicopter.
    fn meshes(&self) -> Vec<Mesh> {
        let head = self.head.iter().map(|_| self.scene(1).mesh);
        let monkeys = self.details.iter().map(|&detail| mesh::monkey_head_with(detail));
        head.chain(monkeys).chain([HelicopterBallDrop::default().helicopter]).collect()
    }
}

/// All that [`compare`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Machine and build.
    pub environment: Environment,
    /// The first experiment, by ball and backend.
    pub helicopter: Vec<HelicopterRow>,
    /// The second experiment, by number of heads; the last one without contact recycling.
    pub piles: Vec<PileStudy>,
    /// The first experiment's moment of contact; `None` if there was none.
    pub cut: Option<CutStudy>,
    /// Trees and first queries, mesh by mesh.
    pub meshes: Vec<MeshRow>,
}

/// Does all experiments.
///
/// Errors: a mesh does not serve.
pub fn compare(plan: &ComparePlan, progress: &Progress) -> Result<Comparison, StudyError> {
    let scene = HelicopterBallDrop::default();
    let [mesh_ball, primitive_ball] = [BallKind::Mesh, BallKind::Primitive].map(|ball| {
        let scene = HelicopterBallDrop { ball, ..scene.clone() };
        helicopter(&scene, &Backend::ALL, &plan.helicopter, progress)
    });
    let comparison = Comparison {
        environment: Environment::detect(),
        helicopter: [mesh_ball?, primitive_ball?].concat(),
        piles: plan.piles(progress)?,
        cut: cut(&scene)?,
        meshes: meshes(&plan.meshes(), progress)?,
    };
    progress.finish();
    Ok(comparison)
}
