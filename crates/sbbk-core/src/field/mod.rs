//! The triangles of a height field that may touch a mesh.
//!
//! A height field is a tree already: the cells under a box of its frame follow from two divisions.
//! So only a hierarchy of the mesh is walked, any one. The box of each node, turned into the frame
//! of the field, gives a range of cells; if all their corners are above the box, or all below,
//! nothing under the node can touch ([`FieldFrame::meets`]). Of the triangles that the walk comes to
//! ([`FieldLeaves`]) each cell is compared by the same rule, and what is left triangle against
//! triangle, by separating axes over lanes.
//!
//! So the cells looked at lie under the boxes of the mesh, and a field of a million cells costs
//! what one of a thousand does. Nothing is computed from the field in advance, so nothing can be
//! out of date when it is edited.
//!
//! A pyramid of least and greatest heights over blocks of cells is the usual way to test large
//! ranges. It is left out: mostly the first line of heights shows that a range cannot be ruled out,
//! only ranges that can be are read in full, and ranges above a limit are not read at all.
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
//!             leaves.visit(leaf.batch, (), |cell, index| near.push((cell, index)));
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
