//! Boxes of other hierarchies, one pair at a time, in lanes over the axes.
//!
//! # Rounding
//!
//! The bounds are those of [`PairFrame`](super::PairFrame), except that `c = 1/2·(min + max)` and
//! `e = 1/2·(max - min)` replace a stored centre and half-length. A centre is off by `u·M`, and a
//! half-length too short by as much. In frame 1 this adds `2·u·(M1 + 2·s·M2)` to the loss of a
//! comparison, far below `r`, and similarly in frame 2. The allowance is `2·r`.

use glamx::{DMat3, Vec3};
use wide::f32x4;

use super::frame::Allowance;
use super::placement::Placement;

/// Tests boxes of two bodies at one pose. Made once a query.
#[derive(Copy, Clone, Debug)]
pub struct BoxTest {
    to_frame1: Columns,
    to_frame2: Columns,
    translation: f32x4,
    slack: [f32x4; 2],
}

/// A matrix by columns.
#[derive(Copy, Clone, Debug)]
struct Columns {
    columns: [f32x4; 3],
    absolute: [f32x4; 3],
}

/// The centre and the half-lengths of a box along the axes of its frame.
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

    /// The rounded centre and half-lengths.
    pub fn centre_extent(&self) -> (Vec3, Vec3) {
        (self.centre, self.extent)
    }
}

impl BoxTest {
    /// A test of two bodies with coordinates up to `magnitudes`, body 2 at `placement` in frame 1.
    pub fn new(magnitudes: [f32; 2], placement: &Placement, margin: f32) -> Self {
        let Allowance { rounding, slack } = Allowance::new(magnitudes, placement, margin);
        Self {
            to_frame1: Columns::new(placement.rotation),
            to_frame2: Columns::new(placement.inverse),
            translation: lanes(placement.translation.as_vec3()),
            slack: std::array::from_fn(|i| f32x4::splat(slack[i] + rounding[i])),
        }
    }

    /// Prepares a box of body 2 for tests against boxes of body 1.
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

/// A box of body 2, prepared for tests against boxes of body 1.
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
    /// Returns true if no face axis of the two boxes separates them by more than the margin. False
    /// if a number is NaN.
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

/// The fourth lane is zero, which separates nothing.
#[inline(always)]
fn lanes(Vec3 { x, y, z }: Vec3) -> f32x4 {
    f32x4::new([x, y, z, 0.0])
}
