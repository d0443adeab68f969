use super::BuildError;

/// Which volume each layer of a tree has.
///
/// The paper's plan is a sphere at the root, AABBs in the inner layers and k-DOPs in the lower
/// ones. Where the boundary is best depends on the mesh and on how deep two meshes usually meet:
/// high layers are tested often but prune little more with k-DOPs than with boxes; in low layers a
/// tighter volume saves whole subtrees and triangle tests.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct LayerPlan {
    /// Whether the root is tested as a sphere first. One distance test a pair of bodies.
    pub sphere_root: bool,
    /// The depth of the first k-DOP layer; the root is at depth 0. `None`: boxes all the way down.
    /// Lower values test more nodes with k-DOPs, at about twice the cost of boxes a node.
    pub kdop_from_depth: Option<u32>,
}

impl LayerPlan {
    /// Sphere, AABBs, k-DOPs from depth 4 on: the plan of the paper, with a boundary that was best
    /// or close to it on meshes of 1000 to 70,000 triangles.
    ///
    /// The paper leaves the choice of layers for each mesh to future work (section 5). It was measured
    /// and dropped: on pairs of ten kinds of 96 to 20,000 triangles no other plan, k or size of leaf
    /// gains more than 6 % (boxes, on a cuboid: 0.2 µs a query), and boxes lose up to a fifth
    /// elsewhere. The study `layers` of the repository prints the table.
    pub const SBBK: Self = Self { sphere_root: true, kdop_from_depth: Some(4) };

    /// Boxes in all layers: what the paper compares with.
    pub const AABB_ONLY: Self = Self { sphere_root: false, kdop_from_depth: None };

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
}

impl Default for LayerPlan {
    fn default() -> Self {
        Self::SBBK
    }
}
