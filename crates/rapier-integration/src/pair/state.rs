use std::sync::LazyLock;

use parry3d::query::details::{
    TypedWorkspaceData, VoxelsShapeContactManifoldsWorkspace, WorkspaceData,
};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};

use super::memory::PairMemory;

/// The workspace that the host stores with a pair: what is known of its shapes, `S`, and what the
/// last queries found.
///
/// Everything in it can be lost at any time and costs only time then.
#[derive(Clone)]
pub(super) struct PairState<S, H> {
    pub(super) shapes: S,
    pub(super) memory: PairMemory<H>,
}

impl<S: Default, H> Default for PairState<S, H> {
    fn default() -> Self {
        Self { shapes: S::default(), memory: PairMemory::default() }
    }
}

/// The state in `workspace`, made anew where there is none.
///
/// The manifolds of a pair *without* a workspace are dropped: the host has taken it away since a
/// shape changed, and the numbers of triangles in them may mean others now. With the workspace of
/// another dispatcher (a restored snapshot, stock before) the manifolds are kept: the shapes are
/// the same.
pub(super) fn state_in<'a, M, C, S, H>(
    workspace: &'a mut Option<ContactManifoldsWorkspace>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) -> &'a mut PairState<S, H>
where
    PairState<S, H>: Clone + Default + Send + Sync + 'static,
{
    if workspace.is_none() {
        manifolds.clear();
    }
    let is_ours =
        |workspace: &ContactManifoldsWorkspace| workspace.0.is::<Stored<PairState<S, H>>>();
    if !workspace.as_ref().is_some_and(is_ours) {
        *workspace = Some(Stored(PairState::<S, H>::default()).into());
    }
    let state = workspace.as_mut().and_then(|workspace| workspace.0.downcast_mut());
    let Stored(state) = state.expect("the workspace was made of this type just now");
    state
}

/// What a snapshot holds in place of our state.
///
/// Parry can store only its own kinds of workspace: a custom one makes the whole snapshot
/// unreadable. This one is empty. The next query replaces it, whatever dispatcher the restored
/// world has, and keeps the manifolds.
static PLACEHOLDER: LazyLock<VoxelsShapeContactManifoldsWorkspace<2>> =
    LazyLock::new(VoxelsShapeContactManifoldsWorkspace::new);

/// The state of a pair of any kind, as the host keeps it.
#[derive(Clone)]
struct Stored<S>(S);

impl<S: Clone + Send + Sync + 'static> WorkspaceData for Stored<S> {
    fn as_typed_workspace_data(&self) -> TypedWorkspaceData<'_> {
        TypedWorkspaceData::VoxelsShapeContactManifoldsWorkspace(&PLACEHOLDER)
    }

    fn clone_dyn(&self) -> Box<dyn WorkspaceData> {
        Box::new(self.clone())
    }
}
