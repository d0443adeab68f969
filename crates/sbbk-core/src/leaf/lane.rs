//! One number or four at a time, for code that is written once.

use std::ops::{Add, BitAnd, Mul, Sub};

use wide::f32x4;

/// A lane or several of f32, with IEEE arithmetic and no fused operations: the same results for any width.
pub(super) trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// A truth value a lane.
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    fn splat(x: f32) -> Self;
    /// The smaller of two numbers; either one if one is NaN.
    fn smaller(self, other: Self) -> Self;
    /// The larger of two numbers; either one if one is NaN.
    fn larger(self, other: Self) -> Self;
    /// False where a lane is NaN.
    fn at_most(self, other: Self) -> Self::Mask;
    fn any(mask: Self::Mask) -> bool;
}

impl Lane for f32 {
    type Mask = bool;

    fn splat(x: f32) -> Self {
        x
    }

    fn smaller(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    fn any(mask: bool) -> bool {
        mask
    }
}

impl Lane for f32x4 {
    type Mask = f32x4;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        f32x4::splat(x)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        self.simd_le(other)
    }

    #[inline(always)]
    fn any(mask: Self) -> bool {
        mask.to_bitmask() != 0
    }
}

/// A vector of lanes.
pub(super) type V3<L> = [L; 3];

/// `f` of each index: written out, as `array::map` is not always inlined and then costs a tenth of a query.
#[inline(always)]
pub(crate) fn each<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
pub(super) fn sub<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn dot<L: Lane>(a: V3<L>, b: V3<L>) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
