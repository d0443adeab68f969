use glamx::Vec3;
use parry3d::shape::{HeightField, Triangle};
use sbbk_core::field::{FieldTriangle, HeightGrid};
use xxhash_rust::xxh3::xxh3_64;

/// Parry's height field as the descent sees it. What Parry calls rows lies along z, columns along
/// x.
#[derive(Copy, Clone)]
pub(super) struct Field<'a>(pub(super) &'a HeightField);

impl Field<'_> {
    /// Parry's number of a triangle: left ones first, along z, then x.
    pub(super) fn id(self, FieldTriangle { cell: [column, row], side }: FieldTriangle) -> u32 {
        let cell = column * self.0.nrows() + row;
        (cell + side * self.cell_count()) as u32
    }

    /// The reverse of [`id`](Self::id) as far as its order goes: the cells along z, then x, the
    /// left triangle first.
    pub(super) fn rank(self, id: u32) -> u32 {
        let count = self.cell_count();
        let (cell, side) = (id as usize % count, id as usize / count);
        (2 * cell + side) as u32
    }

    /// The triangle of a number, if it is there and no corner is NaN or infinite.
    pub(super) fn triangle(self, id: u32) -> Option<Triangle> {
        let triangle = self.0.triangle_at_id(id)?;
        triangle.vertices().iter().all(|corner| corner.is_finite()).then_some(triangle)
    }

    fn cell_count(self) -> usize {
        self.0.nrows() * self.0.ncols()
    }
}

impl HeightGrid for Field<'_> {
    fn cell_counts(&self) -> [usize; 2] {
        [self.0.ncols(), self.0.nrows()]
    }

    fn scale(&self) -> Vec3 {
        self.0.scale()
    }

    #[inline]
    fn heights(&self, column: usize) -> &[f32] {
        let heights = self.0.heights();
        let start = heights.flat_index(0, column);
        &heights.data()[start..start + heights.nrows()]
    }

    #[inline]
    fn triangles(&self, [column, row]: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
        let (left, right) = self.0.triangles_at(row, column);
        [left, right].map(|triangle| triangle.map(|Triangle { a, b, c }| [a, b, c]))
    }
}

/// Tells in constant time that a field is most likely still the one it was: addresses, sizes,
/// scale, flags, and some heights. Heights cannot be edited in place.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct FieldToken(u64);

impl FieldToken {
    /// Heights looked at, evenly spread.
    const SAMPLES: usize = 8;

    pub(super) fn of(field: &HeightField) -> Self {
        let (heights, statuses) = (field.heights().data(), field.cells_statuses().data());
        let mut words = [0u64; 6 + Self::SAMPLES];
        let bits = |x: f32| u64::from(x.to_bits());
        let scale = field.scale();
        words[0] = heights.as_ptr() as u64;
        words[1] = statuses.as_ptr() as u64;
        words[2] = field.nrows() as u64 | (field.ncols() as u64) << 32;
        words[3] = bits(scale.x) | bits(scale.y) << 32;
        words[4] = bits(scale.z) | u64::from(field.flags().bits()) << 32;
        words[5] = bits(field.root_aabb().mins.y) | bits(field.root_aabb().maxs.y) << 32;
        for (i, word) in words[6..].iter_mut().enumerate() {
            *word = bits(heights[i * heights.len() / Self::SAMPLES]);
        }
        Self(xxh3_64(bytemuck::cast_slice(&words)))
    }
}
