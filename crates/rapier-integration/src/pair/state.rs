use std::sync::LazyLock;

use parry3d::query::details::{
    TypedWorkspaceData, VoxelsShapeContactManifoldsWorkspace, WorkspaceData,
};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace, TrackedContact};

use super::coherence::Coherence;

/// What kind of shapes a pair has: two meshes, or a mesh and a convex shape.
pub(super) trait PairKind: Clone + 'static {
    /// What is known of the shapes; nothing by default.
    type Shapes: Clone + Default + Send + Sync;
    /// What may touch.
    type Candidate: Clone + Send + Sync;
    /// What is kept of a contact, beside its manifold.
    type Contact: Copy + Send + Sync;
}

/// What a pair keeps from query to query: the workspace that the host stores with the pair.
///
/// Everything in it can be lost at any time and costs only time then.
#[derive(Clone)]
pub(super) struct PairState<M, C, K: PairKind> {
    pub(super) shapes: K::Shapes,
    pub(super) coherence: Coherence<K::Candidate>,
    pub(super) history: History<M, C, K::Contact>,
}

/// What the manifolds of the last query leave behind for the next: what is known of their contacts, and buffers, as a
/// fresh manifold costs ten times as much as a used one.
#[derive(Clone)]
pub(super) struct History<M, C, K> {
    /// Of each of the manifolds, in their order.
    pub(super) contacts: Vec<Option<K>>,
    /// So many of the old manifolds, from the first, stay where they are. None once there are next ones: then those are all.
    in_place: usize,
    next: Vec<ContactManifold<M, C>>,
    next_contacts: Vec<Option<K>>,
    pub(super) previous_points: Vec<TrackedContact<C>>,
    spare: Vec<ContactManifold<M, C>>,
    /// Manifolds that a query has needed at once of late: as many are kept, in use or spare. New ones come before old ones
    /// go, so it can be more than the pair has had.
    peak: usize,
    /// The fewest spare ones during this query.
    least_spare: usize,
    /// Queries since it had as many.
    age: u8,
}

impl<M, C, K: PairKind> Default for PairState<M, C, K> {
    fn default() -> Self {
        Self {
            shapes: K::Shapes::default(),
            coherence: Coherence::default(),
            history: History::default(),
        }
    }
}

impl<M, C, K> Default for History<M, C, K> {
    fn default() -> Self {
        Self {
            contacts: Vec::new(),
            in_place: 0,
            next: Vec::new(),
            next_contacts: Vec::new(),
            previous_points: Vec::new(),
            spare: Vec::new(),
            peak: 0,
            least_spare: 0,
            age: 0,
        }
    }
}

/// The state in `workspace`, made anew where there is none.
///
/// The manifolds of a pair *without* a workspace are dropped: the host has taken it away since a shape changed, and
/// the numbers of triangles in them may mean others now. With the workspace of somebody else (a restored
/// snapshot, a dispatcher that was here before) the manifolds are kept: the shapes are the same.
pub(super) fn state_in<'a, S, M, C>(
    workspace: &'a mut Option<ContactManifoldsWorkspace>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) -> &'a mut S
where
    S: Clone + Default + Send + Sync + 'static,
{
    if workspace.is_none() {
        manifolds.clear();
    }
    let is_ours = |workspace: &ContactManifoldsWorkspace| workspace.0.is::<Kept<S>>();
    if !workspace.as_ref().is_some_and(is_ours) {
        *workspace = Some(Kept(S::default()).into());
    }
    let state = workspace.as_mut().and_then(|workspace| workspace.0.downcast_mut());
    let Kept(state) = state.expect("the workspace was made of this type just now");
    state
}

