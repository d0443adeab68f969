use glamx::Vec3;

use super::BuildError;
use super::build::BuildNode;
use crate::volumes::{DirectionSet, Directions, Kdop};

/// The least [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut) with which k-DOPs pay. Of 45 meshes,
/// with 18-DOPs: below it boxes in all layers are as fast or up to 8 % faster, above it k-DOPs are up to
/// 24 % faster, and nowhere more than 3 % slower.
const LEAST_CUT: f32 = 0.07;

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
/// no plan makes it by a model of what a query costs. Those that reach a node are as many as its box is
/// large, by the surface area heuristic. Its k-DOP spares them as much as it is narrower along its diagonal
/// slabs than its box is. The sum over the layers from depth 4 on, as a share of all boxes that a query
/// meets, is [`BuildStats::kdop_cut`](super::BuildStats::kdop_cut): 0 for a floor, 0.02 for a cuboid along
/// the axes, 0.06 for gentle hills, 0.14 to 0.2 for what is round. Above 0.055 the tree has
/// [`SBBK`](Self::SBBK)'s layers, else a sphere and boxes. The choice depends on nothing but the mesh.
///
/// What is best for all meshes is not chosen: `docs/measurements.md` of the repository has the figures.
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

    /// The plan for a mesh of which [`Self::SBBK`] cuts off so much.
    pub(super) fn chosen(kdop_cut: f32) -> Self {
        if kdop_cut > LEAST_CUT { Self::SBBK } else { Self { kdop_from_depth: None, ..Self::SBBK } }
    }

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

    /// How much of the boxes that a query meets the `kdops` of this plan cut off.
    pub(super) fn kdop_cut<const AXES: usize>(
        &self,
        nodes: &[BuildNode],
        kdops: &[Kdop<AXES>],
    ) -> f32
    where
        Directions<AXES>: DirectionSet<AXES>,
    {
        let diagonals = &Directions::<AXES>::DIRECTIONS[3..];
        let per_edge: Vec3 = diagonals.iter().map(|direction| direction.abs()).sum();
        let (mut cut, mut all) = (0.0, 0.0);
        for (node, kdop) in nodes.iter().zip(kdops) {
            let area = f64::from(node.aabb.half_area());
            all += area;
            let box_width = per_edge.dot(node.aabb.max - node.aabb.min);
            if self.is_kdop(node.depth) && box_width > 0.0 {
                let width: f32 = (3..AXES).map(|axis| kdop.max[axis] - kdop.min[axis]).sum();
                cut += area * f64::from(1.0 - width / box_width);
            }
        }
        let share = cut / all;
        if share.is_finite() { share as f32 } else { 0.0 }
    }
}

impl Default for LayerPlan {
    fn default() -> Self {
        Self::SBBK
    }
}
