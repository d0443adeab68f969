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
//! use sbbk_core::tree::Tree;
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
//! let tree = Tree::build(&vertices, &triangles, None)?;
//! let placement = Placement::new(&Pose3::translation(7.1, 0.01, -3.9));
//! let frame = FieldFrame::new(&field, &placement, 0.02);
//! let leaves = FieldLeaves::new(&frame, tree.bounding_ball().centre, tree.magnitude());
//! let mut near = Vec::new();
//! let mut nodes = vec![tree.root()];
//! while let Some(node) = nodes.pop() {
//!     let aabb = node.aabb();
//!     if frame.meets(TestedBox::new(aabb.min, aabb.max)) {
//!         nodes.extend(node.children().into_iter().flatten());
//!         if let Some(leaf) = node.leaf() {
//!             leaves.visit(leaf, |cell, index| near.push((cell, index)));
//!         }
//!     }
//! }
//! assert!(near.iter().all(|(triangle, _)| triangle.cell == [57, 46]));
//! assert!(near.len() >= 4);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod frame;
mod leaves;

pub use frame::FieldFrame;
pub use leaves::FieldLeaves;

use glamx::Vec3;

/// Heights over a regular grid, with two triangles a cell.
///
/// Grid line `c` of `n` along x is at `(c/n - 1/2)·scale.x`, and z has lines of the same form. The
/// corner there is at its height times `scale.y`. The corners of [`triangles`](Self::triangles) may
/// be off by a few roundings of f32, see [`FieldFrame`].
pub trait HeightGrid {
    /// Cells along x (columns) and z (rows).
    fn cell_counts(&self) -> [usize; 2];

    /// The size of the whole grid along x and z, and the factor of the heights.
    fn scale(&self) -> Vec3;

    /// The heights along grid line `column` of x, one more than there are rows.
    fn heights(&self, column: usize) -> &[f32];

    /// The triangles of a cell `[column, row]`; `None` where the surface has a hole. One with a
    /// corner that is NaN or infinite is not found.
    fn triangles(&self, cell: [usize; 2]) -> [Option<[Vec3; 3]>; 2];
}

/// A triangle of a height field.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FieldTriangle {
    /// Column and row of the cell.
    pub cell: [usize; 2],
    /// Index in the result of [`HeightGrid::triangles`].
    pub side: usize,
}
