use glamx::Vec3;

/// Heights over a regular grid, with two triangles a cell.
///
/// Grid line `c` of `n` along x is at `(c/n - 1/2)·scale.x`, and z has lines of the same form. The
/// corner there is at its height times `scale.y`. The corners of [`triangles`](Self::triangles) may
/// be off by a few roundings of f32, see [`FieldFrame`](super::FieldFrame).
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
