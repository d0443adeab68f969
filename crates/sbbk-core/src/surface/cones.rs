//! Minimum cones: the directions in which a triangle or one of its features may be a local minimum.
//!
//! Most directions are far from the normal of a triangle and need no look at the neighbours
//! (Johnson and Cohen, *Spatialized Normal Cone Hierarchies*, 2001). [`spread`](super::spread)
//! finds the cones.

/// Allowance for rounding of directions, in squares of cosines.
const ROUNDING: f64 = 1.0e-6;

/// Two cones around the line of a triangle's normal: for contacts with an edge or a vertex, and
/// with a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MinimumCones([u8; 2]);

impl MinimumCones {
    /// Cones of all directions.
    pub const ALL: Self = Self([1; 2]);

    /// Returns the number that [`MinimumCones::of_bits`] takes.
    pub fn bits(self) -> u16 {
        u16::from_le_bytes(self.0)
    }

    /// Returns the cones of a number. `None` for other numbers, for example 0.
    #[inline]
    pub fn of_bits(bits: u16) -> Option<Self> {
        let bytes = bits.to_le_bytes();
        (!bytes.contains(&0)).then_some(Self(bytes))
    }

    /// Returns the square of the least cosine between the normal's line and a direction of a cone.
    #[inline]
    pub fn least_square(self, to_face: bool) -> f64 {
        f64::from(self.0[usize::from(to_face)] - 1) / 254.0
    }

    /// Returns the cones of the squares of two least cosines.
    pub(super) fn new(squares: [f64; 2]) -> Self {
        Self(squares.map(|square| 1 + (254.0 * (square - ROUNDING)).max(0.0) as u8))
    }
}
