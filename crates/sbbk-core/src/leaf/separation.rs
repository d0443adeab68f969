//! The separating axes of two triangles, with a margin.
//!
//! Two triangles are farther apart than a margin `m` if their projections on some axis `n` are
//! farther apart than `m·|n|`. The test tries the three axes of the frame, the two face normals,
//! then the nine products of edges, by cost and success. It is one-sided: a pair passes with corner
//! against corner a little beyond the margin, or in one plane.
//!
//! # Rounding
//!
//! Any axis is valid as computed, so only the rounding of projections matters. With `W` and
//! `r = γ_16·W` from [`rounding`](crate::volumes::rounding), a corner of mesh 2 is off by `r`.
//! Coordinates relative to a corner of triangle 1 are at most `2·W`, with one more rounding. A
//! projection on `n` loses `γ_3·|n|₁` of that, and `|n|₁ <= √3·|n|`. This is below `1.8·γ_7·2·W`,
//! less than `2·r`. Both sides and the difference lose `4·r`.
//!
//! Projections are at most `2·√3·W·|n|` apart. Squaring the gap and comparing with `m²·|n|²` loses
//! `γ_6` of `m·|n|`, below `1.4·r` for every margin that a gap can exceed. Gaps are compared with
//! `m + 6·r`.
//!
//! Margins and coordinates may have any size. If a projection overflows, so does `r²·|n|²`, as `r`
//! exceeds a millionth of `W`. Squares that are infinite or NaN separate nothing.
//!
//! # Products of edges
//!
//! Along `e1 × e2` both ends of an edge are level. The third corner of triangle 1 is behind them by
//! `n1·e2`, and that of triangle 2 ahead by `n2·e1`. Here `n1` and `n2` are the normals, twice the
//! areas long. So an axis takes one projection instead of six, of a vector from edge to edge.
//!
//! This holds for the exact product. Let `X1` and `X2` be the longest sides of the boxes around the
//! triangles, and `S` that of the box around both. Losses in units of `u·X1·X2·S` are at most:
//!
//! | | |
//! |---|---:|
//! | a component of the product, up to `2·X1·X2` | 4 |
//! | the projection: three terms of 2, six roundings each | 36 |
//! | third corners: three terms of 2, five roundings each | 30 |
//! | edges that do not add up to zero, by 3 in each component | 18 |
//! | edges that differ from the vectors between corners | 6 |
//! | the last three for both triangles | 108 |
//! | three additions for a gap, which is below 6 | 18 |
//! | `\|n\|` too short by 7, times a margin below `√3·S` | 12 |
//! | sum of 36, 108, 18 and 12 | 174 |
//!
//! Gaps shrink by `γ_200`, of `X1 + X2 + m` instead of `S`: if that is less, the boxes are apart.
//! Edges nearly along each other give a short axis, and separate nothing.
//!
//! Squares of gaps are above [`UNDERFLOW`], and gaps below `6·X1·X2·S`. Underflow costs a
//! thousandth of the rest while `S` is below `2⁵⁰`. Larger coordinates skip the products.

use wide::f32x4;

use crate::simd::{V3, cross, dot, each, largest, smallest, sub};
use crate::traverse::Placement;
use crate::volumes::rounding::gamma;

/// Bound on the error of squared gaps that underflow: a few times 2⁻¹⁴⁹ a term.
pub(super) const UNDERFLOW: f32 = f32::MIN_POSITIVE;

/// Largest `r` with products of edges: coordinates below `2⁴⁹`.
const LARGEST: f32 = 5.0e8;

/// The pose and margin of a pair of trees, for the leaves.
#[derive(Copy, Clone)]
pub(super) struct LeafFrame {
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    pub(super) rounding: f32,
    margin: f32,
    /// Relative error of products of edges; infinite if they are skipped.
    products: f32,
}

impl LeafFrame {
    /// Without a margin.
    pub(super) fn at(placement: &Placement) -> Self {
        Self {
            rotation: each(|i| placement.rotation.row(i).as_vec3().to_array()),
            translation: placement.translation.as_vec3().to_array(),
            rounding: 0.0,
            margin: 0.0,
            products: 0.0,
        }
    }

    /// Sets the margin, at least zero, and `r` of the module's documentation.
    #[inline(always)]
    pub(super) fn with_margin(self, margin: f32, rounding: f32) -> Self {
        let products = if rounding < LARGEST { gamma(200) } else { f32::INFINITY };
        Self { margin: margin.max(0.0) + 6.0 * rounding, rounding, products, ..self }
    }
}

/// The corners of triangles, in frame 1, and the boxes around them.
#[derive(Copy, Clone)]
pub(super) struct Corners {
    corners: [V3<f32x4>; 3],
    pub(super) min: V3<f32x4>,
    pub(super) max: V3<f32x4>,
}

impl Corners {
    #[inline(always)]
    pub(super) fn new(corners: [V3<f32x4>; 3]) -> Self {
        let along = |axis: usize| each(|corner| corners[corner][axis]);
        Self {
            corners,
            min: each(|axis| smallest(along(axis))),
            max: each(|axis| largest(along(axis))),
        }
    }

    /// Transforms corners from frame 2.
    #[inline(always)]
    pub(super) fn from_frame2(frame: &LeafFrame, corners: [V3<f32x4>; 3]) -> Self {
        Self::new(each(|corner| {
            each(|i| {
                let row = each(|j| f32x4::splat(frame.rotation[i][j]));
                dot(row, corners[corner]) + f32x4::splat(frame.translation[i])
            })
        }))
    }

