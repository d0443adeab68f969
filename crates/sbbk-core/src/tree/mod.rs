//! The bounding volume hierarchy of one mesh: a sphere at the root, AABBs below, then k-DOPs, and
//! batches of triangles in the leaves.
//!
//! `build.rs` makes a tree one node at a time by binned SAH; `pack.rs` copies it into the flat
//! arrays of the descent. Trees never change. [`Tree::root`] starts a walk over the nodes.
//!
//! ```
//! use glamx::Vec3;
//! use sbbk_core::tree::Tree;
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree = Tree::build(&vertices, &triangles, None)?;
//!
//! let mut nodes = vec![tree.root()];
//! let mut triangle_count = 0;
//! while let Some(node) = nodes.pop() {
//!     nodes.extend(node.children().into_iter().flatten());
//!     triangle_count += node.leaf().map_or(0, |leaf| leaf.count());
//! }
//! assert_eq!(triangle_count, 4);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod bins;
mod build;
mod layers;
mod node;
mod pack;

pub use layers::LayerPlan;
use node::Link;
pub use node::{BATCH, LeafBatch};
pub(crate) use node::{Children, Intervals, Slot};

use glamx::Vec3;
use thiserror::Error;

use crate::volumes::rounding::gamma;
use crate::volumes::{Aabb, Kdop, SLABS, Sphere};
use node::Pair;

/// A bounding volume hierarchy of the triangles of a mesh.
#[derive(Clone, Debug)]
pub struct Tree {
    /// `None` if the plan has no sphere.
    sphere: Option<Sphere>,
    /// Children of the inner nodes of the upper layers. Entry 0 has the root's volume in lane 0.
    aabb_pairs: Vec<Pair<3>>,
    /// Children of the inner nodes of the lower layers, numbered after the upper ones.
    kdop_pairs: Vec<Pair<SLABS>>,
    leaves: Vec<LeafBatch>,
    triangle_count: u32,
    /// The box around the mesh, without rounding.
    bounds: Aabb,
    stats: BuildStats,
}

/// Depth, layers and memory of a tree.
#[derive(Copy, Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BuildStats {
    /// Depth of the deepest leaf; the root is at 0.
    pub depth: u32,
    /// The volumes of each layer, as given or chosen.
    pub layers: LayerPlan,
    /// Share of the boxes met by a random query that k-DOPs cut off, in the chosen layers or from
    /// depth 4 on. `None` if a plan was given.
    pub kdop_cut: Option<f32>,
    /// Memory of the tree.
    pub bytes: usize,
}

/// Reason for which a mesh cannot have a tree.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The mesh has no triangles.
    #[error("the mesh has no triangles")]
    NoTriangles,
    /// Node and triangle numbers are 30 bits wide.
    #[error("the mesh has {count} triangles, more than the {} a tree can number", Link::MAX_INDEX)]
    TooManyTriangles {
        /// The mesh's triangle count.
        count: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {vertex}, but the mesh has {vertex_count} vertices"
    )]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex index.
        vertex: u32,
        /// Number of vertices of the mesh.
        vertex_count: usize,
    },
    /// A vertex that a triangle uses is NaN or infinite.
    #[error("vertex {vertex} is not finite: ({}, {}, {})", position.x, position.y, position.z)]
    NotFinite {
        /// Index of the vertex.
        vertex: u32,
        /// Coordinates of the vertex.
        position: Vec3,
    },
    /// The layer plan has k-DOPs at the root.
    #[error("the layer plan has k-DOPs at depth 0, where the root is: use 1 or more")]
    KdopAtRoot,
}

impl Tree {
    /// Builds the tree of a mesh. Degenerate triangles are kept. The model of [`LayerPlan`] chooses
    /// the layers unless they are given.
    ///
    /// # Errors
    /// The first fault of the input, in the order counts, indices, coordinates.
    pub fn build(
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
        layers: Option<LayerPlan>,
    ) -> Result<Self, BuildError> {
        if layers.is_some_and(|layers| layers.kdop_from_depth == Some(0)) {
            return Err(BuildError::KdopAtRoot);
        }
        check_mesh(vertices, triangles)?;
        Ok(pack::pack(build::build(vertices, triangles), vertices, triangles, layers))
    }

