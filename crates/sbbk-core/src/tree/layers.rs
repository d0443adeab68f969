use glamx::Vec3;

use super::BuildError;
use super::build::BuildNode;
use crate::volumes::{Kdop, SLABS, directions};

/// The least [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut) with which k-DOPs pay. Measured with
/// 18-DOPs.
const LEAST_CUT: f32 = 0.07;
/// What a layer above depth 4 must cut off by itself.
const LEAST_CUT_OF_LAYER: f32 = 0.05;

/// Which volume each layer of a tree has.
///
/// The paper's plan is a sphere at the root, AABBs in the inner layers and k-DOPs in the lower ones: high
/// layers are tested often but prune little more with k-DOPs than with boxes; in low layers a tighter
/// volume saves whole subtrees and triangle tests. Where surfaces are flat and along the axes it saves
/// none, as k-DOPs are not tighter than boxes there.
///
/// # The choice
///
/// The paper leaves the choice of layers for each mesh to future work (section 5). A build that is given
/// no plan makes it by a model of what a query costs. As many queries reach a node as its box is large, by
/// the surface area heuristic, and its k-DOP spares as much of them as it is narrower along its diagonal
/// slabs than the box is. k-DOPs are to begin at depth 4, or higher if each layer down to there cuts off
/// 0.05 of all boxes that a query meets by itself, as in trees of about a hundred triangles and fewer. What
/// they cut off in sum is [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut): 0 for a floor and 0.02
/// for a cuboid along the axes, 0.06 for gentle hills, 0.1 to 0.2 for what is round or turned. Above 0.07
/// the tree has them, else all its layers are boxes. The choice is a function of the mesh.
///
/// What is best for all meshes alike is not chosen: the sphere, k, the size of leaves.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct LayerPlan {
    /// Whether the root is tested as a sphere first. One distance test a pair of bodies.
    pub sphere_root: bool,
    /// The depth of the first k-DOP layer; the root is at depth 0. `None`: boxes all the way down.
    /// Lower values test more nodes with k-DOPs, at about twice the cost of boxes a node.
    pub kdop_from_depth: Option<u32>,
}

impl LayerPlan {
    /// Sphere, AABBs, k-DOPs from depth 4 on: the plan of the paper, with a boundary that is best or close
    /// to it wherever k-DOPs pay.
    pub const SBBK: Self = Self { sphere_root: true, kdop_from_depth: Some(4) };

    /// Boxes in all layers: what the paper compares with.
    pub const AABB_ONLY: Self = Self { sphere_root: false, kdop_from_depth: None };

    /// What is fitted before the choice.
    pub(super) const CANDIDATE: Self = Self { sphere_root: true, kdop_from_depth: Some(1) };

    pub(super) fn check(&self) -> Result<(), BuildError> {
        match self.kdop_from_depth {
            Some(depth @ 0) => Err(BuildError::KdopAtRoot { depth }),
            _ => Ok(()),
        }
    }

    /// Whether nodes at `depth` have k-DOPs.
    pub(super) fn is_kdop(&self, depth: u32) -> bool {
        self.kdop_from_depth.is_some_and(|from| depth >= from)
    }

    /// The choice for a tree with these `kdops` of the [`Self::CANDIDATE`], and what they cut off.
    pub(super) fn choose(nodes: &[BuildNode], kdops: &[Kdop]) -> (Self, f32) {
        let diagonals = &directions::DIRECTIONS[3..];
        let per_edge: Vec3 = diagonals.iter().map(|direction| direction.abs()).sum();
        // By depth; the last is that of all layers from there on.
        let mut cuts = [0.0; 5];
        let mut all = 0.0;
        for (node, kdop) in nodes.iter().zip(kdops) {
            let area = f64::from(node.aabb.half_area());
            all += area;
            let box_width = per_edge.dot(node.aabb.max - node.aabb.min);
            if node.depth > 0 && box_width > 0.0 {
                let width: f32 = (3..SLABS).map(|axis| kdop.max[axis] - kdop.min[axis]).sum();
                cuts[node.depth.min(4) as usize] += area * f64::from(1.0 - width / box_width);
            }
        }
        // Where boxes have no area, or an infinite one, nothing is known.
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

impl Default for LayerPlan {
    fn default() -> Self {
        Self::SBBK
    }
}
