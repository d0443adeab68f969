use std::cell::RefCell;
use std::sync::Arc;

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::TriMesh;
use sbbk_core::contact::FeaturePair;
use sbbk_core::traverse::{Counters, PairFrame, Placement};

use super::candidates::{Candidate, Scratch, collect};
use super::coherence::{Coherence, Plan};
use super::manifolds::{Generator, Meshes};
use super::state::{PairKind, PairState};
use crate::ContactGenerator;
use crate::mesh::{MeshToken, PreparedRef, TreeCache};

/// The question: which contacts do two meshes have?
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    /// The pose of mesh 2 in the frame of mesh 1.
    pub(crate) pos12: &'a Pose,
    pub(crate) mesh1: &'a TriMesh,
    pub(crate) mesh2: &'a TriMesh,
    pub(crate) prediction: Real,
}

/// How a query was answered.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// By the boxes of the whole meshes alone.
    Apart,
    /// By what the last query left: nothing has moved.
    Unchanged,
    /// From the candidates of an earlier descent.
    Reused,
    /// By a descent.
    Descended,
    /// Not at all: a mesh cannot have a tree, and somebody else must answer.
    Unsupported,
}

impl Answer {
    /// The one of two answers, for parts of a pair, that took more.
    pub(super) fn or_harder(self, other: Self) -> Self {
        let effort = |answer| match answer {
            Self::Apart => 0,
            Self::Unchanged => 1,
            Self::Reused => 2,
            Self::Descended => 3,
            Self::Unsupported => 4,
        };
        if effort(self) < effort(other) { other } else { self }
    }
}

/// Greatest slack of candidates as a share of the prediction distance. More: pairs of triangles that do not touch get
/// the exact test; fewer: more descents.
const GREATEST_SLACK: f64 = 1.0;

/// Two meshes.
#[derive(Clone)]
struct TwoMeshes;

impl PairKind for TwoMeshes {
    type Shapes = KnownMeshes;
    type Candidate = Candidate;
    type Contact = FeaturePair;
}

/// The trees of the pair, as far as they are known.
#[derive(Clone, Default)]
enum KnownMeshes {
    /// No query has needed them yet.
    #[default]
    None,
    /// Valid while the tokens are.
    Trees([MeshToken; 2], [PreparedRef; 2]),
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl MeshPair<'_> {
    fn tokens(&self) -> [MeshToken; 2] {
        [self.mesh1, self.mesh2].map(MeshToken::of)
    }

    /// Whether the boxes around the meshes meet, as stock Parry tests them first. Asked before there are trees.
    fn root_boxes_meet(&self) -> bool {
        let [root1, root2] = [self.mesh1, self.mesh2].map(|mesh| mesh.bvh().root_aabb());
        let rounding = 1e-5 * (root1.half_extents().length() + root1.center().length());
        let moved = root2.transform_by(self.pos12).loosened(self.prediction.max(0.0) + rounding);
        root1.intersects(&moved)
    }

    /// Whether Parry walks mesh 2 first: it does so if its box is larger.
    fn is_flipped(&self) -> bool {
        let [size1, size2] = [self.mesh1, self.mesh2]
            .map(|mesh| mesh.bvh().root_aabb().half_extents().length_squared());
        size1 < size2
    }

    /// The pose that stock Parry passes on: bit for bit, it inverts the pose twice if it does not swap the meshes.
    fn parrys_pose(&self) -> Pose {
        if self.is_flipped() { *self.pos12 } else { self.pos12.inverse().inverse() }
    }

    /// The trees of both meshes, from the state if they are known and still valid.
    ///
    /// If they are not, what is known of the pair is forgotten. Its manifolds as well, if a mesh was edited while the
    /// host kept the workspace. If only another dispatcher was here before, the manifolds keep their data, but no
    /// generator must take their points for its own.
    fn trees<'s, M, C>(
        &self,
        cache: &Arc<TreeCache>,
        known: &'s mut KnownMeshes,
        coherence: &mut Coherence<Candidate>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<&'s [PreparedRef; 2]>
    where
        C: Default + Copy,
    {
        let tokens = self.tokens();
        let is_valid = match known {
            KnownMeshes::None => false,
            KnownMeshes::Trees(valid, [one, _]) => *valid == tokens && one.is_from(cache),
        };
        if !is_valid {
            coherence.clear();
            match known {
                KnownMeshes::Trees(old, _) if *old != tokens => manifolds.clear(),
                _ => manifolds.iter_mut().for_each(ContactManifold::mark_shapes_deformed),
            }
            let prepare = |mesh| match cache.prepare(mesh) {
                Ok(prepared) => Some(prepared),
                Err(_) => {
                    cache.note_unsupported(mesh);
                    None
                }
            };
            *known = match [self.mesh1, self.mesh2].map(prepare) {
                [Some(one), Some(two)] => KnownMeshes::Trees(tokens, [one, two]),
                _ => KnownMeshes::None,
            };
        }
        match known {
            KnownMeshes::Trees(_, prepared) => Some(prepared),
            KnownMeshes::None => None,
        }
    }
}

/// Brings the manifolds of a pair of meshes up to date.
pub(crate) fn contact_manifolds<M, C>(
    pair: MeshPair<'_>,
    cache: &Arc<TreeCache>,
    contacts: ContactGenerator,
    counters: impl Counters,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> Answer
where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    if cache.is_unsupported(&[pair.mesh1, pair.mesh2]) {
        return Answer::Unsupported;
    }
    let PairState::<_, _, TwoMeshes> { shapes: meshes, coherence, history } =
        PairState::of(workspace, manifolds);
    if matches!(meshes, KnownMeshes::None) && !pair.root_boxes_meet() {
        manifolds.clear();
        return Answer::Apart;
    }
    let Some(prepared) = pair.trees(cache, meshes, coherence, manifolds) else {
        return Answer::Unsupported;
    };
    let prepared = prepared.each_ref().map(PreparedRef::get);
    let trees = (&prepared[0].tree, &prepared[1].tree);
    let placement = Placement::new(pair.pos12);
    let ball = trees.1.bounding_ball();
    let pose = (pair.pos12, placement);
    let plan = coherence.plan(ball, pose, pair.prediction, GREATEST_SLACK);
    if plan == Plan::Nothing && history.is_of(manifolds) {
        return Answer::Unchanged;
    }
    let margin = match plan {
        Plan::Descend { margin } | Plan::Reuse { margin } => margin,
        Plan::Nothing => pair.prediction,
    };
    let mut frame = PairFrame::at(trees, placement, margin);
    let flipped = pair.is_flipped();
    SCRATCH.with_borrow_mut(|scratch| {
        if let Plan::Reuse { .. } = plan {
            coherence.near(pair.prediction, &mut scratch.candidates);
        } else {
            collect(prepared, &mut frame, flipped, counters, scratch);
        }
        let generator = Generator {
            shapes: Meshes { pair, prepared, flipped },
            pos12: pair.pos12,
            placement: frame.placement(),
            margin: frame.margin(),
            prediction: pair.prediction,
            parrys_pose: pair.parrys_pose(),
            contacts,
        };
        generator.update(scratch, coherence, history, manifolds);
    });
    match plan {
        Plan::Reuse { .. } => Answer::Reused,
        Plan::Nothing | Plan::Descend { .. } => Answer::Descended,
    }
}
