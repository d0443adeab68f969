use glamx::DMat3;
use wide::f32x4;

use super::correspondence::Correspondence;
use super::counters::DescentCounts;
use super::placement::{Placement, longest_row};
use super::side::{BothSides, NodeLanes};
use crate::simd::{Spread, V3, dot, each};
use crate::tree::Tree;
use crate::volumes::rounding::gamma;

/// The relative pose of a pair of trees and the margin, computed once a query in f64, and spread
/// over lanes.
///
/// Tests are conservative by the bounds of [`rounding`](crate::volumes::rounding). At a pose that
/// is not finite no test passes. Any finite margin is valid.
#[derive(Clone, Debug)]
pub struct PairFrame {
    /// Placement of mesh 2 in the frame of mesh 1.
    pub(crate) placement: Placement,
    /// The distance up to which pairs are found.
    pub(crate) margin: f32,
    /// Rounding of a comparison of boxes, in frame 1 and in frame 2.
    pub(crate) rounding: [f32; 2],
    /// The margin plus the rounding, in frame 1 and in frame 2.
    pub(super) slack: [f32x4; 2],
    translation: V3<f32x4>,
    to_frame1: Rows,
    to_frame2: Rows,
    /// Computed when a descent first reaches k-DOPs in both trees. Shallow pairs never do.
    correspondence: Option<Correspondence>,
    /// Work of the descents so far.
    pub counts: DescentCounts,
}

/// Allowances of comparisons of boxes, in frame 1 and in frame 2.
pub(super) struct Allowance {
    /// Bound on the rounding.
    pub(super) rounding: [f32; 2],
    /// The margin plus the rounding.
    pub(super) slack: [f32; 2],
}

impl Allowance {
    /// Allowances for bodies with coordinates up to `magnitudes`.
    #[inline]
    pub(super) fn new([m1, m2]: [f32; 2], placement: &Placement, margin: f32) -> Self {
        // A row of the inverse is 1/s long, and distances along it shrink by this factor.
        let (scale, inverse_scale) = (placement.scale(), longest_row(&placement.inverse));
        let t = placement.translation.as_vec3().abs().max_element();
        let rounding = [
            gamma(16) * (m1 + t + 2.0 * scale as f32 * m2),
            gamma(16) * (m2 + 2.0 * inverse_scale as f32 * (m1 + t)),
        ];
        let margins = [margin, (f64::from(margin) * inverse_scale) as f32];
        let slack = std::array::from_fn(|i| (margins[i] + rounding[i]).next_up());
        Self { rounding, slack }
    }
}

/// A matrix over lanes.
#[derive(Copy, Clone, Debug)]
struct Rows {
    rows: [V3<f32x4>; 3],
    absolute: [V3<f32x4>; 3],
}

/// Two boxes in each lane, along the three face axes of one of them.
#[derive(Copy, Clone)]
pub(crate) struct Along {
    /// From the centre of the box of tree 1 to that of the box of tree 2.
    pub(crate) offset: V3<f32x4>,
    /// Sum of the half-lengths of both boxes. An axis with a longer offset separates them.
    pub(crate) reach: V3<f32x4>,
}

impl Rows {
    fn new(matrix: DMat3) -> Self {
        let rows = each(|i| matrix.row(i).as_vec3().to_array());
        Self {
            rows: each(|i| each(|j| f32x4::splat(rows[i][j]))),
            absolute: each(|i| each(|j| f32x4::splat(rows[i][j].abs()))),
        }
    }
}

impl Along {
    /// The lanes where no axis separates the boxes. False if a number is NaN.
    #[inline(always)]
    pub(super) fn meet(&self) -> f32x4 {
        let [x, y, z] = each(|axis| self.offset[axis].abs().simd_le(self.reach[axis]));
        x & y & z
    }

    /// The gap along each axis; negative if the boxes overlap.
    #[inline(always)]
    pub(super) fn gaps(&self) -> V3<f32x4> {
        each(|axis| self.offset[axis].abs() - self.reach[axis])
    }
}

impl PairFrame {
    /// The frame of two trees, tree 2 at `placement` in the frame of tree 1. Descents find
    /// triangles within `margin` of each other.
    pub fn new((tree1, tree2): (&Tree, &Tree), placement: Placement, margin: f32) -> Self {
        Self::within([tree1.magnitude(), tree2.magnitude()], placement, margin)
    }

    /// The frame of any two bodies with coordinates up to `magnitudes`.
    pub fn within(magnitudes: [f32; 2], placement: Placement, margin: f32) -> Self {
        let Placement { rotation, translation, inverse } = placement;
        let translation = translation.as_vec3();
        let Allowance { rounding, slack } = Allowance::new(magnitudes, &placement, margin);
        Self {
            placement,
            margin,
            rounding,
            slack: slack.map(f32x4::splat),
            translation: each(|i| f32x4::splat(translation[i])),
            to_frame1: Rows::new(rotation),
            to_frame2: Rows::new(inverse),
            correspondence: None,
            counts: DescentCounts::default(),
        }
    }

    /// Returns true if the root spheres come within the margin, or if a tree has none.
    pub(crate) fn spheres_meet(&self, tree1: &Tree, tree2: &Tree) -> bool {
        let (Some(sphere1), Some(sphere2)) = (tree1.sphere(), tree2.sphere()) else {
            return true;
        };
        let centre2 = self.placement.to_frame1(sphere2.centre, sphere1.centre);
        let scale = self.placement.rotation.x_axis.length();
        let reach =
            f64::from(sphere1.radius) + scale * f64::from(sphere2.radius) + f64::from(self.margin);
        // f64 rounds far below the spheres' own f32 slack.
        centre2.length() <= reach * (1.0 + 1e-12)
    }
}

/// The kernel of all tests of boxes. The nine edge axes would cost more than they save.
impl PairFrame {
    /// Compares boxes along the axes of frame 1, with reaches longer by `slack`.
    #[inline(always)]
    pub(crate) fn along1(
        &self,
        nodes: &NodeLanes<'_, impl Spread, impl Spread>,
        slack: f32x4,
    ) -> Along {
        let Rows { rows, absolute } = &self.to_frame1;
        let BothSides { one, two } = &nodes.boxes;
        let (centre2, extent2) = (each(|i| two.centre(i)), each(|i| two.extent(i)));
        Along {
            offset: each(|i| self.translation[i] + dot(rows[i], centre2) - one.centre(i)),
            reach: each(|i| one.extent(i) + dot(absolute[i], extent2) + slack),
        }
    }

    /// Compares boxes along the axes of frame 2. `offset` comes from [`along1`](Self::along1).
    #[inline(always)]
    pub(super) fn along2(
        &self,
        nodes: &NodeLanes<'_, impl Spread, impl Spread>,
        offset: V3<f32x4>,
        slack: f32x4,
    ) -> Along {
        let Rows { rows, absolute } = &self.to_frame2;
        let BothSides { one, two } = &nodes.boxes;
        let extent1 = each(|i| one.extent(i));
        Along {
            offset: each(|i| dot(rows[i], offset)),
            reach: each(|i| two.extent(i) + dot(absolute[i], extent1) + slack),
        }
    }

    /// The correspondence of the slabs, computed once.
    #[inline(always)]
    pub(super) fn correspondence(&mut self) -> &Correspondence {
        self.correspondence.get_or_insert_with(|| {
            Correspondence::new(&self.placement, self.margin, self.rounding[0])
        })
    }
}