    /// The lanes whose boxes are farther apart than the margin.
    #[inline(always)]
    fn boxes_apart(&self, other: &Self, margin: f32x4) -> f32x4 {
        let apart = |axis: usize| {
            let above = self.min[axis] - other.max[axis];
            above.fast_max(other.min[axis] - self.max[axis]).simd_gt(margin)
        };
        apart(0) | apart(1) | apart(2)
    }
}

/// The lanes whose triangles are farther apart than the margin along the line through their
/// centroids, the best axis for triangles far apart for their size.
#[inline(always)]
pub(super) fn apart_by_centroids(frame: &LeafFrame, one: &Corners, two: &Corners) -> f32x4 {
    let corners = from_corner(one, two);
    // Three times the centroid; the length of an axis does not matter.
    let sum = |[a, b, c]: [V3<f32x4>; 3]| each(|axis| a[axis] + b[axis] + c[axis]);
    separates(
        sub(sum(corners[1]), sum(corners[0])),
        &corners,
        f32x4::splat(frame.margin * frame.margin),
    )
}

/// The lanes whose triangles an axis separates by more than the margin.
#[inline(always)]
pub(super) fn apart(frame: &LeafFrame, one: &Corners, two: &Corners) -> f32x4 {
    let mut apart = one.boxes_apart(two, f32x4::splat(frame.margin));
    if apart.all() {
        return apart;
    }
    let corners = from_corner(one, two);
    let margin_squared = f32x4::splat(frame.margin * frame.margin);
    let normal1 = cross(corners[0][1], corners[0][2]);
    apart |= separates(normal1, &corners, margin_squared);
    if apart.all() {
        return apart;
    }
    let [a, b, c] = corners[1];
    let normal2 = cross(sub(b, a), sub(c, b));
    apart |= separates(normal2, &corners, margin_squared);
    if apart.all() {
        return apart;
    }
    let lost = lost_by_products(frame, one, two);
    products_separate(&corners, [normal1, normal2], lost, margin_squared, apart)
}

/// The lanes of `known`, and those whose triangles a product of edges separates by more than the
/// margin.
#[inline(always)]
fn products_separate(
    corners: &[[V3<f32x4>; 3]; 2],
    [normal1, normal2]: [V3<f32x4>; 2],
    lost: f32x4,
    margin_squared: f32x4,
    known: f32x4,
) -> f32x4 {
    let edge =
        |triangle: usize, i: usize| sub(corners[triangle][(i + 1) % 3], corners[triangle][i]);
    // Distance of the third corner behind an edge, at most zero, and ahead of it, at least zero.
    let thirds = |normal: V3<f32x4>, edge: V3<f32x4>| {
        let along = dot(normal, edge);
        [along.fast_min(f32x4::splat(0.0)), along.fast_max(f32x4::splat(0.0))]
    };
    let thirds1 = each(|j| {
        let [behind, ahead] = thirds(normal1, edge(1, j));
        [behind - lost, ahead + lost]
    });
    let separated_by = |i: usize| {
        let edge1 = edge(0, i);
        let [behind2, ahead2] = thirds(normal2, edge1);
        let [a, b, c] = each(|j| {
            let axis = cross(edge1, edge(1, j));
            let along = dot(axis, sub(corners[1][j], corners[0][i]));
            let [behind1, ahead1] = thirds1[j];
            let above = along + (behind1 + behind2);
            let below = f32x4::splat(0.0) - (along + (ahead1 + ahead2));
            is_beyond(above.fast_max(below), axis, margin_squared)
        });
        a | b | c
    };
    // Written out: a loop loses most of the gain.
    let mut apart = known | separated_by(0);
    if apart.all() {
        return apart;
    }
    apart |= separated_by(1);
    if apart.all() {
        return apart;
    }
    apart | separated_by(2)
}

/// Rounding of gaps along products of edges, times the length of the product.
#[inline(always)]
fn lost_by_products(frame: &LeafFrame, one: &Corners, two: &Corners) -> f32x4 {
    let size = |corners: &Corners| largest(sub(corners.max, corners.min));
    let (size1, size2) = (size(one), size(two));
    let span = size1 + size2 + f32x4::splat(frame.margin);
    f32x4::splat(frame.products) * size1 * size2 * span
}

/// The corners of both triangles from a corner of triangle 1.
#[inline(always)]
pub(super) fn from_corner(one: &Corners, two: &Corners) -> [[V3<f32x4>; 3]; 2] {
    let origin = one.corners[0];
    let from_origin = |triangle: &Corners| each(|i| sub(triangle.corners[i], origin));
    [from_origin(one), from_origin(two)]
}

/// The lanes whose triangles, relative to a corner of triangle 1, the axis separates by more than
/// the margin.
#[inline(always)]
fn separates(axis: V3<f32x4>, corners: &[[V3<f32x4>; 3]; 2], margin_squared: f32x4) -> f32x4 {
    let [[_, b, c], two] = corners;
    let along1 = [f32x4::splat(0.0), dot(axis, *b), dot(axis, *c)];
    let along2 = each(|i| dot(axis, two[i]));
    let above = smallest(along2) - largest(along1);
    let below = smallest(along1) - largest(along2);
    is_beyond(above.fast_max(below), axis, margin_squared)
}

/// The lanes whose gap along an axis, times its length, is wider than the margin.
#[inline(always)]
fn is_beyond(gap: f32x4, axis: V3<f32x4>, margin_squared: f32x4) -> f32x4 {
    let gap = gap.fast_max(f32x4::splat(0.0));
    let reach = margin_squared * dot(axis, axis) + f32x4::splat(UNDERFLOW);
    (gap * gap).simd_gt(reach)
}
