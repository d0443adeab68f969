//! The separating axes of two triangles, with a margin.
//!
//! Two triangles are farther apart than a margin `m` if their projections on some axis `n` are farther apart
//! than `m·|n|`. Tried in order of what they cost and how often they succeed: the three axes of the frame, the
//! two face normals, the nine products of edges, the six normals of edges in the planes (for nearly
//! coplanar triangles, whose edge products vanish). These are all the axes there are for triangles that
//! touch, not for ones that are apart: a pair can come through with corner against corner a little beyond the
//! margin. The test is one-sided on purpose.
//!
//! # Rounding
//!
//! Whatever an axis is, it is used as computed, so only the projections' rounding matters. A corner of mesh 2
//! carries the frame's bound `r = γ_16·(M1 + T + 2·s·M2)`. Coordinates are taken relative to a corner of triangle
//! 1: at most `2·(M1 + T + 1.8·s·M2)` with one more rounding; a projection on `n` loses `γ_3·|n|₁` of that, and
//! `|n|₁ <= √3·|n|`: below `1.8·γ_7·2·(…)`, less than 2·r. Both sides and the difference: 4·r. The gap is compared
//! with `(m + 5·r)·|n|`, squared, whose own roundings (γ_8) the last r and a factor cover.

use super::lane::{Lane, V3, cross, dot, each, sub};
use crate::traverse::PairFrame;
use crate::volumes::rounding::gamma;

/// What products of tiny numbers lose to underflow: a few times 2⁻¹⁴⁹ a term, in the squares next to
/// nothing for larger gaps. Triangles so small that this matters are kept, as they should be.
const UNDERFLOW: f32 = f32::MIN_POSITIVE;

/// The pose and margin of a pair of trees, for the leaves.
#[derive(Copy, Clone)]
pub(super) struct LeafFrame {
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    margin: f32,
}

impl LeafFrame {
    pub(super) fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        let placement = frame.placement();
        let margin = (frame.margin().max(0.0) + 5.0 * frame.rounding) * (1.0 + gamma(16));
        Self {
            rotation: [0, 1, 2].map(|i| placement.rotation.row(i).as_vec3().to_array()),
            translation: placement.translation.as_vec3().to_array(),
            margin,
        }
    }
}

/// A triangle of mesh 1.
#[derive(Copy, Clone)]
pub(super) struct Triangle<L> {
    corners: [V3<L>; 3],
    edges: [V3<L>; 3],
    normal: V3<L>,
    min: V3<L>,
    max: V3<L>,
}

impl<L: Lane> Triangle<L> {
    #[inline(always)]
    pub(super) fn new(corners: [V3<L>; 3]) -> Self {
        let edges = each(|i| sub(corners[(i + 1) % 3], corners[i]));
        Self {
            corners,
            edges,
            normal: cross(edges[0], edges[1]),
            min: each(|axis| corners[0][axis].smaller(corners[1][axis]).smaller(corners[2][axis])),
            max: each(|axis| corners[0][axis].larger(corners[1][axis]).larger(corners[2][axis])),
        }
    }
}

/// Triangles of mesh 2, in frame 1.
pub(super) struct Batch<L> {
    triangles: Triangle<L>,
    margin: L,
    margin_squared: L,
}

impl<L: Lane> Batch<L> {
    /// `corners` are in frame 2.
    #[inline(always)]
    pub(super) fn new(frame: &LeafFrame, corners: [V3<L>; 3]) -> Self {
        let corners = each(|corner| {
            each(|i| {
                let row = each(|j| L::splat(frame.rotation[i][j]));
                dot(row, corners[corner]) + L::splat(frame.translation[i])
            })
        });
        Self {
            triangles: Triangle::new(corners),
            margin: L::splat(frame.margin),
            margin_squared: L::splat(frame.margin * frame.margin),
        }
    }

    /// Which of the triangles no axis separates from `other` by more than the margin.
    #[inline(always)]
    pub(super) fn near(&self, other: &Triangle<L>) -> L::Mask {
        let (one, two) = (other, &self.triangles);
        let mut near = self.boxes_near(one);
        if !L::any(near) {
            return near;
        }
        // Relative to a corner of triangle 1.
        let origin = one.corners[0];
        let corners1 = each(|i| sub(one.corners[i], origin));
        let corners2 = each(|i| sub(two.corners[i], origin));
        for normal in [one.normal, two.normal] {
            near = near & self.axis_near(normal, &corners1, &corners2);
        }
        for edge1 in one.edges {
            if !L::any(near) {
                return near;
            }
            for edge2 in two.edges {
                near = near & self.axis_near(cross(edge1, edge2), &corners1, &corners2);
            }
        }
        for triangle in [one, two] {
            if !L::any(near) {
                return near;
            }
            for edge in triangle.edges {
                let in_plane = cross(edge, triangle.normal);
                near = near & self.axis_near(in_plane, &corners1, &corners2);
            }
        }
        near
    }

    #[inline(always)]
    fn boxes_near(&self, one: &Triangle<L>) -> L::Mask {
        let two = &self.triangles;
        let near = |axis: usize| {
            let gap = (two.min[axis] - one.max[axis]).larger(one.min[axis] - two.max[axis]);
            gap.at_most(self.margin)
        };
        near(0) & near(1) & near(2)
    }

    #[inline(always)]
    fn axis_near(&self, axis: V3<L>, corners1: &[V3<L>; 3], corners2: &[V3<L>; 3]) -> L::Mask {
        let ends = |corners: &[V3<L>; 3]| {
            let [a, b, c] = each(|i| dot(axis, corners[i]));
            (a.smaller(b).smaller(c), a.larger(b).larger(c))
        };
        let ((min1, max1), (min2, max2)) = (ends(corners1), ends(corners2));
        let gap = (min2 - max1).larger(min1 - max2).larger(L::splat(0.0));
        let reach = self.margin_squared * dot(axis, axis) + L::splat(UNDERFLOW);
        (gap * gap).at_most(reach)
    }
}
