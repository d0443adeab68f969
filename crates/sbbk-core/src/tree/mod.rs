//! The bounding volume hierarchy of one mesh: a sphere at the root, AABBs below, then k-DOPs, and
//! batches of triangles in the leaves.
//!
//! A tree is built in a comfortable form (`build.rs`: binned SAH over primitives, one node after
//! the other) and packed once into the flat arrays that the descent reads (`pack.rs`). It never
//! changes. [`Tree::root`] starts a walk over its nodes.
//!
//! ```
//! use glamx::Vec3;
//! use sbbk_core::tree::{BuildOptions, Tree};
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! assert_eq!(tree.triangle_count(), 4);
//! assert_eq!(tree.validate(), Ok(()));
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod bins;
mod build;
mod layers;
mod node;
mod pack;
mod stats;
mod validate;
mod walk;

pub use build::BuildOptions;
pub use layers::LayerPlan;
pub use node::{BATCH, LeafBatch, Slot};
pub(crate) use node::{Children, Intervals, Link};
pub use stats::BuildStats;
pub use validate::Violation;
pub use walk::{Leaf, Node};

use glamx::Vec3;
use thiserror::Error;

use crate::volumes::rounding::gamma;
use crate::volumes::{SLABS, Sphere};
use node::Pair;

/// A bounding volume hierarchy of the triangles of a mesh.
#[derive(Clone, Debug)]
pub struct Tree {
    /// `None` if the plan has no sphere.
    sphere: Option<Sphere>,
    /// Children of the inner nodes of the upper layers. Entry 0 is the root's own volume in lane 0.
    aabb_pairs: Vec<Pair<3>>,
    /// Children of the inner nodes of the lower layers; their node numbers follow those above.
    kdop_pairs: Vec<Pair<SLABS>>,
    leaves: Vec<LeafBatch>,
    triangle_count: u32,
    /// The largest absolute coordinate: what rounding errors in this frame are relative to.
    magnitude: f32,
    stats: BuildStats,
}

/// Why a mesh cannot have a tree.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// There is nothing to bound.
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
        /// The vertex index it holds.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A vertex that a triangle uses is NaN or infinite.
    #[error("vertex {vertex} is not finite: ({}, {}, {})", position.x, position.y, position.z)]
    NotFinite {
        /// Index of the vertex.
        vertex: u32,
        /// Its coordinates.
        position: Vec3,
    },
    /// The layers cannot be ordered as asked.
    #[error(
        "the layer plan starts k-DOPs at depth {depth}, but the root's volume is at depth 0 and the first children at depth 1: use 1 or more"
    )]
    KdopAtRoot {
        /// The depth asked for.
        depth: u32,
    },
}

impl Tree {
    /// Builds the tree of a mesh. Degenerate triangles are kept, like any others, and counted in
    /// [`BuildStats`].
    ///
    /// # Errors
    /// Everything wrong with the input is found here, in the order counts, indices, coordinates: a
    /// [`Tree`] that exists is valid.
    pub fn build(
        vertices: &[Vec3],
        triangles: &[[u32; 3]],
        options: &BuildOptions,
    ) -> Result<Self, BuildError> {
        options.layers.as_ref().map_or(Ok(()), LayerPlan::check)?;
        check_mesh(vertices, triangles)?;
        Ok(pack::pack(build::build(vertices, triangles, options), vertices, triangles, options))
    }
}

impl Tree {
    /// Number of triangles of the mesh, degenerate ones included.
    pub fn triangle_count(&self) -> u32 {
        self.triangle_count
    }

    /// The sphere around the mesh, if the [`LayerPlan`] has one.
    pub fn sphere(&self) -> Option<&Sphere> {
        self.sphere.as_ref()
    }

    /// A ball around the mesh: the sphere of the root, or one around its box where the plan has
    /// none.
    pub fn bounding_ball(&self) -> Sphere {
        self.sphere.unwrap_or_else(|| {
            let aabb = self.children(0).aabb(0);
            let radius = 0.5 * (aabb.max - aabb.min).length() * (1.0 + gamma(8));
            Sphere { centre: aabb.centre(), radius: radius + gamma(8) * self.magnitude }
        })
    }

    /// The largest absolute coordinate of the mesh in its own frame.
    pub fn magnitude(&self) -> f32 {
        self.magnitude
    }

    /// What the build did, and what the tree costs.
    pub fn stats(&self) -> &BuildStats {
        &self.stats
    }

    /// The triangles of a leaf.
    pub fn leaf(&self, leaf: u32) -> &LeafBatch {
        &self.leaves[leaf as usize]
    }

    /// Number of leaves.
    pub fn leaf_count(&self) -> u32 {
        self.leaves.len() as u32
    }

    /// The two children of an inner node, their volumes lane by lane.
    pub(crate) fn children(&self, node: u32) -> Children<'_> {
        let node = node as usize;
        match self.aabb_pairs.get(node) {
            Some(pair) => Children::from_aabbs(pair),
            None => Children::from_kdops(&self.kdop_pairs[node - self.aabb_pairs.len()]),
        }
    }

    /// What a slot leads to.
    #[inline]
    pub(crate) fn link(&self, slot: Slot) -> Link {
        self.children(slot.node()).links[slot.lane()]
    }

    /// Number of inner nodes, the root's own entry included.
    pub(crate) fn node_count(&self) -> usize {
        self.aabb_pairs.len() + self.kdop_pairs.len()
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
