use glamx::{DMat3, Pose3};
use wide::f32x4;

use super::correspondence::Correspondence;
use super::placement::Placement;
use super::side::Side;
use crate::simd::{Spread, V3, dot, each};
use crate::tree::Tree;
use crate::volumes::rounding::gamma;

/// Everything about a pair of trees that depends on their relative pose and the margin: computed
/// once a query, in f64, and spread over lanes.
///
/// Tests are conservative: they allow for [`rounding`](crate::volumes::rounding). At a pose that is
/// not finite no test passes. Any finite margin will do.
#[derive(Clone, Debug)]
pub struct PairFrame {
    pub(crate) placement: Placement,
    margin: f32,
    /// What a comparison of boxes may lose, in frame 1 and in frame 2.
    pub(crate) rounding: [f32; 2],
    /// The margin plus the rounding, likewise.
    pub(super) slack: [f32x4; 2],
    translation: V3<f32x4>,
    to_frame1: Rows,
    to_frame2: Rows,
    /// Computed when a descent first reaches k-DOPs in both trees: thousands of shallow pairs never
    /// do.
    correspondence: Option<Correspondence>,
}

/// What comparisons of boxes allow, in frame 1 and in frame 2.
pub(super) struct Allowance {
    /// What rounding may take.
    pub(super) rounding: [f32; 2],
    /// The margin plus that.
    pub(super) slack: [f32; 2],
}

impl Allowance {
    /// For bodies with coordinates up to `magnitudes`.
    #[inline]
    pub(super) fn new([m1, m2]: [f32; 2], placement: &Placement, margin: f32) -> Self {
        let Placement { rotation, translation, inverse } = placement;
        // A row of the inverse is 1/s long: distances along it shrink by that.
        let longest_row = |matrix: &DMat3| {
            let squares = each(|i| matrix.row(i).length_squared());
            squares.into_iter().fold(0.0, f64::max).sqrt()
        };
        let (scale, inverse_scale) = (longest_row(rotation), longest_row(inverse));
        let t = translation.as_vec3().abs().max_element();
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
    /// How far both boxes reach together. Where an offset is longer, its axis separates them.
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
    /// Where no axis separates the boxes. False where anything is NaN.
    #[inline(always)]
    pub(super) fn meet(&self) -> f32x4 {
        let [x, y, z] = each(|axis| self.offset[axis].abs().simd_le(self.reach[axis]));
        x & y & z
    }

    /// By how much each axis separates them; negative where they overlap.
    #[inline(always)]
    pub(super) fn gaps(&self) -> V3<f32x4> {
        each(|axis| self.offset[axis].abs() - self.reach[axis])
    }
}

impl PairFrame {
    /// The frame of `tree2` at the pose `pos12` in the frame of `tree1`, as of [`at`](Self::at).
    pub fn new(tree1: &Tree, tree2: &Tree, pos12: &Pose3, margin: f32) -> Self {
        Self::at((tree1, tree2), Placement::new(pos12), margin)
    }

    /// The frame of `tree2` at `placement` in the frame of `tree1`. Triangles within `margin` of
    /// each other will be found.
    pub fn at((tree1, tree2): (&Tree, &Tree), placement: Placement, margin: f32) -> Self {
        Self::within([tree1.magnitude(), tree2.magnitude()], placement, margin)
    }

    /// The frame of any two bodies, whose coordinates are at most so large.
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
        }
    }

    /// The distance up to which pairs are found.
    pub fn margin(&self) -> f32 {
        self.margin
    }

    /// Where mesh 2 is in the frame of mesh 1.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Whether the root spheres come within the margin; `true` where a tree has none.
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

/// The kernel of all tests of boxes. The nine edge axes are left out: the tests that they save cost
/// less than they do.
impl PairFrame {
    /// Along the axes of frame 1, with reaches longer by `slack`.
    #[inline(always)]
    pub(crate) fn along1(
        &self,
        side1: &Side<'_, impl Spread>,
        side2: &Side<'_, impl Spread>,
        slack: f32x4,
    ) -> Along {
        let Rows { rows, absolute } = &self.to_frame1;
        let (centre1, extent1) = (side1.centre(), side1.extent());
        let (centre2, extent2) = (side2.centre(), side2.extent());
        Along {
            offset: each(|i| self.translation[i] + dot(rows[i], centre2) - centre1[i]),
            reach: each(|i| extent1[i] + dot(absolute[i], extent2) + slack),
        }
    }

    /// Along the axes of frame 2. `offset` is that of [`along1`](Self::along1).
    #[inline(always)]
    pub(super) fn along2(
        &self,
        side1: &Side<'_, impl Spread>,
        side2: &Side<'_, impl Spread>,
        offset: V3<f32x4>,
        slack: f32x4,
    ) -> Along {
        let Rows { rows, absolute } = &self.to_frame2;
        let (extent1, extent2) = (side1.extent(), side2.extent());
        Along {
            offset: each(|i| dot(rows[i], offset)),
            reach: each(|i| extent2[i] + dot(absolute[i], extent1) + slack),
        }
    }
}

impl PairFrame {
    /// The correspondence of the slabs, computed once.
    #[inline(always)]
    pub(super) fn correspondence(&mut self) -> &Correspondence {
        self.correspondence.get_or_insert_with(|| {
            Correspondence::new(&self.placement, self.margin, self.rounding[0])
        })
    }
}
