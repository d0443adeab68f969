//! The separating axes of two triangles, with a margin.
//!
//! Two triangles are farther apart than a margin `m` if their projections on some axis `n` are farther apart
//! than `m·|n|`. Tried in order of what they cost and how often they succeed: the three axes of the frame, the
//! two face normals, the nine products of edges. These do not tell all: a pair can come through with corner against
//! corner a little beyond the margin, or in one plane. The test is one-sided on purpose.
//!
//! Of the pairs whose leaves meet, boxes leave a half on self-contacts of a head of 968 triangles, normals a
//! half of these, edge products again a half: nearly all that are left are true. The six normals of
//! edges in the planes were tried and dropped: a third of the time, and not one pair more rejected.
//!
//! # Rounding
//!
//! Whatever an axis is, it is used as computed, so only the projections' rounding matters. A corner of mesh 2
//! carries the frame's bound `r = γ_16·(M1 + T + 2·s·M2)`. Coordinates are taken relative to a corner of triangle
//! 1: at most `2·(M1 + T + 1.8·s·M2)` with one more rounding; a projection on `n` loses `γ_3·|n|₁` of that, and
//! `|n|₁ <= √3·|n|`: below `1.8·γ_7·2·(…)`, less than 2·r. Both sides and the difference: 4·r. The gap is compared
//! with `(m + 5·r)·|n|`, squared, whose own roundings (γ_8) the last r and a factor cover.

use super::lane::{Lane, V3, cross, dot, each, sub};
use crate::traverse::{PairFrame, Placement};
use crate::volumes::rounding::gamma;

/// What products of tiny numbers lose to underflow: a few times 2⁻¹⁴⁹ a term, in the squares next to
/// nothing for larger gaps. Triangles so small that this matters are kept, as they should be.
const UNDERFLOW: f32 = f32::MIN_POSITIVE;

/// The pose and margin of a pair of trees, for the leaves.
#[derive(Copy, Clone)]
pub(super) struct LeafFrame {
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    rounding: f32,
    margin: f32,
}

impl LeafFrame {
    pub(super) fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        Self::at(frame.placement()).with_margin(frame.margin().max(0.0), frame.rounding)
    }

    /// Without a margin.
    pub(super) fn at(placement: &Placement) -> Self {
        Self {
            rotation: each(|i| placement.rotation.row(i).as_vec3().to_array()),
            translation: placement.translation.as_vec3().to_array(),
            rounding: 0.0,
            margin: 0.0,
        }
    }

    /// The same pose with another margin.
    #[inline(always)]
    pub(super) fn within(self, margin: f32) -> Self {
        self.with_margin(margin.max(0.0), self.rounding)
    }

    /// With the margin, and `r` of the module's documentation.
    #[inline(always)]
    pub(super) fn with_margin(self, margin: f32, rounding: f32) -> Self {
        Self { margin: (margin + 5.0 * rounding) * (1.0 + gamma(16)), rounding, ..self }
    }
}

/// The corners of triangles, in frame 1, and the boxes around them.
#[derive(Copy, Clone)]
pub(super) struct Corners<L> {
    corners: [V3<L>; 3],
    min: V3<L>,
    max: V3<L>,
}

impl<L: Lane> Corners<L> {
    #[inline(always)]
    pub(super) fn new(corners: [V3<L>; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            corners,
            min: each(|axis| a[axis].smaller(b[axis]).smaller(c[axis])),
            max: each(|axis| a[axis].larger(b[axis]).larger(c[axis])),
        }
    }

    /// One corner after the other, from frame 2.
    #[inline(always)]
    pub(super) fn from_frame2(frame: &LeafFrame, corners: [V3<L>; 3]) -> Self {
        Self::new(each(|corner| {
            each(|i| {
                let row = each(|j| L::splat(frame.rotation[i][j]));
                dot(row, corners[corner]) + L::splat(frame.translation[i])
            })
        }))
    }

    /// Which of the boxes come within the margin.
    #[inline(always)]
    fn boxes_near(&self, other: &Self, margin: L) -> L::Mask {
        let near = |axis: usize| {
            let above = self.min[axis] - other.max[axis];
            above.larger(other.min[axis] - self.max[axis]).at_most(margin)
        };
        near(0) & near(1) & near(2)
    }
}

/// Which triangles are no more than the margin apart along the line through their centroids, lane by lane: the axis
/// that tells most about triangles that are far apart for their size.
#[inline(always)]
pub(super) fn near_by_centroids<L: Lane>(
    frame: &LeafFrame,
    one: &Corners<L>,
    two: &Corners<L>,
) -> L::Mask {
    let origin = one.corners[0];
    let corners = [one, two].map(|triangle| each(|i| sub(triangle.corners[i], origin)));
    // Three times as long, which does not matter.
    let sums = corners.map(|[a, b, c]| each(|axis| a[axis] + b[axis] + c[axis]));
    axis_near(sub(sums[1], sums[0]), &corners, L::splat(frame.margin * frame.margin))
}

/// Which triangles no axis separates by more than the margin, lane by lane.
#[inline(always)]
pub(super) fn near<L: Lane>(frame: &LeafFrame, one: &Corners<L>, two: &Corners<L>) -> L::Mask {
    let mut near = one.boxes_near(two, L::splat(frame.margin));
    if !L::any(near) {
        return near;
    }
    // Relative to a corner of triangle 1.
    let origin = one.corners[0];
    let corners = [one, two].map(|triangle| each(|i| sub(triangle.corners[i], origin)));
    let edges = corners.map(|c| each(|i| sub(c[(i + 1) % 3], c[i])));
    let margin_squared = L::splat(frame.margin * frame.margin);
    for [edge1, edge2, _] in edges {
        near = near & axis_near(cross(edge1, edge2), &corners, margin_squared);
    }
    for edge1 in edges[0] {
        if !L::any(near) {
            return near;
        }
        for edge2 in edges[1] {
            near = near & axis_near(cross(edge1, edge2), &corners, margin_squared);
        }
    }
    near
}

#[inline(always)]
fn axis_near<L: Lane>(axis: V3<L>, corners: &[[V3<L>; 3]; 2], margin_squared: L) -> L::Mask {
    let ends = |corners: &[V3<L>; 3]| {
        let [a, b, c] = each(|i| dot(axis, corners[i]));
        (a.smaller(b).smaller(c), a.larger(b).larger(c))
    };
    let ((min1, max1), (min2, max2)) = (ends(&corners[0]), ends(&corners[1]));
    let gap = (min2 - max1).larger(min1 - max2).larger(L::splat(0.0));
    let reach = margin_squared * dot(axis, axis) + L::splat(UNDERFLOW);
    (gap * gap).at_most(reach)
}
