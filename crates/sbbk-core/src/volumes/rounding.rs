//! Bounds on the rounding of f32, by which every culling test is widened.
//!
//! The notation is from Higham, *Accuracy and Stability of Numerical Algorithms*, chapter 3. The
//! unit roundoff is `u = 2⁻²⁴`: one operation returns the exact result times `1 + δ`, `|δ| <= u`.
//! After `n` operations in a row the relative error of each term of a sum is at most `γ_n = n·u /
//! (1 - n·u)`, [`gamma`].
//!
//! # Allowances
//!
//! Trees have absolute coordinates up to `M`, and translations up to `T`. `s` is the scale of a
//! rotation, 1 up to the rounding of its quaternion, and `m` a margin. `W = M1 + T + 2·s·M2` bounds
//! all coordinates of two meshes in the frame of the first, as the row sums of `|R|` are at most
//! `√3·s < 2·s`. `r = γ_16·W`. Directions of slabs have components in {-1, 0, 1}. Most allowances
//! have a test that needs them.
//!
//! | place | rounded | bound | allowance |
//! |---|---|---|---|
//! | `LeafBatch::kdop` | two additions of corners | `γ_2·(X + Y + Z)` of the largest coordinates | `γ_3` of that |
//! | `Sphere::fit` | a difference, three squares, a root | `γ_5` of the distance | `γ_6` and `UNDERFLOW` |
//! | `centre_extent` | the half-length | `u` of it | the next number of eight bits, up to `2⁻⁷` more |
//! | `PairFrame`, boxes | `t + R·c2` (5 roundings), minus `c1` (1), `e1 + \|R\|·e2` (8, `e <= M`) | `γ_5·(T + 2·s·M2) + γ_1·W + γ_8·(M1 + 2·s·M2)` | `r`; in frame 2 in the same way |
//! | `BoxTest` | the same, and `c` and `e` (1 each) | `γ_2·W` more | `2·r` |
//! | `Correspondence`, slabs | bounds up to `3·M`, coefficients that sum to `2·√3·s` | `γ_9·3·M1 + γ_6·3·T + γ_14·10.4·s·M2` | `6·r` |
//! | gaps (`Bound`) | the difference of offset and reach, a norm, a length, a scale | `γ_8` of the gap | `γ_8` |
//! | `Toward`, nodes | coefficients that sum to 2, slabs up to `3·M`, 14 roundings a term | `γ_14·(6·M1 + 2·T + 6·s·M2)` | `6·r` |
//! | `Toward`, leaves | components that sum to 1.8, 7 roundings | `γ_7·1.8·(M1 + T + s·M2)` | `r` |
//! | `LeafTest` | see `leaf/separation.rs` | `4·r`, `γ_6·m` with `m <= 2·√3·W` | `6·r` |
//! | the same, products of edges | see there | `174·u` of sizes of triangles | `γ_200` of these |
//! | `PlacedTest` | the same, and an origin taken away | `γ_18` for `γ_16` | the same |
//! | `FieldFrame` | lines `(c·fl(1/n) - 1/2)·scale`, heights times their scale | `γ_4` of the field, `γ_1` of heights | `γ_8`, `γ_4` |
//! | `Placement::motion_bound` | f64 | a few `1e-16` of the terms | `1e-14` |

/// Unit roundoff of f32: half the distance from 1 to the next number.
const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// `γ_n`, rounded up.
pub const fn gamma(operations: u32) -> f32 {
    // The factor 1.001 covers the division by `1 - n·u` for all n below 16,000 and its own
    // rounding.
    operations as f32 * UNIT_ROUNDOFF * 1.001
}

/// A length, as the upper half of an f32: eight significant bits, rounded up.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct HalfLength(u16);

impl HalfLength {
    /// The half-length of no interval, with which no test passes.
    pub(crate) const NONE: Self = Self((f32::NEG_INFINITY.to_bits() >> 16) as u16);

    /// The next half-length above a length. Infinite above `2¹²⁸ - 2¹²⁰`; infinity and NaN stay.
    #[inline(always)]
    fn above(length: f32) -> Self {
        let below = (length.to_bits() >> 16) as u16;
        Self(if length < f32::INFINITY { below + 1 } else { below })
    }
}

impl From<HalfLength> for f32 {
    #[inline(always)]
    fn from(HalfLength(upper): HalfLength) -> Self {
        f32::from_bits(u32::from(upper) << 16)
    }
}

/// The interval `[min, max]` as a centre and a half-length that contain it in exact arithmetic.
///
/// The centre is rounded, so the half-length is measured from the rounded centre to both ends and
/// rounded up. An interval that is not finite gives a half-length that passes no test.
#[inline(always)]
pub(crate) fn centre_extent(min: f32, max: f32) -> (f32, HalfLength) {
    let centre = 0.5 * min + 0.5 * max;
    let (above, below) = (max - centre, centre - min);
    (centre, HalfLength::above(if above > below { above } else { below }))
}
