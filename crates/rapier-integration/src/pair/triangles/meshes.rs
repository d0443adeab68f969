use std::sync::Arc;

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{TriMesh, Triangle};
use sbbk_core::contact::ManifoldPoints;
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{Counters, Descent, PairFrame, Verdict, Visitor, descend};
use sbbk_core::tree::LeafBatch;

use super::exact::Constraints;
use super::query::{Hint, TriangleQuery, TriangleShapes};
use crate::ContactGenerator;
use crate::mesh::{Change, Held, KnownMesh, PreparedMesh, TreeCache, placed_root_box, root_box};
use crate::pair::driver::{Moving, Pair, Scratch};
use crate::pair::order::OrderKey;
use crate::pair::pose::PairPose;

/// Two meshes.
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) meshes: [&'a TriMesh; 2],
    pub(crate) contacts: ContactGenerator,
}

impl MeshPair<'_> {
    /// Whether Parry walks mesh 2 first: it does so if its box is larger.
    fn is_second_first(&self) -> bool {
        let size = |mesh: &TriMesh| mesh.bvh().root_aabb().half_extents().length_squared();
        size(self.meshes[0]) < size(self.meshes[1])
    }

    /// The pose that stock Parry passes on: bit for bit, it inverts the pose twice if it does not
    /// swap the meshes.
    fn parrys_pose(&self, is_second_first: bool) -> Pose {
        let pos12 = self.pose.pos12;
        if is_second_first { pos12 } else { pos12.inverse().inverse() }
    }
}

impl<'a> Pair for MeshPair<'a> {
    type Known = [KnownMesh; 2];
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q, Meshes<'q>>
    where
        Self: 'q;

    fn is_unsupported(&self, cache: &TreeCache) -> bool {
        cache.is_unsupported(&self.meshes)
    }

    fn needs_trees(known: &Self::Known) -> bool {
        known.iter().any(KnownMesh::is_unknown)
    }

    fn boxes_meet(&self, _: &mut impl Counters) -> bool {
        let [mesh1, mesh2] = self.meshes;
        let PairPose { pos12, prediction, .. } = self.pose;
        let boxes = (root_box(mesh1), placed_root_box(mesh2, pos12, prediction.max(0.0)));
        let (Some(box1), Some(box2)) = boxes else {
            return true;
        };
        box1.intersects(&box2)
    }

    fn open<'q>(
        &'q self,
        cache: &Arc<TreeCache>,
        [known1, known2]: &'q mut [KnownMesh; 2],
    ) -> Option<(Change, Self::Query<'q>)> {
        let [mesh1, mesh2] = self.meshes;
        let (change1, tree1) = cache.noting(mesh1, known1.update(mesh1, cache))?;
        let (change2, tree2) = cache.noting(mesh2, known2.update(mesh2, cache))?;
        let is_second_first = self.is_second_first();
        let query = TriangleQuery {
            shapes: Meshes { pair: self, prepared: [tree1, tree2], is_second_first },
            pose: self.pose,
            parrys_pose: self.parrys_pose(is_second_first),
            generator: self.contacts,
            points: ManifoldPoints::new(),
        };
        Some((change1.max(change2), query))
    }
}

/// Two meshes and their trees.
pub(crate) struct Meshes<'q> {
    pair: &'q MeshPair<'q>,
    prepared: [Held<'q>; 2],
    /// Whether Parry walks mesh 2 first.
    is_second_first: bool,
}

impl TriangleShapes for Meshes<'_> {
    fn moving(&self) -> Moving {
        let ball = self.prepared[1].tree.bounding_ball();
        Moving { ball, placement: self.pair.pose.placement12 }
    }

    fn descend(
        &self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        found: impl FnMut([u32; 2]),
    ) {
        let prepared = self.prepared.each_ref().map(|held| &**held);
        let trees = (&prepared[0].tree, &prepared[1].tree);
        let mut frame = PairFrame::at(trees, self.pair.pose.placement12, margin);
        let mut collector = Collector { prepared, test: LeafTest::new(&frame), found };
        let (stack, way) = (&mut scratch.descent, Descent::Simultaneous);
        descend(trees, &mut frame, way, stack, counters, &mut collector);
    }

    #[inline(always)]
    fn key(&self, triangles: [u32; 2]) -> OrderKey {
        let ranks = [0, 1].map(|i| self.prepared[i].rank(triangles[i]));
        OrderKey::new(if self.is_second_first { [ranks[1], ranks[0]] } else { ranks })
    }

    #[inline(always)]
    fn triangles(&self, [triangle1, triangle2]: [u32; 2]) -> Option<[Triangle; 2]> {
        let [mesh1, mesh2] = self.pair.meshes;
        Some([mesh1.triangle(triangle1), mesh2.triangle(triangle2)])
    }

    #[inline(always)]
    fn with_constraints(
        &self,
        [triangle1, triangle2]: [u32; 2],
        then: impl FnOnce(Constraints<'_>),
    ) {
        let [mesh1, mesh2] = self.pair.meshes;
        let [prepared1, prepared2] = &self.prepared;
        let [mut fresh1, mut fresh2] = [None, None];
        let cone1 = prepared1.normal_constraints(mesh1, triangle1, &mut fresh1);
        let cone2 = prepared2.normal_constraints(mesh2, triangle2, &mut fresh2);
        then([cone1, cone2].map(|cone| cone.map(|cone| cone as &dyn NormalConstraints)));
    }
}

struct Collector<'a, F> {
    prepared: [&'a PreparedMesh; 2],
    test: LeafTest,
    found: F,
}

impl<F: FnMut([u32; 2])> Visitor for Collector<'_, F> {
    #[inline]
    fn leaves(&mut self, _: u32, batch1: &LeafBatch, _: u32, batch2: &LeafBatch) -> Verdict {
        self.test.survivors(batch1, batch2, |lane1, lane2| {
            let [triangle1, triangle2] = [batch1.triangles()[lane1], batch2.triangles()[lane2]];
            let [prepared1, prepared2] = self.prepared;
            if !prepared1.is_broken(triangle1) && !prepared2.is_broken(triangle2) {
                (self.found)([triangle1, triangle2]);
            }
        });
        Verdict::Descend
    }
}
