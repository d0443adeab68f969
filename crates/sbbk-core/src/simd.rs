//! Numbers in lanes: code that runs over one lane or four, and the layouts of nodes over four.

use std::ops::{Add, BitAnd, BitOr, Mul, Sub};

use wide::f32x4;

/// A lane or several of f32, with IEEE arithmetic and no fused operations: the same results for any
/// width.
pub(crate) trait Lane:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// A truth value a lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;

    fn splat(x: f32) -> Self;
    /// The smaller of two numbers; either one if one is NaN.
    fn smaller(self, other: Self) -> Self;
    /// The larger of two numbers; either one if one is NaN.
    fn larger(self, other: Self) -> Self;
    /// One over the square root.
    fn inverse_root(self) -> Self;
    /// False where a lane is NaN.
    fn above(self, other: Self) -> Self::Mask;
    fn all(mask: Self::Mask) -> bool;
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

    fn inverse_root(self) -> Self {
        1.0 / self.sqrt()
    }

    fn above(self, other: Self) -> bool {
        self > other
    }

    fn all(mask: bool) -> bool {
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
    fn inverse_root(self) -> Self {
        f32x4::splat(1.0) / self.sqrt()
    }

    #[inline(always)]
    fn above(self, other: Self) -> Self {
        self.simd_gt(other)
    }

    #[inline(always)]
    fn all(mask: Self) -> bool {
        mask.to_bitmask() == 0b1111
    }
}

/// A vector of lanes.
pub(crate) type V3<L> = [L; 3];

/// `f` of each index: written out, as `array::map` is not always inlined and then costs a tenth of
/// a query.
#[inline(always)]
pub(crate) fn each<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
pub(crate) fn sub<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn dot<L: Lane>(a: V3<L>, b: V3<L>) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross<L: Lane>(a: V3<L>, b: V3<L>) -> V3<L> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The largest of three, lane by lane.
#[inline(always)]
pub(crate) fn largest<L: Lane>([a, b, c]: V3<L>) -> L {
    a.larger(b).larger(c)
}

/// The smallest of three, lane by lane.
#[inline(always)]
pub(crate) fn smallest<L: Lane>([a, b, c]: V3<L>) -> L {
    a.smaller(b).smaller(c)
}

/// Calls `found` with the places of the bits that are set, from the lowest.
#[inline(always)]
pub(crate) fn each_bit(mut mask: u32, mut found: impl FnMut(usize)) {
    while mask != 0 {
        found(mask.trailing_zeros() as usize);
        mask &= mask - 1;
    }
}

/// A number of each of two children of a node.
pub(crate) type PerChild<T> = [T; 2];

/// How the children of one side lie over the four lanes of a test.
pub(crate) trait Spread: Copy {
    fn spread(self, values: &PerChild<impl Copy + Into<f32>>) -> f32x4;
}

/// Children 0, 0, 1, 1: side 1 of all four pairs of children.
#[derive(Copy, Clone)]
pub(crate) struct Outer;

/// Children 0, 1, 0, 1: side 2.
#[derive(Copy, Clone)]
pub(crate) struct Inner;

/// One child in all lanes: a leaf, while the other side goes on.
#[derive(Copy, Clone)]
pub(crate) struct Same(pub(crate) usize);

impl Spread for Outer {
    #[inline(always)]
    fn spread(self, &[a, b]: &PerChild<impl Copy + Into<f32>>) -> f32x4 {
        f32x4::new([a.into(), a.into(), b.into(), b.into()])
    }
}

impl Spread for Inner {
    #[inline(always)]
    fn spread(self, &[a, b]: &PerChild<impl Copy + Into<f32>>) -> f32x4 {
        f32x4::new([a.into(), b.into(), a.into(), b.into()])
    }
}

impl Spread for Same {
    #[inline(always)]
    fn spread(self, values: &PerChild<impl Copy + Into<f32>>) -> f32x4 {
        f32x4::splat(values[self.0].into())
    }
}
