use glamx::Vec3;
use wide::f32x4;

use super::placement::Placement;
use super::side::KdopSides;
use crate::simd::{Spread, each};
use crate::volumes::{DirectionSet, Directions};

/// For each slab direction of tree 1, three adjacent slabs of tree 2 that bound it: see
/// [`DirectionSet::correspondence`].
///
/// In centre and half-length form, with `b` the direction in frame 2 and `o = d·t`: the projection
/// of a node of tree 2 has the centre `o + Σ cᵢ·centreᵢ` and the half-length `Σ |cᵢ|·extentᵢ`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Correspondence<const AXES: usize> {
    slabs: [Slab; AXES],
    /// What a comparison of slabs may lose.
    rounding: f32,
}

/// Scalars, spread over lanes where they are used: a query sets these up once and may test few
/// nodes.
#[derive(Copy, Clone, Debug)]
struct Slab {
    offset: f32,
    coefficients: [f32; 3],
    indices: [u8; 3],
    /// The margin times the length of the direction, plus the rounding.
    slack: f32,
}

/// Two k-DOPs in each lane, along one slab.
struct Along {
    /// From the centre of the one of tree 1 to that of the one of tree 2.
    offset: f32x4,
    /// How far both reach together.
    reach: f32x4,
}

impl<const AXES: usize> Correspondence<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// `rounding` is that of the boxes in frame 1; slabs lose up to six times as much, see
    /// [`rounding`](crate::volumes::rounding).
    pub(super) fn new(placement: &Placement, margin: f32, rounding: f32) -> Self {
        let to_frame2 = placement.rotation.transpose();
        let axes = [to_frame2.x_axis, to_frame2.y_axis, to_frame2.z_axis];
        let seen = Directions::<AXES>::project_components(axes);
        let offsets = Directions::<AXES>::project_components(placement.translation.to_array());
        let directions = <Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS;
        let rounding = 6.0 * rounding;
        let slabs = std::array::from_fn(|axis| {
            let terms = Directions::<AXES>::correspondence(seen[axis]);
            let length = directions[axis].as_dvec3().length();
            let slack = f64::from(margin) * length + f64::from(rounding);
            Slab {
                offset: offsets[axis] as f32,
                coefficients: each(|i| terms[i].1 as f32),
                indices: each(|i| terms[i].0 as u8),
                slack: (slack as f32).next_up(),
            }
        });
        Self { slabs, rounding }
    }

    /// Bit k: bit k of `candidates`, and lane k's k-DOPs come within the margin along the slabs of
    /// tree 1.
    ///
    /// Testing the slabs of tree 2 as well prunes a tenth more nodes and costs more than that
    /// saves. So do the slabs along x, y and z, which the boxes have been compared along: without
    /// them a descent takes a seventh fewer instructions.
    #[inline(always)]
    pub(super) fn kdops_meet(
        &self,
        sides: &KdopSides<'_, impl Spread, impl Spread, AXES>,
        candidates: u32,
    ) -> u32 {
        let mut remaining = candidates;
        for (axis, slab) in self.slabs.iter().enumerate().skip(3) {
            let Along { offset, reach } = slab.along(axis, slab.slack, sides);
            remaining &= offset.abs().simd_le(reach).to_bitmask();
            if remaining == 0 {
                break;
            }
        }
        remaining
    }

    /// The largest gap between k-DOPs along the slabs of tree 1 from `first` on, not more than the
    /// exact one but for the `γ_8` of `gaps.rs`; negative where they overlap on all.
    #[inline(always)]
    pub(super) fn gaps(
        &self,
        sides: &KdopSides<'_, impl Spread, impl Spread, AXES>,
        first: usize,
    ) -> f32x4 {
        let inverse_lengths =
            const { inverse_lengths(&<Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS) };
        let mut largest = f32x4::splat(f32::NEG_INFINITY);
        for (axis, slab) in self.slabs.iter().enumerate().skip(first) {
            let Along { offset, reach } = slab.along(axis, self.rounding, sides);
            let gap = (offset.abs() - reach) * f32x4::splat(inverse_lengths[axis]);
            largest = largest.fast_max(gap);
        }
        largest
    }
}

impl Slab {
    /// Along slab `axis` of tree 1, with reaches longer by `slack`.
    #[inline(always)]
    fn along<const AXES: usize>(
        &self,
        axis: usize,
        slack: f32,
        sides: &KdopSides<'_, impl Spread, impl Spread, AXES>,
    ) -> Along {
        let mut offset = f32x4::splat(self.offset) - sides.one.centre(axis);
        let mut reach = f32x4::splat(slack) + sides.one.extent(axis);
        for term in 0..3 {
            let index = usize::from(self.indices[term]);
            let coefficient = f32x4::splat(self.coefficients[term]);
            offset += coefficient * sides.two.centre(index);
            reach += coefficient.abs() * sides.two.extent(index);
        }
        Along { offset, reach }
    }
}

/// `1/|d|` of directions with components in {-1, 0, 1}, rounded down.
const fn inverse_lengths<const AXES: usize>(directions: &[Vec3; AXES]) -> [f32; AXES] {
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
