use glamx::{DMat3, Pose3};
use wide::f32x4;

use super::correspondence::Correspondence;
use super::placement::Placement;
use crate::leaf::lane::each;
use crate::tree::Tree;
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

/// Everything about a pair of trees that depends on their relative pose and the margin: computed once a
/// query, in f64, and spread over lanes.
///
/// # Rounding
///
/// Let `M1`, `M2` be the largest absolute coordinates of the trees, `T` that of the translation and `s` the
/// rotation's scale (1 up to the rounding of its quaternion). A test in frame 1 computes
/// `|c1 - (t + R c2)| - e1 - |R| e2` in f32 from an R rounded once:
///
/// * each of the terms of `t + R c2` goes through at most 5 roundings, and the row sums of |R| are at most
///   `√3·s < 1.8·s`: at most `γ_5·(T + 1.8·s·M2)`;
/// * the difference with `c1` adds `γ_1·(M1 + T + 1.8·s·M2)`, the extents `γ_8·(M1 + 1.8·s·M2)`, as
///   half-lengths are at most the largest coordinate.
///
/// The sum is below `γ_16·(M1 + T + 2·s·M2)`, and likewise in frame 2 with the roles exchanged. The margin grows
/// by that. A pose that is not finite gives NaN everywhere, and no test passes.
#[derive(Clone, Debug)]
pub struct PairFrame<const AXES: usize = 9> {
    pub(crate) placement: Placement,
    margin: f32,
    /// The rounding bound above, frame 1.
    pub(crate) rounding: f32,
    /// The same in frame 2.
    pub(super) rounding2: f32,
    pub(super) translation_lanes: [f32x4; 3],
    pub(super) axes1: BoxAxes,
    pub(super) axes2: BoxAxes,
    /// Computed when a descent first reaches k-DOPs in both trees: thousands of shallow pairs never do.
    correspondence: Option<Correspondence<AXES>>,
}

/// The three face axes of the boxes of one tree, and the other tree's axes seen in them, over lanes.
#[derive(Copy, Clone, Debug)]
pub(super) struct BoxAxes {
    /// Row `i` takes a centre of the other frame to coordinate `i` of this one.
    pub(super) rows: [[f32x4; 3]; 3],
    pub(super) absolute_rows: [[f32x4; 3]; 3],
    pub(super) margin: f32x4,
}

impl BoxAxes {
    fn new(matrix: DMat3, margin: f32) -> Self {
        let rows = each(|i| matrix.row(i).as_vec3().to_array());
        Self {
            rows: each(|i| each(|j| f32x4::splat(rows[i][j]))),
            absolute_rows: each(|i| each(|j| f32x4::splat(rows[i][j].abs()))),
            margin: f32x4::splat(margin),
        }
    }
}

impl<const AXES: usize> PairFrame<AXES> {
    /// The frame of `tree2` placed at `pos12` in the frame of `tree1`. Triangles within `margin` of each other
    /// will be found.
    pub fn new(tree1: &Tree<AXES>, tree2: &Tree<AXES>, pos12: &Pose3, margin: f32) -> Self {
        Self::at((tree1, tree2), Placement::new(pos12), margin)
    }

    /// As [`new`](Self::new), for a pose that is known already.
    pub fn at(
        (tree1, tree2): (&Tree<AXES>, &Tree<AXES>),
        placement: Placement,
        margin: f32,
    ) -> Self {
        let Placement { rotation, translation, inverse } = placement;
        let translation = translation.as_vec3();
        // A row of the inverse is 1/s long: distances along it shrink by that.
        let inverse_scale = each(|i| inverse.row(i).length()).into_iter().fold(0.0, f64::max);
        let scale = each(|i| rotation.row(i).length()).into_iter().fold(0.0, f64::max);

        let (m1, m2) = (tree1.magnitude(), tree2.magnitude());
        let t = translation.abs().max_element();
        let rounding = gamma(16) * (m1 + t + 2.0 * scale as f32 * m2);
        let rounding2 = gamma(16) * (m2 + 2.0 * inverse_scale as f32 * (m1 + t));
        let margin2 = (f64::from(margin) * inverse_scale) as f32;
        Self {
            placement,
            margin,
            rounding,
            rounding2,
            translation_lanes: each(|i| f32x4::splat(translation[i])),
            axes1: BoxAxes::new(rotation, (margin + rounding).next_up()),
            axes2: BoxAxes::new(inverse, (margin2 + rounding2).next_up()),
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
    pub(crate) fn spheres_meet(&self, tree1: &Tree<AXES>, tree2: &Tree<AXES>) -> bool {
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

impl<const AXES: usize> PairFrame<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// The correspondence of the slabs, computed once.
    #[inline(always)]
    pub(super) fn correspondence(&mut self) -> &Correspondence<AXES> {
        self.correspondence
            .get_or_insert_with(|| Correspondence::new(&self.placement, self.margin, self.rounding))
    }
}
