//! The triangles of a height field that may touch a mesh.
//!
//! Two divisions give the cells under a box, so the field needs no tree; the caller descends any
//! hierarchy of the mesh. [`FieldFrame::meets`] turns the box of a node into the frame of the
//! field. If all corners of the cells under it are above the box, or all below, nothing under the
//! node can touch. [`FieldLeaves`] compares the cells under a leaf batch by the same rule, then
//! their triangles by separating axes, in SIMD lanes.
//!
//! A million cells cost as much as a thousand, as only cells under the mesh are read. No data is
//! derived from the field, so edits need no update.
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::field::{FieldFrame, FieldLeaves, HeightGrid};
//! use sbbk_core::traverse::{Placement, TestedBox};
//! use sbbk_core::tree::{BuildOptions, Tree};
//!
//! /// A plane of 100 by 100 cells of one unit.
//! struct Plane([f32; 101]);
//!
//! impl HeightGrid for Plane {
//!     fn cell_counts(&self) -> [usize; 2] {
//!         [100, 100]
//!     }
//!     fn scale(&self) -> Vec3 {
//!         Vec3::new(100.0, 1.0, 100.0)
//!     }
//!     fn heights(&self, _column: usize) -> &[f32] {
//!         &self.0
//!     }
//!     fn triangles(&self, [column, row]: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
//!         let at = |i, j| Vec3::new((column + i) as f32 - 50.0, 0.0, (row + j) as f32 - 50.0);
//!         [Some([at(0, 0), at(0, 1), at(1, 0)]), Some([at(0, 1), at(1, 1), at(1, 0)])]
//!     }
//! }
//!
//! let field = Plane([0.0; 101]);
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|x| 0.2 * x);
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! let placement = Placement::new(&Pose3::translation(7.1, 0.01, -3.9));
//! let frame = FieldFrame::new(&field, &placement, 0.02);
//! let leaves = FieldLeaves::new(&frame, tree.bounding_ball().centre, tree.magnitude());
//! let mut near = Vec::new();
//! let mut nodes = vec![tree.root()];
//! while let Some(node) = nodes.pop() {
//!     let aabb = node.aabb();
//!     if frame.meets(TestedBox::new(aabb.min, aabb.max), ()) {
//!         nodes.extend(node.children().into_iter().flatten());
//!         if let Some(leaf) = node.leaf() {
//!             leaves.visit(leaf, (), |cell, index| near.push((cell, index)));
//!         }
//!     }
//! }
//! assert!(near.iter().all(|(triangle, _)| triangle.cell == [57, 46]));
//! assert!(near.len() >= 4);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod frame;
mod grid;
mod leaves;

pub use frame::FieldFrame;
pub use grid::{FieldTriangle, HeightGrid};
pub use leaves::FieldLeaves;
