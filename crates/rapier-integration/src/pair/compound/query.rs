use std::sync::Arc;

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{Compound, TriMesh};
use sbbk_core::traverse::Counters;

use super::state::{CompoundState, CompoundToken, KnownShapes, PartState, PartStates};
use crate::mesh::{Change, Held, PreparedMesh, TreeCache, root_box};
use crate::pair::convex::{ConvexPair, ConvexShape};
use crate::pair::state::state_in;
use crate::pair::{Answer, Question};

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

    /// The box around the mesh in the frame of the compound, as far as its parts can touch it; around all of them, if the mesh is
    /// broken.
    fn mesh_box(&self) -> Aabb {
        let Some(root) = root_box(self.mesh) else {
            return *self.compound.local_aabb();
        };
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

    /// The tree of the mesh, from the state if it is known and still valid, refitted if the mesh has deformed. Unless nothing
    /// has changed, what is known of the parts is forgotten; the manifolds as well if a shape was edited while the host kept the
    /// workspace. Those of another dispatcher are of Parry's routine too, and those of a mesh that has deformed keep their
    /// data, but not their points.
    fn tree<'s, M, C: Default + Copy>(
        &self,
        cache: &Arc<TreeCache>,
        (known, known_compound): &'s mut KnownShapes,
        parts: &mut PartStates<M, C>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<Held<'s>> {
        let (mut change, tree) = cache.noting(self.mesh, known.update(self.mesh, cache))?;
        let compound = CompoundToken::of(self.compound);
        if known_compound.replace(compound).is_some_and(|known| known != compound) {
            change = Change::Replaced;
        }
        if change != Change::Unchanged {
            parts.forget(self.compound.shapes().len());
        }
        match change {
            Change::Unchanged | Change::Unknown => {}
            Change::Deformed => {
                manifolds.iter_mut().for_each(ContactManifold::mark_shapes_deformed)
            }
            Change::Replaced => manifolds.clear(),
        }
        tree.drop_broken(manifolds, |manifold| self.subshapes(manifold)[0]);
        Some(tree)
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

impl Question for CompoundPair<'_> {
    fn contact_manifolds<M, C>(
        self,
        cache: &Arc<TreeCache>,
        mut counters: impl Counters,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        if cache.is_unsupported(&[self.mesh]) {
            return Answer::Unsupported;
        }
        let CompoundState { shapes, parts } = state_in(workspace, manifolds);
        let mesh_box = self.mesh_box();
        let is_alone = || self.compound.bvh().intersect_aabb(&mesh_box).next().is_none();
        if shapes.0.is_unknown() && is_alone() {
            manifolds.clear();
            return Answer::Apart;
        }
        let Some(prepared) = self.tree(cache, shapes, parts, manifolds) else {
            return Answer::Unsupported;
        };
        let PartStates { last, near, parts } = parts;
        if *last == Some((*self.pos12, self.prediction, manifolds.len())) {
            return Answer::Unchanged;
        }
        for manifold in manifolds.drain(..) {
            let [_, part] = self.subshapes(&manifold);
            if let Some(part) = parts.get_mut(part as usize) {
                part.manifolds.push(manifold);
            }
        }
        near.clear();
        near.extend(self.compound.bvh().intersect_aabb(&mesh_box));
        parts.iter_mut().for_each(|part| part.place = u32::MAX);
        let mut answer = Answer::Apart;
        for (place, &index) in near.iter().enumerate() {
            let part = &mut parts[index as usize];
            part.place = place as u32;
            let of_part = self.update_part(index, &prepared, part, &mut counters);
            answer = answer.max(of_part);
        }
        parts.iter_mut().filter(|part| part.place == u32::MAX).for_each(PartState::leave);
        self.gather(&prepared, (near, parts), manifolds);
        *last = Some((*self.pos12, self.prediction, manifolds.len()));
        answer
    }
}
