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
use crate::mesh::{Change, Held, KnownMesh, TreeCache};

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
    type Shapes = [KnownMesh; 2];
    type Candidate = Candidate;
    type Contact = FeaturePair;
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl MeshPair<'_> {
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

    /// The trees of both meshes, from the state if they are known and still valid, refitted if a mesh has deformed.
    ///
    /// If anything has changed, the candidates are forgotten. The manifolds as well, if a mesh was edited while the
    /// host kept the workspace. If only vertices moved or another dispatcher was here before, the manifolds keep their data, but
    /// no generator must take their points for its own.
    fn trees<'s, M, C>(
        &self,
        cache: &Arc<TreeCache>,
        [known1, known2]: &'s mut [KnownMesh; 2],
        coherence: &mut Coherence<Candidate>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<[Held<'s>; 2]>
    where
        C: Default + Copy,
    {
        let (change1, tree1) = cache.noting(self.mesh1, known1.update(self.mesh1, cache))?;
        let (change2, tree2) = cache.noting(self.mesh2, known2.update(self.mesh2, cache))?;
        let change = change1.max(change2);
        if change != Change::None {
            coherence.clear();
        }
        match change {
            Change::None => {}
            Change::Unknown | Change::Deformed => {
                manifolds.iter_mut().for_each(ContactManifold::mark_shapes_deformed);
            }
            Change::Replaced => manifolds.clear(),
        }
        Some([tree1, tree2])
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
    if meshes.iter().any(KnownMesh::is_unknown) && !pair.root_boxes_meet() {
        manifolds.clear();
        return Answer::Apart;
    }
    let Some(prepared) = pair.trees(cache, meshes, coherence, manifolds) else {
        return Answer::Unsupported;
    };
    let prepared = prepared.each_ref().map(|held| &**held);
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