impl<M, C, K> History<M, C, K>
where
    M: Default,
    C: Default + Copy,
    K: Copy,
{
    /// Queries after which the memory of more manifolds than the pair now has is given back, a quarter at a time.
    /// More: memory is kept longer. Fewer: allocations where contacts come and go.
    const PATIENCE: u8 = 64;

    /// Begins a query. Of manifolds that are not those of the last query, somebody else's, nothing is known.
    pub(super) fn begin(&mut self, manifolds: &[ContactManifold<M, C>]) {
        // There is something left only if the last query ended in a panic.
        self.in_place = 0;
        self.next.clear();
        self.next_contacts.clear();
        self.least_spare = self.spare.len();
        if !self.is_of(manifolds) {
            self.contacts.clear();
            self.contacts.resize(manifolds.len(), None);
        }
    }

    /// Ends a query: `manifolds`, which hold nothing else of use any more, become those that were kept.
    pub(super) fn end(&mut self, manifolds: &mut Vec<ContactManifold<M, C>>) {
        manifolds.truncate(std::mem::take(&mut self.in_place));
        if !self.next.is_empty() {
            std::mem::swap(manifolds, &mut self.next);
        }
        self.settle(manifolds.len());
        self.contacts.clear();
        std::mem::swap(&mut self.contacts, &mut self.next_contacts);
    }

    /// Remembers how many manifolds the query has needed.
    fn settle(&mut self, count: usize) {
        let needed = count.max((count + self.spare.len()).saturating_sub(self.least_spare));
        self.age += 1;
        if needed >= self.peak {
            (self.peak, self.age) = (needed, 0);
        } else if self.age >= Self::PATIENCE {
            (self.peak, self.age) = (needed.max(self.peak - self.peak.div_ceil(4)), 0);
            self.spare.truncate(self.peak - count);
        }
    }

    /// Whether these are the manifolds that the last query left.
    pub(super) fn is_of(&self, manifolds: &[ContactManifold<M, C>]) -> bool {
        self.contacts.len() == manifolds.len()
    }

    /// An empty manifold for a pair of triangles.
    pub(super) fn manifold(&mut self, triangle1: u32, triangle2: u32) -> ContactManifold<M, C> {
        let mut manifold = self.spare.pop().unwrap_or_else(|| {
            self.peak += 1;
            ContactManifold::default()
        });
        self.least_spare = self.least_spare.min(self.spare.len());
        manifold.subshape1 = triangle1;
        manifold.subshape2 = triangle2;
        manifold
    }

    /// Adds a new manifold to those of this query, if it has points.
    #[inline(always)]
    pub(super) fn keep(
        &mut self,
        manifold: ContactManifold<M, C>,
        contact: K,
        manifolds: &mut [ContactManifold<M, C>],
    ) {
        if manifold.points.is_empty() {
            self.retire(manifold);
        } else {
            self.move_out(manifolds);
            self.next.push(manifold);
            self.next_contacts.push(Some(contact));
        }
    }

    /// The same for an old one. As long as nothing comes or goes it stays in its place: to move a manifold takes as
    /// long as to update its distances.
    #[inline(always)]
    pub(super) fn keep_at(
        &mut self,
        place: usize,
        contact: K,
        manifolds: &mut [ContactManifold<M, C>],
    ) {
        if manifolds[place].points.is_empty() {
            return self.retire(std::mem::take(&mut manifolds[place]));
        }
        if self.next.is_empty() && place == self.in_place {
            self.in_place += 1;
        } else {
            self.move_out(manifolds);
            self.next.push(std::mem::take(&mut manifolds[place]));
        }
        self.next_contacts.push(Some(contact));
    }

    /// From here on the manifolds of this query are no longer the old ones.
    fn move_out(&mut self, manifolds: &mut [ContactManifold<M, C>]) {
        let stayed = &mut manifolds[..std::mem::take(&mut self.in_place)];
        self.next.extend(stayed.iter_mut().map(std::mem::take));
    }

    /// Takes back a manifold that is no longer used. Nothing of it but its memory survives.
    pub(super) fn retire(&mut self, mut manifold: ContactManifold<M, C>) {
        if self.in_place + self.next.len() + self.spare.len() < self.peak {
            reset(&mut manifold);
            self.spare.push(manifold);
        }
    }

    /// The same, but the manifold goes to `unused`, at hand for the next triangle, if there is none.
    pub(super) fn retire_unless_first(
        &mut self,
        unused: &mut Option<ContactManifold<M, C>>,
        mut manifold: ContactManifold<M, C>,
    ) {
        if unused.is_none() {
            reset(&mut manifold);
            *unused = Some(manifold);
        } else {
            self.retire(manifold);
        }
    }
}

