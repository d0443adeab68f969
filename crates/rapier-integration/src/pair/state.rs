use std::sync::LazyLock;

use parry3d::query::details::{
    TypedWorkspaceData, VoxelsShapeContactManifoldsWorkspace, WorkspaceData,
};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};
use sbbk_core::contact::FeaturePair;

use super::coherence::Coherence;
use crate::mesh::{MeshToken, PreparedRef};

/// What a pair of meshes keeps from query to query: the workspace that the host stores with the pair.
///
/// Everything in it can be lost at any time and costs only time then.
#[derive(Clone)]
pub(super) struct PairState<M, C> {
    pub(super) meshes: KnownMeshes,
    pub(super) coherence: Coherence,
    pub(super) history: History<M, C>,
}

/// The trees of the pair, as far as they are known.
#[derive(Clone)]
pub(super) enum KnownMeshes {
    /// No query has needed them yet.
    None,
    /// Valid while the tokens are.
    Trees([MeshToken; 2], [PreparedRef; 2]),
}

/// What the manifolds of the last query leave behind for the next: their features, and buffers, as a fresh manifold
/// costs ten times as much as a used one.
#[derive(Clone)]
pub(super) struct History<M, C> {
    /// The features that made each of the manifolds, in their order.
    pub(super) features: Vec<Option<FeaturePair>>,
    pub(super) next: Vec<ContactManifold<M, C>>,
    pub(super) next_features: Vec<Option<FeaturePair>>,
    pub(super) previous_points: Vec<TrackedContact<C>>,
    spare: Vec<ContactManifold<M, C>>,
    /// Manifolds that the pair has had at once of late: as many are kept, in use or spare.
    peak: usize,
    /// Queries since it had as many.
    age: u8,
}

impl<M, C> Default for PairState<M, C> {
    fn default() -> Self {
        Self {
            meshes: KnownMeshes::None,
            coherence: Coherence::default(),
            history: History::default(),
        }
    }
}

impl<M, C> Default for History<M, C> {
    fn default() -> Self {
        Self {
            features: Vec::new(),
            next: Vec::new(),
            next_features: Vec::new(),
            previous_points: Vec::new(),
            spare: Vec::new(),
            peak: 0,
            age: 0,
        }
    }
}

impl<M, C> PairState<M, C>
where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    /// The state in `workspace`, made anew where there is none.
    ///
    /// The manifolds of a pair *without* a workspace are dropped: the host has taken it away since a shape changed, and
    /// the numbers of triangles in them may mean others now. With the workspace of somebody else (a restored
    /// snapshot, a dispatcher that was here before) the manifolds are kept: the shapes are the same.
    pub(super) fn of<'a>(
        workspace: &'a mut Option<ContactManifoldsWorkspace>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> &'a mut Self {
        if workspace.is_none() {
            manifolds.clear();
        }
        let is_ours = |workspace: &ContactManifoldsWorkspace| workspace.0.is::<Self>();
        if !workspace.as_ref().is_some_and(is_ours) {
            *workspace = Some(Self::default().into());
        }
        let state = workspace.as_mut().and_then(|workspace| workspace.0.downcast_mut());
        state.expect("the workspace was made of this type just now")
    }
}

impl<M, C> History<M, C>
where
    M: Default,
    C: Default + Copy,
{
    /// Queries after which the memory of more manifolds than the pair now has is given back, a quarter at a time.
    /// More: memory is kept longer. Fewer: allocations where contacts come and go.
    const PATIENCE: u8 = 64;

    /// Ends a query: remembers how many manifolds the pair has had of late.
    pub(super) fn settle(&mut self, count: usize) {
        self.age += 1;
        if count >= self.peak {
            (self.peak, self.age) = (count, 0);
        } else if self.age >= Self::PATIENCE {
            (self.peak, self.age) = (count.max(self.peak - self.peak.div_ceil(4)), 0);
            self.spare.truncate(self.peak - count);
        }
    }

    /// Whether these are the manifolds that the last query left.
    pub(super) fn is_of(&self, manifolds: &[ContactManifold<M, C>]) -> bool {
        self.features.len() == manifolds.len()
    }

    /// An empty manifold for a pair of triangles.
    pub(super) fn manifold(&mut self, triangle1: u32, triangle2: u32) -> ContactManifold<M, C> {
        let mut manifold = self.spare.pop().unwrap_or_default();
        manifold.subshape1 = triangle1;
        manifold.subshape2 = triangle2;
        manifold
    }

    /// Adds a manifold to those of this query, if it has points.
    #[inline(always)]
    pub(super) fn keep(&mut self, manifold: ContactManifold<M, C>, features: FeaturePair) {
        if manifold.points.is_empty() {
            self.retire(manifold);
        } else {
            self.next.push(manifold);
            self.next_features.push(Some(features));
        }
    }

    /// Takes back a manifold that is no longer used. Nothing of it but its memory survives.
    pub(super) fn retire(&mut self, mut manifold: ContactManifold<M, C>) {
        if self.next.len() + self.spare.len() < self.peak {
            manifold.points.clear();
            manifold.local_n1 = Default::default();
            manifold.local_n2 = Default::default();
            manifold.subshape_poses = None;
            manifold.data = M::default();
            self.spare.push(manifold);
        }
    }
}

/// What a snapshot holds in place of our state.
///
/// Parry can store only its own kinds of workspace: a custom one makes the whole snapshot unreadable. This one is
/// empty, is replaced at the next query by whatever dispatcher the restored world has, and keeps the manifolds.
static PLACEHOLDER: LazyLock<VoxelsShapeContactManifoldsWorkspace<2>> =
    LazyLock::new(VoxelsShapeContactManifoldsWorkspace::new);

impl<M, C> WorkspaceData for PairState<M, C>
where
    M: Clone + Send + Sync + 'static,
    C: Clone + Send + Sync + 'static,
{
    fn as_typed_workspace_data(&self) -> TypedWorkspaceData<'_> {
        TypedWorkspaceData::VoxelsShapeContactManifoldsWorkspace(&PLACEHOLDER)
    }

    fn clone_dyn(&self) -> Box<dyn WorkspaceData> {
        Box::new(self.clone())
    }
}
