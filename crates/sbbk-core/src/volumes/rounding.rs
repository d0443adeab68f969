//! What f32 arithmetic can lose, so that every culling test can give it back.
//!
//! Notation (Higham, *Accuracy and Stability of Numerical Algorithms*, chapter 3): `u` is the unit
//! roundoff; one operation returns the exact result times `1 + δ`, `|δ| <= u`; after `n` operations
//! in a row the relative error of each term of a sum is at most `γ_n = n·u / (1 - n·u)`.

/// Unit roundoff of f32: half the distance from 1 to the next number.
const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// `γ_n`, rounded up.
pub const fn gamma(operations: u32) -> f32 {
    // The factor 1.001 covers the division by `1 - n·u` for all n below 16,000 and its own rounding.
    operations as f32 * UNIT_ROUNDOFF * 1.001
}

/// The interval `[min, max]` as a centre and a half-length that contain it in exact arithmetic.
///
/// The centre is rounded, so the half-length is measured from the rounded centre to both ends and
/// rounded up. An empty or non-finite interval gives a half-length that fails every overlap test.
pub fn centre_extent(min: f32, max: f32) -> (f32, f32) {
    let centre = 0.5 * min + 0.5 * max;
    let extent = (max - centre).max(centre - min);
    (centre, extent.next_up())
}

/// [`centre_extent`] of an interval with `min <= max`, or a NaN, without the branches of `f32::next_up`.
#[inline(always)]
pub(crate) fn ordered_centre_extent(min: f32, max: f32) -> (f32, f32) {
    let centre = 0.5 * min + 0.5 * max;
    let (above, below) = (max - centre, centre - min);
    let extent = if above > below { above } else { below };
    // Of a number that is not negative the next one has the next bits.
    let up = f32::from_bits(extent.to_bits() + 1);
    (centre, if extent < f32::INFINITY { up } else { extent })
}
