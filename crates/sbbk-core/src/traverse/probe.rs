//! A convex shape against one tree: what a query needs to know of the shape, computed once.
//!
//! A convex shape is asked one question: how far does it reach along a direction (its support
//! function, `h(d) = max d·y`). Along each direction it is then an interval, `[-h(-d), h(d)]`, as a
//! node of the tree is one, and two intervals are compared as the slabs of two k-DOPs are. The
//! directions are
//!
//! * the shape's own: the faces of a box, the normal of a half-space. A large floor that is turned
//!   against the mesh is large along every direction of the tree; along its own normal it is thin.
//!   That is what keeps the descent off the part of a mesh that is above it;
//! * the slabs of the tree, boxes first, then k-DOPs.

use glamx::DVec3;
use wide::f32x4;

use super::convex::{Convex, Outline};
use super::placement::Placement;
use crate::simd::{Inner, PerChild, Spread, dot, each};
use crate::tree::{Children, Intervals, Tree};
use crate::volumes::rounding::gamma;
use crate::volumes::{DirectionSet, Directions};

/// A convex shape, placed and grown by a margin, as the intervals that a descent compares nodes
/// with.
///
/// # Rounding
///
/// Let `M` be the largest absolute coordinate of the tree and `n` a direction in its frame. All of
/// the tree is in `[-N, N]` along `n`, with `N = |n|₁·M`. The interval of the shape is computed in
/// f64 and cut off at `±4·N`, where there is nothing to be met: the size of a floor and its
/// distance have no part in the rounding, and an interval without end needs no case of its own. A
/// test computes `|n·c - m| <= Σ|nᵢ|eᵢ + h` in f32:
///
/// * the components of `n` are rounded once, products and sums lose `γ_4·N` on each side;
/// * `m` and `h` are at most `4·N`, rounded once: `γ_1·8·N`; the difference and the sum `γ_1·10·N`.
///
/// That is below `γ_32·N`, which the interval grows by on each side. The last term of it covers
/// underflow.
#[derive(Clone, Debug)]
pub struct Probe<'a, S, const AXES: usize = 9> {
    pub(crate) shape: &'a S,
    pub(crate) outline: Outline,
    /// From the tree's frame to the shape's.
    pub(crate) placement: Placement,
    pub(crate) margin: f64,
    pub(crate) magnitude: f32,
    own: [OwnAxes; 2],
    /// How far along the own axes together, squared: the margin and the outline's radius.
    own_reach_squared: f32x4,
    boxes: ShapeIntervals<3>,
    /// Computed when a descent first reaches k-DOPs.
    kdops: Option<ShapeIntervals<AXES>>,
}

/// The shape's intervals along some directions of the tree.
#[derive(Copy, Clone, Debug)]
struct ShapeIntervals<const COUNT: usize> {
    middle: [f32; COUNT],
    half: [f32; COUNT],
}

/// Two of the shape's own directions, seen in the tree's frame, in lanes 0, 0, 1, 1; none is zero
/// everywhere.
#[derive(Copy, Clone, Debug)]
struct OwnAxes {
    direction: [f32x4; 3],
    magnitude: [f32x4; 3],
    middle: f32x4,
    half: f32x4,
}

impl<'a, S: Convex, const AXES: usize> Probe<'a, S, AXES> {
    /// A shape in whose frame the tree is at `placement`, to find all triangles within `margin` of
    /// it.
    pub fn new(tree: &Tree<AXES>, placement: &Placement, shape: &'a S, margin: f64) -> Self {
        let sight = Sight { shape, placement, margin, magnitude: f64::from(tree.magnitude()) };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let outline = shape.outline();
        let (own, radius) = match outline {
            Outline::RoundBox { half_lengths, radius, .. } => {
                // A ball has no axes: those of the tree leave no corners.
                let is_ball = half_lengths == DVec3::ZERO;
                let to_shape = placement.inverse.transpose();
                let [x, y, z] =
                    axes.map(|axis| if is_ball { (to_shape * axis).normalize() } else { axis });
                ([sight.own_axes([x, y], radius), sight.own_axes([z, DVec3::ZERO], radius)], radius)
            }
            Outline::HalfSpace { normal } => {
                ([[normal, DVec3::ZERO], [DVec3::ZERO; 2]].map(|d| sight.own_axes(d, 0.0)), 0.0)
            }
        };
        let own_reach = ((margin + radius) * f64::from(1.0 + gamma(8))) as f32;
        Self {
            shape,
            outline,
            placement: *placement,
            margin,
            magnitude: tree.magnitude(),
            own,
            own_reach_squared: f32x4::splat(own_reach * own_reach),
            boxes: sight.intervals(|i| axes[i]),
            kdops: None,
        }
    }

    /// The distance up to which triangles are found.
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Bit k: child k's box comes within the margin along the axes of the tree, and of the outline
    /// on all its own axes together: these are at right angles, so the gaps along them add up as
    /// sides of a box do.
    #[inline(always)]
    pub(super) fn boxes_meet(&self, children: &Children<'_, AXES>) -> u32 {
        let boxes = &children.boxes;
        let mut meets = self.boxes.meet(boxes, 0, 1) & self.boxes.meet(boxes, 2, 2);
        if meets.to_bitmask() == 0 {
            return 0;
        }
        let centre = each(|axis| Inner.spread(&boxes.centre[axis]));
        let extent = each(|axis| Inner.spread(&boxes.extent[axis]));
        let [gap1, gap2] = [0, 1].map(|pair| {
            let own = &self.own[pair];
            let gap = (dot(own.direction, centre) - own.middle).abs();
            let reach = dot(own.magnitude, extent) + own.half;
            f32x4::ZERO.fast_max(gap - reach)
        });
        let [a, b, c, d] = (gap1 * gap1 + gap2 * gap2).to_array();
        meets &= f32x4::new([a + c, b + d, a + c, b + d]).simd_le(self.own_reach_squared);
        both_halves(meets)
    }
}

