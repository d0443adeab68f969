use glamx::Vec3;
use wide::f32x4;

use super::overlap::Spread;
use super::placement::Placement;
use crate::leaf::lane::each;
use crate::tree::Lanes;
use crate::volumes::{DirectionSet, Directions};

/// Centres and half-lengths of the slabs of two nodes.
pub(super) type KdopLanes<'a, const AXES: usize> = (&'a [Lanes; AXES], &'a [Lanes; AXES]);

/// For each slab direction of tree 1, three adjacent slabs of tree 2 that bound it: see
/// [`DirectionSet::correspondence`].
///
/// In centre and half-length form, with `b` the direction in frame 2 and `o = d·t`: the projection of a node of
/// tree 2 has the centre `o + Σ cᵢ·centreᵢ` and the half-length `Σ |cᵢ|·extentᵢ`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Correspondence<const AXES: usize> {
    pub(super) slabs: [CorrespondingSlabs; AXES],
}

/// Scalars, spread over lanes where they are used: a query sets these up once and may test few nodes.
#[derive(Copy, Clone, Debug)]
pub(super) struct CorrespondingSlabs {
    pub(super) offset: f32,
    pub(super) coefficients: [f32; 3],
    pub(super) indices: [u8; 3],
    /// The margin times the length of the direction, plus the rounding.
    pub(super) margin: f32,
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
        let directions = <Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS;
        let slabs = std::array::from_fn(|axis| {
            let direction = directions[axis].as_dvec3();
            let terms = Directions::<AXES>::correspondence(to_frame2 * direction);
            let margin = f64::from(margin) * direction.length() + 6.0 * f64::from(rounding);
            CorrespondingSlabs {
                offset: direction.dot(placement.translation) as f32,
                coefficients: each(|i| terms[i].1 as f32),
                indices: each(|i| terms[i].0 as u8),
                margin: (margin as f32).next_up(),
            }
        });
        Self { slabs }
    }
}

impl CorrespondingSlabs {
    /// Along slab `axis` of tree 1, lane by lane: where the centre of the node of tree 2 is, seen from that of tree 1, and how
    /// far both reach together, `slack` included.
    #[inline(always)]
    pub(super) fn offset_and_reach<const AXES: usize>(
        &self,
        axis: usize,
        slack: f32,
        (kdops1, spread1): (KdopLanes<'_, AXES>, impl Spread),
        (kdops2, spread2): (KdopLanes<'_, AXES>, impl Spread),
    ) -> (f32x4, f32x4) {
        let mut offset = f32x4::splat(self.offset) - spread1.spread(&kdops1.0[axis]);
        let mut reach = f32x4::splat(slack) + spread1.spread(&kdops1.1[axis]);
        for term in 0..3 {
            let index = usize::from(self.indices[term]);
            let coefficient = f32x4::splat(self.coefficients[term]);
            offset += coefficient * spread2.spread(&kdops2.0[index]);
            reach += coefficient.abs() * spread2.spread(&kdops2.1[index]);
        }
        (offset, reach)
    }
}

/// `1/|d|` of directions with components in {-1, 0, 1}, rounded down.
pub(super) const fn inverse_lengths<const AXES: usize>(directions: &[Vec3; AXES]) -> [f32; AXES] {
    let mut inverse = [1.0; AXES];
    let mut axis = 0;
    while axis < AXES {
        let d = directions[axis];
        inverse[axis] = match (d.x * d.x + d.y * d.y + d.z * d.z) as u32 {
            1 => 1.0,
            // As f32 it is below 1/√2.
            2 => std::f32::consts::FRAC_1_SQRT_2,
            _ => 0.577_350_2,
        };
        axis += 1;
    }
    inverse
}
