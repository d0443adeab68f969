use std::sync::Arc;

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{Compound, TriMesh};
use sbbk_core::traverse::Counters;

use super::state::{CompoundState, CompoundToken, PartState};
use crate::mesh::{MeshToken, PreparedMesh, PreparedRef, TreeCache};
use crate::pair::Answer;
use crate::pair::convex::{ConvexPair, ConvexShape};
use crate::pair::state::state_in;

/// The question: which contacts do a mesh and a compound have?
#[derive(Copy, Clone)]
pub(crate) struct CompoundPair<'a> {
    /// The pose of shape 2 in the frame of shape 1.
    pub(crate) pos12: &'a Pose,
    pub(crate) mesh: &'a TriMesh,
    pub(crate) compound: &'a Compound,
    /// Whether the mesh is shape 2.
    pub(crate) flipped: bool,
    pub(crate) prediction: Real,
}

/// How much farther than the prediction distance parts are looked for, as a share of the size of the compound: Parry's GJK sees a
/// thousandth of a part's radius too far, and boxes are rounded.
const SIGHT_SHARE: Real = 2e-3;

impl CompoundPair<'_> {
    /// Whether all parts are of kinds that pairs with a mesh are answered for.
    pub(crate) fn is_known(compound: &Compound) -> bool {
        compound.shapes().iter().all(|(_, part)| ConvexShape::is_known(part.shape_type()))
    }

    /// The box around the mesh in the frame of the compound, as far as its parts can touch it.
    fn mesh_box(&self) -> Aabb {
        let root = self.mesh.bvh().root_aabb();
        let pose = if self.flipped { *self.pos12 } else { self.pos12.inverse() };
        let parts = self.compound.local_aabb();
        let size = parts.half_extents().length()
            + root.half_extents().length()
            + root.center().length()
            + pose.translation.length();
        let prediction = self.prediction.max(0.0);
        let reach = prediction + SIGHT_SHARE * (prediction + size);
        // A pose that is not a number is nowhere.
        if reach >= 0.0 { root.transform_by(&pose).loosened(reach) } else { Aabb::new_invalid() }
    }

    /// Whether stock walks shape 2 first: it does so if its box is larger.
    fn is_second_first(&self) -> bool {
        let mesh = self.mesh.bvh().root_aabb().half_extents().length_squared();
        let compound = self.compound.bvh().root_aabb().half_extents().length_squared();
        if self.flipped { compound < mesh } else { mesh < compound }
    }

    /// The pose of shape 2 in the frame of shape 1 with a part in place of the compound: with stock's roundings.
    fn part_pose(&self, part: &Pose) -> Pose {
        let pos12 = self.pos12;
        match (self.flipped, self.is_second_first()) {
            (false, true) => *pos12 * *part,
            (false, false) => part.inv_mul(&pos12.inverse()).inverse(),
            (true, true) => part.inv_mul(pos12),
            (true, false) => (pos12.inverse() * *part).inverse(),
        }
    }

    /// Of a manifold, the triangle of the mesh and the part of the compound.
    fn subshapes<M, C>(&self, manifold: &ContactManifold<M, C>) -> [u32; 2] {
        let [one, two] = [manifold.subshape1, manifold.subshape2];
        if self.flipped { [two, one] } else { [one, two] }
    }

    /// The tree of the mesh, known to be valid. Else what is known of the pair is forgotten, and its manifolds as well if a
    /// shape was edited while the host kept the workspace. Those of another dispatcher are of Parry's routine too.
    fn recognise<M, C>(
        &self,
        cache: &Arc<TreeCache>,
        state: &mut CompoundState<M, C>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<()> {
        let now = (MeshToken::of(self.mesh), CompoundToken::of(self.compound));
        let before = state.known.as_ref().map(|(mesh, compound, _)| (*mesh, *compound));
        let is_from = |(_, _, tree): &(_, _, PreparedRef)| tree.is_from(cache);
        if before == Some(now) && state.known.as_ref().is_some_and(is_from) {
            return Some(());
        }
        *state = CompoundState::default();
        if before.is_some_and(|before| before != now) {
            manifolds.clear();
        }
        let tree = cache.noting(self.mesh, cache.prepare(self.mesh))?;
        state.known = Some((now.0, now.1, tree));
        state.parts.resize_with(self.compound.shapes().len(), PartState::default);
        Some(())
    }

    /// Brings the manifolds of a part up to date.
    fn update_part<M, C>(
        &self,
        index: u32,
        prepared: &PreparedMesh,
        state: &mut PartState<M, C>,
        counters: impl Counters,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let (place, part) = &self.compound.shapes()[index as usize];
        let Some(shape) = ConvexShape::of(&**part) else {
            return Answer::Unsupported;
        };
        let pose = self.part_pose(place);
        state.begin(shape.fingerprint());
        let PartState { coherence, history, manifolds, .. } = state;
        let pair = ConvexPair {
            pos12: &pose,
            mesh: self.mesh,
            shape,
            cone: self.compound.part_normal_constraints(index),
            flipped: self.flipped,
            prediction: self.prediction,
            parrys_pose: pose,
        };
        pair.update(prepared, (coherence, history), counters, manifolds)
    }

    /// Puts the manifolds of all parts together, with their names, in stock order.
    fn gather<M, C>(
        &self,
        prepared: &PreparedMesh,
        (near, parts): (&[u32], &mut [PartState<M, C>]),
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) {
        for &index in near {
            let place = self.compound.shapes()[index as usize].0;
            let named = |mut manifold: ContactManifold<M, C>| {
                if self.flipped {
                    manifold.subshape1 = index;
                    manifold.set_subshape_pos1(Some(place));
                } else {
                    manifold.subshape2 = index;
                    manifold.set_subshape_pos2(Some(place));
                }
                manifold
            };
            manifolds.extend(parts[index as usize].manifolds.drain(..).map(named));
        }
        let is_mesh_first = self.flipped == self.is_second_first();
        if is_mesh_first {
            let key = |manifold: &ContactManifold<M, C>| {
                let [triangle, part] = self.subshapes(manifold);
                (prepared.rank(triangle), parts[part as usize].place)
            };
            manifolds.sort_unstable_by_key(key);
        }
    }
}

