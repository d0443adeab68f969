use super::build::{BuildNode, BuildTree, Content};
use super::node::{LeafBatch, Pair};
use super::{LayerPlan, Tree};
use crate::volumes::SLABS;

/// Depth, layers and memory of a tree.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuildStats {
    /// Depth of the deepest leaf; the root is at 0.
    pub depth: u32,
    /// Number of inner nodes.
    pub inner_count: u32,
    /// The volumes of each layer, as given or chosen.
    pub layers: LayerPlan,
    /// Share of the boxes met by a random query that k-DOPs cut off, in the chosen layers or from
    /// depth 4 on. `None` if a plan was given.
    pub kdop_cut: Option<f32>,
    /// Memory of the AABB layers.
    pub aabb_bytes: usize,
    /// Memory of the k-DOP layers.
    pub kdop_bytes: usize,
    /// Memory of the triangles in the leaves.
    pub leaf_bytes: usize,
}

impl BuildStats {
    /// The statistics without the layers.
    pub(super) fn of(tree: &Tree, built: &BuildTree) -> Self {
        let is_inner = |node: &&BuildNode| matches!(node.content, Content::Inner(_));
        Self {
            depth: built.nodes.iter().map(|node| node.depth).max().unwrap_or(0),
            inner_count: built.nodes.iter().filter(is_inner).count() as u32,
            aabb_bytes: tree.aabb_pairs.len() * size_of::<Pair<3>>(),
            kdop_bytes: tree.kdop_pairs.len() * size_of::<Pair<SLABS>>(),
            leaf_bytes: tree.leaves.len() * size_of::<LeafBatch>(),
            ..Self::default()
        }
    }

    /// Memory of the whole tree.
    pub fn bytes(&self) -> usize {
        self.aabb_bytes + self.kdop_bytes + self.leaf_bytes
    }
}
