use glamx::Vec3;

use crate::volumes::{Aabb, Kdop, SLABS, directions};

/// Least [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut) of a tree with k-DOPs. Higher: boxes
/// for more meshes; lower: k-DOPs for more meshes.
const LEAST_CUT: f32 = 0.07;
/// Least share of the boxes that a layer above depth 4 cuts off to have k-DOPs. Higher: fewer
/// layers with k-DOPs; lower: more.
const LEAST_CUT_OF_LAYER: f32 = 0.05;

/// The kind of volume of each layer of a tree.
///
/// The paper's plan is a sphere at the root, AABBs in the upper layers and k-DOPs in the lower
/// ones. Upper layers are tested often, and k-DOPs prune little more there than boxes. In lower
/// layers a tighter volume saves whole subtrees and triangle tests. k-DOPs save nothing on flat
/// surfaces along the axes.
///
/// # The choice
///
/// A build without a plan chooses one for the mesh by a cost model, the paper's future work
/// (section 5). By the surface area heuristic, the number of queries that reach a node is
/// proportional to the area of its box. The k-DOP rejects as many of them as it is narrower than
/// the box along its diagonal slabs.
///
/// k-DOPs begin at depth 4, or higher if each layer between cuts off 0.05 of all boxes. The sum of
/// their cuts is [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut): 0.02 for a cuboid along the
/// axes, 0.06 for gentle hills, 0.1 to 0.2 for round or turned meshes. Trees with a sum below 0.07
/// have boxes in all layers.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct LayerPlan {
    /// True for a sphere at the root: one distance test a pair of bodies.
    pub sphere_root: bool,
    /// The depth of the first k-DOP layer; the root is at depth 0. `None`: boxes in all layers.
    /// Lower: more nodes are tested by k-DOPs, at about twice the cost.
    pub kdop_from_depth: Option<u32>,
}

impl LayerPlan {
    /// The plan of the paper: sphere, AABBs, k-DOPs from depth 4 on.
    pub const SBBK: Self = Self { sphere_root: true, kdop_from_depth: Some(4) };

    /// Boxes in all layers, for the paper's comparison.
    pub const AABB_ONLY: Self = Self { sphere_root: false, kdop_from_depth: None };

    /// The plan fitted before the choice.
    pub(super) const CANDIDATE: Self = Self { sphere_root: true, kdop_from_depth: Some(1) };

    /// Returns true if nodes at `depth` have k-DOPs.
    pub(super) fn is_kdop(&self, depth: u32) -> bool {
        self.kdop_from_depth.is_some_and(|from| depth >= from)
    }

    /// Chooses a plan from the depths, boxes and [`Self::CANDIDATE`] k-DOPs of the nodes. Also
    /// returns the cut of the k-DOPs.
    pub(super) fn choose<'a>(nodes: impl Iterator<Item = (u32, Aabb, &'a Kdop)>) -> (Self, f32) {
        let diagonals = &directions::DIRECTIONS[3..];
        let per_edge: Vec3 = diagonals.iter().map(|direction| direction.abs()).sum();
        // Cuts by depth; the last one sums all deeper layers.
        let mut cuts = [0.0; 5];
        let mut all = 0.0;
        for (depth, aabb, kdop) in nodes {
            let area = f64::from(aabb.half_area());
            all += area;
            let box_width = per_edge.dot(aabb.max - aabb.min);
            if depth > 0 && box_width > 0.0 {
                let width: f32 = (3..SLABS).map(|axis| kdop.max[axis] - kdop.min[axis]).sum();
                cuts[depth.min(4) as usize] += area * f64::from(1.0 - width / box_width);
            }
        }
        // The share is not finite if boxes have no area or an infinite one.
        let shares = cuts.map(|cut| if (cut / all).is_finite() { (cut / all) as f32 } else { 0.0 });
        let (mut from, mut kdop_cut) = (4, shares[4]);
        while from > 1 && shares[from - 1] > LEAST_CUT_OF_LAYER {
            from -= 1;
            kdop_cut += shares[from];
        }
        let kdop_from_depth = (kdop_cut > LEAST_CUT).then_some(from as u32);
        (Self { kdop_from_depth, ..Self::CANDIDATE }, kdop_cut)
    }
}
