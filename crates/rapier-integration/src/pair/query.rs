use std::cell::RefCell;
use std::sync::Arc;

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::TriMesh;
use sbbk_core::contact::FeaturePair;
use sbbk_core::traverse::{Counters, GREATEST_SLACK, PairFrame, Placement};

use super::candidates::{Candidate, Scratch, collect};
use super::coherence::{Coherence, Plan};
use super::manifolds::{Generator, Meshes};
use super::question::{Answer, Question};
use super::state::{PairKind, PairState, state_in};
use crate::ContactGenerator;
use crate::mesh::{Held, KnownMesh, TreeCache, root_box};

/// The question: which contacts do two meshes have?
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    /// The pose of mesh 2 in the frame of mesh 1.
    pub(crate) pos12: &'a Pose,
    pub(crate) mesh1: &'a TriMesh,
    pub(crate) mesh2: &'a TriMesh,
    pub(crate) prediction: Real,
    pub(crate) contacts: ContactGenerator,
}

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
        let (Some(root1), Some(root2)) = (root_box(self.mesh1), root_box(self.mesh2)) else {
            return true;
        };
        let rounding = 1e-5 * (root1.half_extents().length() + root1.center().length());
        let moved = root2.transform_by(self.pos12).loosened(self.prediction.max(0.0) + rounding);
        root1.intersects(&moved)
    }

    /// Whether Parry walks mesh 2 first: it does so if its box is larger.
    fn is_flipped(&self) -> bool {
        let size = |mesh: &TriMesh| mesh.bvh().root_aabb().half_extents().length_squared();
        size(self.mesh1) < size(self.mesh2)
    }

    /// The pose that stock Parry passes on: bit for bit, it inverts the pose twice if it does not swap the meshes.
    fn parrys_pose(&self, flipped: bool) -> Pose {
        if flipped { *self.pos12 } else { self.pos12.inverse().inverse() }
    }

    /// The trees of both meshes, from the state if they are known and still valid, refitted if a mesh has deformed.
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
        coherence.follow(change1.max(change2), manifolds);
        Some([tree1, tree2])
    }
}

impl Question for MeshPair<'_> {
    fn contact_manifolds<M, C>(
        self,
        cache: &Arc<TreeCache>,
        counters: impl Counters,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        if cache.is_unsupported(&[self.mesh1, self.mesh2]) {
            return Answer::Unsupported;
        }
        let PairState::<_, _, TwoMeshes> { shapes: meshes, coherence, history } =
            state_in(workspace, manifolds);
        if meshes.iter().any(KnownMesh::is_unknown) && !self.root_boxes_meet() {
            manifolds.clear();
            return Answer::Apart;
        }
        let Some(prepared) = self.trees(cache, meshes, coherence, manifolds) else {
            return Answer::Unsupported;
        };
        let prepared = prepared.each_ref().map(|held| &**held);
        let trees = (&prepared[0].tree, &prepared[1].tree);
        let placement = Placement::new(self.pos12);
        let ball = trees.1.bounding_ball();
        let pose = (self.pos12, placement);
        let plan = coherence.plan(ball, pose, self.prediction, GREATEST_SLACK);
        if plan == Plan::Nothing && history.is_of(manifolds) {
            return Answer::Unchanged;
        }
        let margin = match plan {
            Plan::Descend { margin } | Plan::Reuse { margin } => margin,
            Plan::Nothing => self.prediction,
        };
        let flipped = self.is_flipped();
        SCRATCH.with_borrow_mut(|scratch| {
            if let Plan::Reuse { .. } = plan {
                coherence.near(self.prediction, &mut scratch.candidates);
            } else {
                let mut frame = PairFrame::at(trees, placement, margin);
                collect(prepared, &mut frame, flipped, counters, scratch);
            }
            let generator = Generator {
                shapes: Meshes { pair: self, prepared, flipped },
                pos12: self.pos12,
                placement: &placement,
                margin,
                prediction: self.prediction,
                parrys_pose: self.parrys_pose(flipped),
                contacts: self.contacts,
            };
            generator.update(scratch, coherence, history, manifolds);
        });
        match plan {
            Plan::Reuse { .. } => Answer::Reused,
            Plan::Nothing | Plan::Descend { .. } => Answer::Descended,
        }
    }
}
