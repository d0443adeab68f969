use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use parry3d::shape::Compound;

use crate::mesh::KnownMesh;
use crate::pair::coherence::Coherence;
use crate::pair::convex::{Fingerprint, NearTriangle};
use crate::pair::state::History;

/// What the pair keeps from query to query.
#[derive(Clone)]
pub(super) struct CompoundState<M, C> {
    pub(super) shapes: KnownShapes,
    pub(super) parts: PartStates<M, C>,
}

/// The mesh, as far as it is known, and the compound that the states of the parts are for.
pub(super) type KnownShapes = (KnownMesh, Option<CompoundToken>);

/// What is known of the parts.
#[derive(Clone)]
pub(super) struct PartStates<M, C> {
    /// Pose and prediction distance of the last query, and how many manifolds it left.
    pub(super) last: Option<(Pose, Real, usize)>,
    /// The parts near the mesh, in the order of the compound's hierarchy.
    pub(super) near: Vec<u32>,
    pub(super) parts: Vec<PartState<M, C>>,
}

/// The mesh and one part.
#[derive(Clone)]
pub(super) struct PartState<M, C> {
    /// What the candidates are for.
    pub(super) shape: Option<Fingerprint>,
    pub(super) coherence: Coherence<NearTriangle>,
    pub(super) history: History<M, C, ()>,
    /// The part's own, during a query; empty else.
    pub(super) manifolds: Vec<ContactManifold<M, C>>,
    /// Its place among the parts that are near.
    pub(super) place: u32,
}

/// What a compound was at the last query, in constant time. Parry lets nobody edit its parts; a host drops the workspace when it
/// puts another one in its place, and this is for those that do not.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct CompoundToken {
    address: usize,
    part_count: usize,
    flags: u8,
    aabb: Aabb,
}

impl CompoundToken {
    pub(super) fn of(compound: &Compound) -> Self {
        Self {
            address: compound.shapes().as_ptr() as usize,
            part_count: compound.shapes().len(),
            flags: compound.flags().bits(),
            aabb: *compound.local_aabb(),
        }
    }
}

impl<M, C> Default for CompoundState<M, C> {
    fn default() -> Self {
        let parts = PartStates { last: None, near: Vec::new(), parts: Vec::new() };
        Self { shapes: KnownShapes::default(), parts }
    }
}

impl<M, C> PartStates<M, C> {
    /// Leaves nothing of what is known but memory, of so many parts.
    pub(super) fn forget(&mut self, count: usize) {
        self.last = None;
        self.parts.resize_with(count, PartState::default);
        for part in &mut self.parts {
            part.shape = None;
            part.coherence.clear();
        }
    }
}

impl<M, C> Default for PartState<M, C> {
    fn default() -> Self {
        Self {
            shape: None,
            coherence: Coherence::default(),
            history: History::default(),
            manifolds: Vec::new(),
            place: u32::MAX,
        }
    }
}

impl<M: Default, C: Default + Copy> PartState<M, C> {
    /// Takes note of the shape. If it is another one, forgets what is known of the old one.
    pub(super) fn begin(&mut self, shape: Fingerprint) {
        if self.shape.replace(shape).is_some_and(|old| old != shape) {
            self.coherence.clear();
            self.manifolds.clear();
        }
    }

    /// Retires the manifolds of a part that is not near any more.
    pub(super) fn leave(&mut self) {
        self.place = u32::MAX;
        if !self.manifolds.is_empty() {
            self.history.begin(&self.manifolds);
            self.manifolds.drain(..).for_each(|manifold| self.history.retire(manifold));
            self.history.end(&mut self.manifolds);
        }
    }
}
