use glamx::Vec3;

use super::build::{BuildTree, Content};
use super::node::{LeafBatch, Pair};
use super::{LayerPlan, Tree};
use crate::volumes::{SLABS, Sphere};

/// What a build made.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuildStats {
    /// Depth of the deepest leaf; the root is at 0.
    pub depth: u32,
    /// Number of inner nodes.
    pub inner_count: u32,
    /// Number of leaves.
    pub leaf_count: u32,
    /// Triangles whose area is exactly zero in f32. They are kept.
    pub degenerate_count: u32,
    /// Expected cost of a random query that hits the root, in node tests: the surface area
    /// heuristic's `Σ area(inner)·2 + Σ area(leaf)·count`, over the root's area. Zero if that is
    /// zero.
    pub sah_cost: f32,
    /// The volume of each layer, as asked for or chosen.
    pub layers: LayerPlan,
    /// Why they were chosen: how much of the boxes that a random query meets k-DOPs cut off, or would, from
    /// depth 4 on or those that were chosen. `None`: the layers were asked for.
    pub kdop_cut: Option<f32>,
    /// Memory of the sphere.
    pub sphere_bytes: usize,
    /// Memory of the AABB layers.
    pub aabb_bytes: usize,
    /// Memory of the k-DOP layers.
    pub kdop_bytes: usize,
    /// Memory of the triangles in the leaves.
    pub leaf_bytes: usize,
}

impl BuildStats {
    /// All but what is known of the layers.
    pub(super) fn of(
        tree: &Tree,
        built: &BuildTree,
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Self {
        let mut cost = 0.0;
        let mut depth = 0;
        for node in &built.nodes {
            depth = depth.max(node.depth);
            cost += node.aabb.half_area()
                * match &node.content {
                    Content::Inner(_) => 2.0,
                    Content::Leaf(range) => range.len() as f32,
                };
        }
        let root_area = built.nodes[0].aabb.half_area();
        let is_degenerate = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            (b - a).cross(c - a) == Vec3::ZERO
        };
        Self {
            depth,
            inner_count: (built.nodes.len() - tree.leaves.len()) as u32,
            leaf_count: tree.leaves.len() as u32,
            degenerate_count: triangles.iter().filter(is_degenerate).count() as u32,
            sah_cost: if root_area > 0.0 { cost / root_area } else { 0.0 },
            sphere_bytes: tree.sphere.map_or(0, |_| size_of::<Sphere>()),
            aabb_bytes: tree.aabb_pairs.len() * size_of::<Pair<3>>(),
            kdop_bytes: tree.kdop_pairs.len() * size_of::<Pair<SLABS>>(),
            leaf_bytes: tree.leaves.len() * size_of::<LeafBatch>(),
            ..Self::default()
        }
    }

    /// Memory of the whole tree.
    pub fn bytes(&self) -> usize {
        self.sphere_bytes + self.aabb_bytes + self.kdop_bytes + self.leaf_bytes
    }
}
