//! Vectors in SIMD lanes, and how the children of two nodes lie over four lanes.

use wide::f32x4;

/// A vector of lanes.
pub(crate) type V3<T> = [T; 3];

/// `f` of each index. Written out, as `array::map` is not always inlined.
#[inline(always)]
pub(crate) fn each<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
pub(crate) fn sub(a: V3<f32x4>, b: V3<f32x4>) -> V3<f32x4> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn dot(a: V3<f32x4>, b: V3<f32x4>) -> f32x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross(a: V3<f32x4>, b: V3<f32x4>) -> V3<f32x4> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The largest of three, lane by lane.
#[inline(always)]
pub(crate) fn largest([a, b, c]: V3<f32x4>) -> f32x4 {
    a.fast_max(b).fast_max(c)
}

/// The smallest of three, lane by lane.
#[inline(always)]
pub(crate) fn smallest([a, b, c]: V3<f32x4>) -> f32x4 {
    a.fast_min(b).fast_min(c)
}

/// The indices of the set bits, from the lowest.
#[inline(always)]
pub(crate) fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let lowest = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            lowest
        })
    })
}

/// A value for each of the two children of a node.
pub(crate) type PerChild<T> = [T; 2];

/// Spreads the two children of one side over the four lanes of a test.
pub(crate) trait Spread: Copy {
    fn spread(self, values: &PerChild<impl Copy + Into<f32>>) -> f32x4;
}

/// Children 0, 0, 1, 1: side 1 of all four pairs of children.
#[derive(Copy, Clone)]
pub(crate) struct Outer;

/// Children 0, 1, 0, 1: side 2.
#[derive(Copy, Clone)]
pub(crate) struct Inner;

/// A single child in all lanes, for the side that stays.
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