/// Brings the manifolds of a mesh and a compound up to date.
pub(crate) fn contact_manifolds<M, C>(
    pair: CompoundPair<'_>,
    cache: &Arc<TreeCache>,
    mut counters: impl Counters,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> Answer
where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    if cache.is_unsupported(&[pair.mesh]) {
        return Answer::Unsupported;
    }
    let state: &mut CompoundState<M, C> = state_in(workspace, manifolds);
    let mesh_box = pair.mesh_box();
    if state.known.is_none() && pair.compound.bvh().intersect_aabb(&mesh_box).next().is_none() {
        manifolds.clear();
        return Answer::Apart;
    }
    if pair.recognise(cache, state, manifolds).is_none() {
        return Answer::Unsupported;
    }
    let CompoundState { known: Some((_, _, tree)), last, near, parts } = state else {
        return Answer::Unsupported;
    };
    if *last == Some((*pair.pos12, pair.prediction, manifolds.len())) {
        return Answer::Unchanged;
    }
    for manifold in manifolds.drain(..) {
        let [_, part] = pair.subshapes(&manifold);
        if let Some(part) = parts.get_mut(part as usize) {
            part.manifolds.push(manifold);
        }
    }
    let prepared = tree.get();
    near.clear();
    near.extend(pair.compound.bvh().intersect_aabb(&mesh_box));
    parts.iter_mut().for_each(|part| part.place = u32::MAX);
    let mut answer = Answer::Apart;
    for (place, &index) in near.iter().enumerate() {
        let part = &mut parts[index as usize];
        part.place = place as u32;
        let of_part = pair.update_part(index, prepared, part, &mut counters);
        answer = answer.or_harder(of_part);
    }
    parts.iter_mut().filter(|part| part.place == u32::MAX).for_each(PartState::leave);
    pair.gather(prepared, (near, parts), manifolds);
    *last = Some((*pair.pos12, pair.prediction, manifolds.len()));
    answer
}
