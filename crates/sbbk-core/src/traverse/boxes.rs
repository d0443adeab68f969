//! Boxes one pair at a time, for hierarchies that are not ours: over the axes in place of pairs.
//!
//! # Rounding
//!
//! As that of the boxes of [`PairFrame`](super::PairFrame), with `c = 1/2·(min + max)` and `e = 1/2·(max - min)` in
//! place of a stored centre and half-length: a centre is off by `u·M`, and a half-length too short
//! by as much. In frame 1 that adds `2·u·(M1 + 2·s·M2)` to what a comparison loses, in frame 2
//! likewise: far below `r`. Twice `r` is allowed.

use glamx::{DMat3, Vec3};
use wide::f32x4;

use super::frame::Allowance;
use super::placement::Placement;
use crate::volumes::rounding::gamma;

/// Whether boxes of two bodies come within a margin. Made once a query.
#[derive(Copy, Clone, Debug)]
pub struct BoxTest {
    to_frame1: Columns,
    to_frame2: Columns,
    translation: f32x4,
    slack: [f32x4; 2],
}

/// A matrix, a column in each entry.
#[derive(Copy, Clone, Debug)]
struct Columns {
    columns: [f32x4; 3],
    absolute: [f32x4; 3],
}

/// The middle and the half-lengths of a box along the axes of its frame.
#[derive(Copy, Clone, Debug)]
pub struct TestedBox {
    centre: Vec3,
    extent: Vec3,
}

impl TestedBox {
    /// The box between two corners.
    #[inline(always)]
    pub fn new(min: Vec3, max: Vec3) -> Self {
        Self { centre: 0.5 * (min + max), extent: 0.5 * (max - min) }
    }

    /// Its middle and half-lengths, as rounded.
    pub fn centre_extent(&self) -> (Vec3, Vec3) {
        (self.centre, self.extent)
    }
}

impl BoxTest {
    /// For two bodies with coordinates up to `magnitudes`, body 2 at `placement` in the frame of body
    /// 1.
    pub fn new(magnitudes: [f32; 2], placement: &Placement, margin: f32) -> Self {
        let Allowance { rounding, slack } = Allowance::new(magnitudes, placement, margin);
        Self {
            to_frame1: Columns::new(placement.rotation),
            to_frame2: Columns::new(placement.inverse),
            translation: lanes(placement.translation.as_vec3()),
            slack: std::array::from_fn(|i| f32x4::splat(slack[i] + rounding[i])),
        }
    }

    /// The test of a box of body 2 against boxes of body 1.
    #[inline(always)]
    pub fn of(&self, two: TestedBox) -> NearBox<'_> {
        NearBox {
            test: self,
            centre: self.translation + self.to_frame1.turn(two.centre),
            reach: self.to_frame1.turn_extent(two.extent) + self.slack[0],
            own_reach: lanes(two.extent) + self.slack[1],
        }
    }
}

/// A box of body 2, as boxes of body 1 are compared with it.
#[derive(Copy, Clone, Debug)]
pub struct NearBox<'a> {
    test: &'a BoxTest,
    /// In frame 1, along its axes.
    centre: f32x4,
    reach: f32x4,
    /// Along the axes of frame 2.
    own_reach: f32x4,
}

impl NearBox<'_> {
    /// At least by how much the axes of frame 1 separate the boxes beyond the margin, in units of
    /// frame 1; zero where they do not.
    pub fn gap(&self, one: TestedBox) -> f32 {
        let offset = self.centre - lanes(one.centre);
        let gaps = offset.abs() - (lanes(one.extent) + self.reach);
        let [x, y, z, _] = gaps.fast_max(f32x4::ZERO).to_array();
        // The squares and their sum round six times.
        Vec3::new(x, y, z).length() * (1.0 - gamma(8))
    }

    /// Whether no face axis of the two boxes separates them by more than the margin. `false` where
    /// anything is NaN.
    #[inline(always)]
    pub fn meets(&self, one: TestedBox) -> bool {
        let offset = self.centre - lanes(one.centre);
        if !offset.abs().simd_le(lanes(one.extent) + self.reach).all() {
            return false;
        }
        let to_frame2 = &self.test.to_frame2;
        let [x, y, z, _] = offset.to_array();
        let offset = to_frame2.turn(Vec3::new(x, y, z));
        offset.abs().simd_le(self.own_reach + to_frame2.turn_extent(one.extent)).all()
    }
}

impl Columns {
    fn new(matrix: DMat3) -> Self {
        let matrix = matrix.as_mat3();
        let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(lanes);
        Self { columns, absolute: columns.map(f32x4::abs) }
    }

    #[inline(always)]
    fn turn(&self, Vec3 { x, y, z }: Vec3) -> f32x4 {
        weighted(&self.columns, [x, y, z])
    }

    #[inline(always)]
    fn turn_extent(&self, Vec3 { x, y, z }: Vec3) -> f32x4 {
        weighted(&self.absolute, [x, y, z])
    }
}

#[inline(always)]
fn weighted([a, b, c]: &[f32x4; 3], weights: [f32; 3]) -> f32x4 {
    let [x, y, z] = weights.map(f32x4::splat);
    *a * x + *b * y + *c * z
}

/// The fourth lane is zero: there nothing is separated.
#[inline(always)]
fn lanes(Vec3 { x, y, z }: Vec3) -> f32x4 {
    f32x4::new([x, y, z, 0.0])
}