    /// The root, from which all nodes can be reached.
    pub fn root(&self) -> Node<'_> {
        Node { tree: self, slot: Slot::ROOT, depth: 0 }
    }

    /// Number of triangles of the mesh, degenerate ones included.
    pub fn triangle_count(&self) -> u32 {
        self.triangle_count
    }

    /// The sphere around the mesh, if the [`LayerPlan`] has one.
    pub fn sphere(&self) -> Option<&Sphere> {
        self.sphere.as_ref()
    }

    /// A ball around the mesh: the sphere of the root, or else one around its box.
    pub fn bounding_ball(&self) -> Sphere {
        self.sphere.unwrap_or_else(|| {
            let Aabb { min, max } = self.bounds;
            let radius = 0.5 * (max - min).length() * (1.0 + gamma(8));
            Sphere { centre: self.bounds.centre(), radius: radius + gamma(8) * self.magnitude() }
        })
    }

    /// The largest absolute coordinate of the mesh in its own frame, to which rounding errors are
    /// proportional.
    pub fn magnitude(&self) -> f32 {
        self.bounds.magnitude()
    }

    /// The box around the mesh, without rounding.
    pub(crate) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Depth, layers and memory of the tree.
    pub fn stats(&self) -> &BuildStats {
        &self.stats
    }

    /// The triangles of a leaf.
    pub(crate) fn leaf(&self, leaf: u32) -> &LeafBatch {
        &self.leaves[leaf as usize]
    }

    /// The volumes of the two children of an inner node, lane by lane.
    pub(crate) fn children(&self, node: u32) -> Children<'_> {
        let node = node as usize;
        match self.aabb_pairs.get(node) {
            Some(pair) => Children::from_aabbs(pair),
            None => Children::from_kdops(&self.kdop_pairs[node - self.aabb_pairs.len()]),
        }
    }

    /// Half the longest side of the box of a node.
    #[inline(always)]
    pub(crate) fn length(&self, slot: Slot) -> f32 {
        let extent = self.children(slot.node()).boxes.extent;
        let [x, y, z] = extent.map(|lanes| f32::from(lanes[slot.lane()]));
        x.max(y).max(z)
    }

    /// The inner node or leaf at a slot.
    #[inline]
    pub(crate) fn link(&self, slot: Slot) -> Link {
        self.children(slot.node()).links[slot.lane()]
    }
}

/// A node of a tree: see [`Tree::root`].
#[derive(Copy, Clone, Debug)]
pub struct Node<'a> {
    tree: &'a Tree,
    slot: Slot,
    depth: u32,
}

impl<'a> Node<'a> {
    /// Steps from the root.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// The box of the node, in the frame of the mesh.
    pub fn aabb(&self) -> Aabb {
        self.tree.children(self.slot.node()).aabb(self.slot.lane())
    }

    /// The k-DOP of the node, in the layers that have one.
    pub fn kdop(&self) -> Option<Kdop> {
        self.tree.children(self.slot.node()).kdop(self.slot.lane())
    }

    /// The two nodes below; `None` for a leaf.
    pub fn children(&self) -> Option<[Self; 2]> {
        let link = self.link();
        let child = |lane| Self {
            tree: self.tree,
            slot: Slot::new(link.index(), lane),
            depth: self.depth + 1,
        };
        (!link.is_leaf()).then(|| [child(0), child(1)])
    }

    /// The triangles of a leaf; `None` for an inner node.
    pub fn leaf(&self) -> Option<&'a LeafBatch> {
        let link = self.link();
        link.is_leaf().then(|| self.tree.leaf(link.index()))
    }

    fn link(&self) -> Link {
        self.tree.link(self.slot)
    }
}

fn check_mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), BuildError> {
    if triangles.is_empty() {
        return Err(BuildError::NoTriangles);
    }
    if triangles.len() > Link::MAX_INDEX as usize {
        return Err(BuildError::TooManyTriangles { count: triangles.len() });
    }
    for (triangle, indices) in triangles.iter().enumerate() {
        for &vertex in indices {
            let Some(&position) = vertices.get(vertex as usize) else {
                return Err(BuildError::IndexOutOfRange {
                    triangle,
                    vertex,
                    vertex_count: vertices.len(),
                });
            };
            if !position.is_finite() {
                return Err(BuildError::NotFinite { vertex, position });
            }
        }
    }
    Ok(())
}
