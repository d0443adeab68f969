//! The separating axes of two triangles, with a margin.
//!
//! Two triangles are farther apart than a margin `m` if their projections on some axis `n` are
//! farther apart than `m·|n|`. Tried in order of what they cost and how often they succeed: the
//! three axes of the frame, the two face normals, the nine products of edges. These do not tell
//! all: a pair can come through with corner against corner a little beyond the margin, or in one
//! plane. The test is one-sided on purpose.
//!
//! Of the pairs whose leaves meet, boxes leave a half on self-contacts of a head of 968 triangles,
//! normals a half of these, edge products again a half: nearly all that are left are true. The six
//! normals of edges in the planes were tried and dropped: a third of the time, and not one pair
//! more rejected.
//!
//! # Rounding
//!
//! Whatever an axis is, it is used as computed, so only the projections' rounding matters. With `W`
//! and `r = γ_16·W` as in [`rounding`](crate::volumes::rounding), a corner of mesh 2 is off by `r`.
//! Coordinates are taken relative to a corner of triangle 1: at most `2·W` with one more rounding;
//! a projection on `n` loses `γ_3·|n|₁` of that, and `|n|₁ <= √3·|n|`: below `1.8·γ_7·2·W`, less
//! than `2·r`. Both sides and the difference: `4·r`. Projections are at most `2·√3·W·|n|` apart, so
//! what is lost where the gap is squared and compared with `m²·|n|²`, `γ_6` of `m·|n|`, is below
//! `1.4·r` for every margin that a gap can exceed. Gaps are compared with `m + 6·r`.
//!
//! Margins and coordinates of any size will do: where a projection overflows, so does `r²·|n|²`, as
//! `r` is more than a millionth of `W`; and where squares are infinite or NaN, nothing is taken for
//! separated.

use crate::simd::{Lane, V3, cross, dot, each, largest, smallest, sub};
use crate::traverse::{PairFrame, Placement};

/// What products of tiny numbers lose to underflow: a few times 2⁻¹⁴⁹ a term, in the squares next
/// to nothing for larger gaps.
pub(super) const UNDERFLOW: f32 = f32::MIN_POSITIVE;

/// The pose and margin of a pair of trees, for the leaves.
#[derive(Copy, Clone)]
pub(super) struct LeafFrame {
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    pub(super) rounding: f32,
    margin: f32,
}

impl LeafFrame {
    pub(super) fn new<const AXES: usize>(frame: &PairFrame<AXES>) -> Self {
        Self::at(frame.placement()).with_margin(frame.margin(), frame.rounding[0])
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
        self.with_margin(margin, self.rounding)
    }

    /// With the margin, zero if it is less, and `r` of the module's documentation.
    #[inline(always)]
    pub(super) fn with_margin(self, margin: f32, rounding: f32) -> Self {
        Self { margin: margin.max(0.0) + 6.0 * rounding, rounding, ..self }
    }
}

/// The corners of triangles, in frame 1, and the boxes around them.
#[derive(Copy, Clone)]
pub(super) struct Corners<L> {
    corners: [V3<L>; 3],
    pub(super) min: V3<L>,
    pub(super) max: V3<L>,
}

impl<L: Lane> Corners<L> {
    #[inline(always)]
    pub(super) fn new(corners: [V3<L>; 3]) -> Self {
        let along = |axis: usize| each(|corner| corners[corner][axis]);
        Self {
            corners,
            min: each(|axis| smallest(along(axis))),
            max: each(|axis| largest(along(axis))),
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

    /// Which of the boxes are farther apart than the margin.
    #[inline(always)]
    fn boxes_apart(&self, other: &Self, margin: L) -> L::Mask {
        let apart = |axis: usize| {
            let above = self.min[axis] - other.max[axis];
            above.larger(other.min[axis] - self.max[axis]).above(margin)
        };
        apart(0) | apart(1) | apart(2)
    }
}

/// Which triangles are farther apart than the margin along the line through their centroids, lane
/// by lane: the axis that tells most about triangles that are far apart for their size.
#[inline(always)]
pub(super) fn apart_by_centroids<L: Lane>(
    frame: &LeafFrame,
    one: &Corners<L>,
    two: &Corners<L>,
) -> L::Mask {
    let corners = from_corner(one, two);
    // Three times as long, which does not matter.
    let sum = |[a, b, c]: [V3<L>; 3]| each(|axis| a[axis] + b[axis] + c[axis]);
    separates(
        sub(sum(corners[1]), sum(corners[0])),
        &corners,
        L::splat(frame.margin * frame.margin),
    )
}

/// Which triangles an axis separates by more than the margin, lane by lane.
#[inline(always)]
pub(super) fn apart<L: Lane>(frame: &LeafFrame, one: &Corners<L>, two: &Corners<L>) -> L::Mask {
    let mut apart = one.boxes_apart(two, L::splat(frame.margin));
    if L::all(apart) {
        return apart;
    }
    let corners = from_corner(one, two);
    let edges_of = |c: [V3<L>; 3]| each(|i| sub(c[(i + 1) % 3], c[i]));
    let edges = [edges_of(corners[0]), edges_of(corners[1])];
    let margin_squared = L::splat(frame.margin * frame.margin);
    for [edge1, edge2, _] in edges {
        apart = apart | separates(cross(edge1, edge2), &corners, margin_squared);
    }
    for edge1 in edges[0] {
        if L::all(apart) {
            return apart;
        }
        for edge2 in edges[1] {
            apart = apart | separates(cross(edge1, edge2), &corners, margin_squared);
        }
    }
    apart
}

/// The corners of both triangles from a corner of triangle 1.
#[inline(always)]
pub(super) fn from_corner<L: Lane>(one: &Corners<L>, two: &Corners<L>) -> [[V3<L>; 3]; 2] {
    let origin = one.corners[0];
    let from_origin = |triangle: &Corners<L>| each(|i| sub(triangle.corners[i], origin));
    [from_origin(one), from_origin(two)]
}

#[inline(always)]
fn separates<L: Lane>(axis: V3<L>, corners: &[[V3<L>; 3]; 2], margin_squared: L) -> L::Mask {
    let along = |corners: &[V3<L>; 3]| each(|i| dot(axis, corners[i]));
    let (along1, along2) = (along(&corners[0]), along(&corners[1]));
    let above = smallest(along2) - largest(along1);
    let below = smallest(along1) - largest(along2);
    let gap = above.larger(below).larger(L::splat(0.0));
    let reach = margin_squared * dot(axis, axis) + L::splat(UNDERFLOW);
    (gap * gap).above(reach)
}
