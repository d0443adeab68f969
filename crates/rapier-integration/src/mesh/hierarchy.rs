//! Parry's own hierarchy of a mesh, as a tree to descend.
//!
//! It is there before the first query, always that of the mesh as it is now, and in the order of
//! stock's manifolds. So a pair needs nothing else where triangles meet something simple, or where
//! a tree of our own would take longer to build than stock takes to do without.

use std::cell::Cell;
use std::ops::ControlFlow;

use glamx::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::shape::{CompositeShape, TriMesh, Triangle};
use rustc_hash::FxHashMap;
use sbbk_core::traverse::{BoxTest, Counters, TestedBox};
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::identity::MeshToken;
use super::soundness::is_whole;

/// The places of some triangles of a mesh in stock order.
#[derive(Debug, Default)]
pub(crate) struct Ranks(FxHashMap<u32, u32>);

impl Ranks {
    /// That of a triangle. One that was not given any sorts last.
    #[inline(always)]
    pub(crate) fn of(&self, triangle: u32) -> u32 {
        self.0.get(&triangle).copied().unwrap_or(u32::MAX)
    }
}

/// The hierarchy of a mesh during one query.
#[derive(Copy, Clone)]
pub(crate) struct Hierarchy<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(super) token: MeshToken,
    /// The cache of the dispatcher that asks.
    pub(super) owner: u64,
    /// Some vertices are NaN or infinite: boxes above them mean nothing, and triangles that have
    /// them touch nothing.
    pub(super) is_broken: bool,
}

impl<'a> Hierarchy<'a> {
    pub(crate) fn token(&self) -> MeshToken {
        self.token
    }

    /// Whether the mesh stays as it is as long as its token does.
    pub(crate) fn is_rigid(&self) -> bool {
        !self.mesh.is_deformable()
    }

    /// The box around the mesh: of a broken one around its whole triangles.
    pub(crate) fn root(&self) -> Aabb {
        if self.is_broken {
            around(self.whole_ones().map(|index| self.mesh.triangle(index).local_aabb()))
        } else {
            self.mesh.bvh().root_aabb()
        }
    }

    /// The root box in the frame that the mesh is in at `pose`, grown by `reach` and by what
    /// rounding takes from it. Without a finite pose the mesh is nowhere: a box that meets none.
    pub(crate) fn placed_root(&self, pose: &Pose, reach: Real) -> Aabb {
        let root = self.root();
        let size = root.half_extents().length() + root.center().length();
        let grown = reach + gamma(64) * (size + pose.translation.length() + reach);
        let is_somewhere = grown >= 0.0;
        if is_somewhere { root.transform_by(pose).loosened(grown) } else { Aabb::new_invalid() }
    }

    /// The largest absolute coordinate.
    pub(crate) fn magnitude(&self) -> Real {
        let root = self.root();
        root.mins.abs().max(root.maxs.abs()).max_element()
    }

    /// A ball around the mesh.
    pub(crate) fn ball(&self) -> Sphere {
        let root = self.root();
        let (centre, half) = (root.center(), root.half_extents().length());
        Sphere { centre, radius: half + gamma(8) * (centre.length() + half) }
    }

    /// Calls `found` with the triangles whose boxes, and those above them, meet what `meets` tells
    /// of, in stock order.
    pub(crate) fn near(
        &self,
        mut counters: impl Counters,
        meets: impl Fn(TestedBox) -> bool,
        found: impl FnMut(u32),
    ) {
        let tested = Cell::new(0);
        let meets = |aabb: TestedBox| {
            tested.set(tested.get() + 1);
            meets(aabb)
        };
        if self.is_broken {
            self.whole_ones().filter(|&i| meets(self.tested(i))).for_each(found);
        } else {
            self.mesh.bvh().leaves(|node| meets(box_of(node))).for_each(found);
        }
        counters.aabb_tests(tested.get());
    }

    /// Calls `found` with all pairs of triangles whose boxes, and those above them, `test` does not
    /// tell apart, in any order,
    /// until it has enough.
    pub(crate) fn pairs(
        [one, two]: [&Self; 2],
        test: &BoxTest,
        mut counters: impl Counters,
        mut found: impl FnMut([u32; 2]) -> ControlFlow<()>,
    ) {
        let tested = Cell::new(0);
        let meet = |one: TestedBox, two: TestedBox| {
            tested.set(tested.get() + 1);
            test.of(two).meets(one)
        };
        let _ = if one.is_broken || two.is_broken {
            let all = one.whole_ones().flat_map(|i| two.whole_ones().map(move |j| [i, j]));
            let mut near = all.filter(|&[i, j]| meet(one.tested(i), two.tested(j)));
            near.try_for_each(found)
        } else {
            let meet = |node1: &BvhNode, node2: &BvhNode| meet(box_of(node1), box_of(node2));
            let mut pairs = one.mesh.bvh().leaf_pairs(two.mesh.bvh(), meet);
            pairs.try_for_each(|(triangle1, triangle2)| found([triangle1, triangle2]))
        };
        counters.aabb_tests(tested.get());
    }

    /// Gives triangles their places in stock order. Looks at all triangles near them.
    pub(crate) fn rank(&self, triangles: impl Iterator<Item = u32>, ranks: &mut Ranks) {
        let ranks = &mut ranks.0;
        ranks.clear();
        ranks.extend(triangles.map(|index| (index, u32::MAX)));
        if ranks.len() < 2 || self.is_broken {
            // Of a broken mesh in the order of its triangles.
            return ranks.iter_mut().for_each(|(index, rank)| *rank = *index);
        }
        let all = around(ranks.keys().map(|&index| self.mesh.triangle(index).local_aabb()));
        let all = BvhNode::leaf(all, 0);
        for (rank, index) in self.mesh.bvh().leaves(|node| node.intersects(&all)).enumerate() {
            if let Some(place) = ranks.get_mut(&index) {
                *place = rank as u32;
            }
        }
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        let Triangle { a, b, c } = self.mesh.triangle(triangle);
        [a, b, c]
    }

    fn whole_ones(&self) -> impl Iterator<Item = u32> {
        let triangles = self.mesh.indices().iter().zip(0..);
        let whole = triangles.filter(|(triangle, _)| is_whole(self.mesh, triangle));
        whole.map(|(_, index)| index)
    }

    fn tested(&self, triangle: u32) -> TestedBox {
        let aabb = self.mesh.triangle(triangle).local_aabb();
        TestedBox::new(aabb.mins, aabb.maxs)
    }
}

fn around(boxes: impl Iterator<Item = Aabb>) -> Aabb {
    boxes.fold(Aabb::new_invalid(), |all, one| all.merged(&one))
}

#[inline(always)]
pub(crate) fn box_of(node: &BvhNode) -> TestedBox {
    TestedBox::new(node.mins(), node.maxs())
}