impl<S: Convex, const AXES: usize> Probe<'_, S, AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// Bit k: child k's k-DOP comes within the margin, along the slabs that its box does not have.
    #[inline(always)]
    pub(super) fn kdops_meet(&mut self, kdops: &Intervals<'_, AXES>) -> u32 {
        let slabs = self.slabs();
        let mut meets = f32x4::splat(f32::from_bits(u32::MAX));
        for slab in (3..AXES).step_by(2) {
            meets &= slabs.meet(kdops, slab, (slab + 1).min(AXES - 1));
        }
        both_halves(meets)
    }

    fn slabs(&mut self) -> &ShapeIntervals<AXES> {
        let sight = Sight {
            shape: self.shape,
            placement: &self.placement,
            margin: self.margin,
            magnitude: f64::from(self.magnitude),
        };
        self.kdops.get_or_insert_with(|| {
            let directions = <Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS;
            sight.intervals(|slab| directions[slab].as_dvec3())
        })
    }
}

impl<const COUNT: usize> ShapeIntervals<COUNT> {
    /// The test along two directions, in lanes `i`, `i`, `j`, `j`.
    #[inline(always)]
    fn meet(&self, nodes: &Intervals<'_, COUNT>, i: usize, j: usize) -> f32x4 {
        let pair = |values: &[PerChild; COUNT]| {
            let ([a, b], [c, d]) = (values[i], values[j]);
            f32x4::new([a, b, c, d])
        };
        let own = |x: &[f32; COUNT]| f32x4::new([x[i], x[i], x[j], x[j]]);
        let gap = pair(nodes.centre) - own(&self.middle);
        gap.abs().simd_le(pair(nodes.extent) + own(&self.half))
    }
}

/// Where both halves of the lanes are true.
#[inline(always)]
fn both_halves(lanes: f32x4) -> u32 {
    let bits = lanes.to_bitmask();
    bits & bits >> 2 & 0b11
}

/// A shape, seen from a tree.
struct Sight<'a, S> {
    shape: &'a S,
    placement: &'a Placement,
    margin: f64,
    magnitude: f64,
}

impl<S: Convex> Sight<'_, S> {
    /// Along directions of the tree's frame.
    fn intervals<const COUNT: usize>(
        &self,
        direction: impl Fn(usize) -> DVec3,
    ) -> ShapeIntervals<COUNT> {
        let to_shape = self.placement.inverse.transpose();
        let mut intervals = ShapeIntervals { middle: [0.0; COUNT], half: [0.0; COUNT] };
        for i in 0..COUNT {
            let n = direction(i);
            let interval = self.interval(n, to_shape * n, self.margin);
            (intervals.middle[i], intervals.half[i]) = interval;
        }
        intervals
    }

    /// Along two directions of the shape's frame, of length 1 or none, without the margin and a
    /// radius.
    fn own_axes(&self, [d1, d2]: [DVec3; 2], radius: f64) -> OwnAxes {
        let to_tree = self.placement.rotation.transpose();
        let (n1, n2) = (to_tree * d1, to_tree * d2);
        let lanes = |a: f32, b: f32| f32x4::new([a, a, b, b]);
        let axis = |i: usize| (n1[i] as f32, n2[i] as f32);
        let [(middle1, half1), (middle2, half2)] =
            [(n1, d1), (n2, d2)].map(|(n, d)| self.interval(n, d, -radius));
        OwnAxes {
            direction: each(|i| lanes(axis(i).0, axis(i).1)),
            magnitude: each(|i| lanes(axis(i).0.abs(), axis(i).1.abs())),
            middle: lanes(middle1, middle2),
            half: lanes(half1, half2),
        }
    }

    /// Middle and half-length of the shape's interval along `n`, in the tree's frame, which is `d`
    /// in the shape's: `n·x` is `d·y - d·t` for a point `x` of the tree that is `y = R x + t`
    /// there. It is `growth` longer on each side.
    fn interval(&self, n: DVec3, d: DVec3, growth: f64) -> (f32, f32) {
        if d == DVec3::ZERO {
            return (0.0, 0.0);
        }
        let offset = d.dot(self.placement.translation);
        let growth = growth * d.length();
        let extent = n.abs().element_sum() * self.magnitude;
        if !extent.is_finite() {
            return (f32::NAN, f32::NAN);
        }
        let limit = 4.0 * extent + f64::from(f32::MIN_POSITIVE);
        // A NaN stays one, and passes no test.
        let low = (-self.shape.reach(-d) - offset - growth).clamp(-limit, limit);
        let high = (self.shape.reach(d) - offset + growth).clamp(-limit, limit);
        let rounding = f64::from(gamma(32)) * extent + f64::from(f32::MIN_POSITIVE);
        ((0.5 * (low + high)) as f32, (0.5 * (high - low) + rounding) as f32)
    }
}