/// Leaves nothing of a manifold but its memory, that of the pose of a part among it: whoever has parts sets it anew.
fn reset<M: Default, C>(manifold: &mut ContactManifold<M, C>) {
    manifold.points.clear();
    manifold.local_n1 = Default::default();
    manifold.local_n2 = Default::default();
    manifold.data = M::default();
}

/// What a snapshot holds in place of our state.
///
/// Parry can store only its own kinds of workspace: a custom one makes the whole snapshot unreadable. This one is
/// empty, is replaced at the next query by whatever dispatcher the restored world has, and keeps the manifolds.
static PLACEHOLDER: LazyLock<VoxelsShapeContactManifoldsWorkspace<2>> =
    LazyLock::new(VoxelsShapeContactManifoldsWorkspace::new);

/// The state of a pair of any kind, as the host keeps it.
#[derive(Clone)]
struct Kept<S>(S);

impl<S: Clone + Send + Sync + 'static> WorkspaceData for Kept<S> {
    fn as_typed_workspace_data(&self) -> TypedWorkspaceData<'_> {
        TypedWorkspaceData::VoxelsShapeContactManifoldsWorkspace(&PLACEHOLDER)
    }

    fn clone_dyn(&self) -> Box<dyn WorkspaceData> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use oorandom::Rand32;
    use parry3d::math::Vector;
    use parry3d::shape::PackedFeatureId;

    use super::*;

    type Manifold = ContactManifold<(), ()>;

    fn manifold(name: u32, has_points: bool) -> Manifold {
        let mut manifold = Manifold::with_data(name, 0, ());
        let (at, id) = (Vector::ZERO, PackedFeatureId::UNKNOWN);
        manifold.points.extend(has_points.then(|| TrackedContact::new(at, at, id, id, 0.0)));
        manifold
    }

    /// Would catch manifolds that are lost, doubled or out of order when some stay in place, some go and some are new, and a
    /// query before, ended by a panic, that is not over.
    #[test]
    fn what_is_kept_is_there_in_the_order_in_which_it_was_kept() {
        let mut random = Rand32::new(3);
        let mut history = History::<(), (), u32>::default();
        let mut manifolds = Vec::new();
        let (mut next_name, mut stayed, mut moved) = (0, 0, 0);
        for _ in 0..3000 {
            let is_lively = random.rand_float() < 0.6;
            let is_cut_off = random.rand_float() < 0.05;
            let mut chance = |share: f32| is_lively && random.rand_float() < share;
            let before = manifolds.as_ptr();
            history.begin(&manifolds);
            let mut expected = Vec::new();
            for place in 0..manifolds.len() {
                if chance(0.1) {
                    next_name += 1;
                    let is_kept = !chance(0.3);
                    history.keep(manifold(next_name, is_kept), next_name, &mut manifolds);
                    expected.extend(is_kept.then_some(next_name));
                }
                let name = manifolds[place].subshape1;
                if chance(0.1) {
                    history.retire(std::mem::take(&mut manifolds[place]));
                    continue;
                }
                if chance(0.1) {
                    manifolds[place].points.clear();
                } else {
                    expected.push(name);
                }
                history.keep_at(place, name, &mut manifolds);
            }
            if is_cut_off {
                // What a panic leaves; nobody says which manifolds are left then.
                manifolds.clear();
                continue;
            }
            if manifolds.len() < 8 {
                next_name += 1;
                history.keep(manifold(next_name, true), next_name, &mut manifolds);
                expected.push(next_name);
            }
            history.end(&mut manifolds);
            let names: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
            assert_eq!(names, expected);
            let contacts: Vec<u32> = history.contacts.iter().flatten().copied().collect();
            assert_eq!(contacts, expected);
            *(if manifolds.as_ptr() == before { &mut stayed } else { &mut moved }) += 1;
        }
        assert!(stayed > 300 && moved > 300, "{stayed} stayed, {moved} moved");
    }
}
