//! Which triangles lie below each node of a tree.

use std::collections::HashMap;

use glamx::{Pose3, Vec3};
use sbbk_core::traverse::{
    Descent, DescentScratch, NodePair, PairFrame, Verdict, Visitor, descend,
};
use sbbk_core::tree::{BuildOptions, LayerPlan, LeafBatch, Slot, Tree};
use sbbk_core::volumes::{Aabb, Kdop18};

/// A node: its volume, in the frame of its mesh, and the triangles below it.
#[derive(Clone, Debug)]
pub(super) struct Region {
    aabb: Aabb,
    /// In the k-DOP layers.
    kdop: Option<Kdop18>,
    pub triangles: Vec<u32>,
}

impl Region {
    /// Whether a point is within the node's volume.
    pub fn contains(&self, point: Vec3) -> bool {
        self.aabb.contains(point) && self.kdop.is_none_or(|kdop| kdop.contains(point))
    }
}

/// All nodes of a tree.
pub(super) struct Outline {
    /// By slot.
    pub inner: HashMap<Slot, Region>,
    /// By leaf number.
    pub leaves: HashMap<u32, Region>,
}

/// A node as a descent meets it.
enum Visit {
    Inner(Slot),
    Leaf { leaf: u32, triangles: Vec<u32>, corners: Vec<Vec3> },
}

/// Lists all nodes in the order of the descent.
#[derive(Default)]
struct Listing(Vec<Visit>);

impl Visitor for Listing {
    fn nodes(&mut self, pair: NodePair) -> Verdict {
        self.0.push(Visit::Inner(pair.slot1));
        Verdict::Descend
    }

    fn leaves(&mut self, leaf: u32, batch: &LeafBatch, _: u32, _: &LeafBatch) -> Verdict {
        self.0.push(Visit::Leaf {
            leaf,
            triangles: batch.triangles().to_vec(),
            corners: (0..batch.count()).flat_map(|lane| batch.corners(lane)).collect(),
        });
        Verdict::Descend
    }
}

impl Outline {
    /// The outline of `tree`, which was built with the layers `plan`.
    ///
    /// A descent against a single triangle, with a margin that everything meets, visits each node
    /// once, parents first. As inner nodes have two children, that order alone tells what is
    /// below what.
    pub fn new(tree: &Tree, plan: LayerPlan) -> Self {
        let mut outline = Self { inner: HashMap::new(), leaves: HashMap::new() };
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let Ok(point) = Tree::build(&corners, &[[0, 1, 2]], &BuildOptions::default()) else {
            return outline;
        };
        let mut frame = PairFrame::new(tree, &point, &Pose3::IDENTITY, f32::MAX.sqrt());
        let mut listing = Listing::default();
        let scratch = &mut DescentScratch::default();
        descend((tree, &point), &mut frame, Descent::Simultaneous, scratch, (), &mut listing);
        outline.add(&mut listing.0.into_iter(), 0, plan);
        outline
    }

    /// The box around the whole mesh.
    pub fn root_box(&self) -> Aabb {
        let bounds = self.inner.values().chain(self.leaves.values()).map(|region| region.aabb);
        bounds.fold(Aabb::EMPTY, |whole, aabb| whole.merge(&aabb))
    }

    /// Adds the next node and all below it; returns its triangles and their corners.
    fn add(
        &mut self,
        visits: &mut impl Iterator<Item = Visit>,
        depth: u32,
        plan: LayerPlan,
    ) -> (Vec<u32>, Vec<Vec3>) {
        let (triangles, corners, slot_or_leaf) = match visits.next() {
            None => return Default::default(),
            Some(Visit::Leaf { leaf, triangles, corners }) => (triangles, corners, Err(leaf)),
            Some(Visit::Inner(slot)) => {
                let children = [(); 2].map(|()| self.add(visits, depth + 1, plan));
                let (triangles, corners): (Vec<_>, Vec<_>) = children.into_iter().unzip();
                (triangles.concat(), corners.concat(), Ok(slot))
            }
        };
        let is_kdop = plan.kdop_from_depth.is_some_and(|from| depth >= from);
        let region = Region {
            aabb: Aabb::fit(&corners),
            kdop: is_kdop.then(|| Kdop18::fit(&corners)),
            triangles: triangles.clone(),
        };
        match slot_or_leaf {
            Ok(slot) => self.inner.insert(slot, region),
            Err(leaf) => self.leaves.insert(leaf, region),
        };
        (triangles, corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;

    /// Would catch children attributed to the wrong parent: each inner node's triangles must be
    /// inside its volume, the root must have all of them, and leaves must partition them.
    #[test]
    fn the_root_holds_everything_and_the_leaves_partition_it() {
        let mesh = mesh::torus(1.0, 0.3, 24, 12);
        let plan = LayerPlan::SBBK;
        let options = BuildOptions { layers: plan, ..BuildOptions::default() };
        let tree: Tree = Tree::build(&mesh.vertices, &mesh.triangles, &options).unwrap();
        let outline = Outline::new(&tree, plan);
        assert_eq!(outline.inner.len() as u32, tree.stats().inner_count);
        assert_eq!(outline.leaves.len() as u32, tree.leaf_count());
        assert_eq!(outline.inner[&Slot::ROOT].triangles.len(), mesh.triangle_count());
        let mut seen: Vec<u32> =
            outline.leaves.values().flat_map(|r| r.triangles.clone()).collect();
        seen.sort_unstable();
        assert!(seen.into_iter().eq(0..mesh.triangle_count() as u32));
        for region in outline.inner.values().chain(outline.leaves.values()) {
            let corners = region.triangles.iter().flat_map(|&t| mesh.corners(t as usize));
            assert!(corners.into_iter().all(|corner| region.contains(corner)));
        }
    }
}
