use wide::f32x4;

use super::placement::Placement;
use crate::volumes::{DirectionSet, Directions};

/// For each slab direction of tree 1, three adjacent slabs of tree 2 that bound it: see
/// [`DirectionSet::correspondence`].
///
/// In centre and half-length form, with `b` the direction in frame 2 and `o = d·t`: the projection of a node of
/// tree 2 has the centre `o + Σ cᵢ·centreᵢ` and the half-length `Σ |cᵢ|·extentᵢ`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Correspondence<const AXES: usize> {
    pub(super) slabs: [CorrespondingSlabs; AXES],
}

#[derive(Copy, Clone, Debug)]
pub(super) struct CorrespondingSlabs {
    pub(super) offset: f32x4,
    pub(super) coefficients: [f32x4; 3],
    pub(super) absolute_coefficients: [f32x4; 3],
    pub(super) indices: [usize; 3],
    /// The margin times the length of the direction, plus the rounding.
    pub(super) margin: f32x4,
}

impl<const AXES: usize> Correspondence<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// `rounding` is the bound of [`PairFrame`](super::PairFrame), `γ_16·(M1 + T + 2·s·M2)`.
    ///
    /// Here: slab bounds are at most 3·M (three unit components), the coefficients sum to at most `2·√3·s`,
    /// each term goes through 5 roundings (the coefficient's own included) and the extents through 3 more:
    /// `γ_9·(3·M1) + γ_6·3·T + γ_14·(10.4·s·M2)`. Six times the bound of the boxes, `γ_16·(6·M1 + 6·T + 12·s·M2)`,
    /// is more.
    pub(super) fn new(placement: &Placement, margin: f32, rounding: f32) -> Self {
        let to_frame2 = placement.rotation.transpose();
        let slabs = <Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS.map(|direction| {
            let direction = direction.as_dvec3();
            let terms = Directions::<AXES>::correspondence(to_frame2 * direction);
            let coefficients = terms.map(|(_, coefficient)| coefficient as f32);
            let margin = f64::from(margin) * direction.length() + 6.0 * f64::from(rounding);
            CorrespondingSlabs {
                offset: f32x4::splat(direction.dot(placement.translation) as f32),
                coefficients: coefficients.map(f32x4::splat),
                absolute_coefficients: coefficients.map(|c| f32x4::splat(c.abs())),
                indices: terms.map(|(slab, _)| slab),
                margin: f32x4::splat((margin as f32).next_up()),
            }
        });
        Self { slabs }
    }
}
