//! The SBBK paper's sphere stage for a whole world: all pairs of moving objects whose bounding
//! spheres and bounding boxes come within a margin.
//!
//! Here to reproduce the paper, and for users of bare trees. Rapier uses its own broad phase.
//!
//! ```
//! use glamx::Vec3;
//! use sbbk_core::broad_phase::{Bounds, BroadPhase};
//!
//! let unit_ball = |x: f32| {
//!     let centre = Vec3::new(x, 0.0, 0.0);
//!     Bounds { centre, radius: 1.0, min: centre - 1.0, max: centre + 1.0 }
//! };
//! let mut broad_phase = BroadPhase::new(0.02);
//! assert!(broad_phase.pairs(&[unit_ball(0.0), unit_ball(5.0)]).is_empty());
//! assert_eq!(broad_phase.pairs(&[unit_ball(0.0), unit_ball(2.01)]), [[0, 1]]);
//! ```
//!
//! # The test in f32 misses no pair
//!
//! **Boxes.** The gap on an axis is `min₂ − max₁`, so it is at most the margin `m` exactly when
//! `min₂ ≤ max₁ + m`. Each box therefore gets the margin on its upper sides. Rounding is monotonic
//! and `min₂` is a float: `min₂ ≤ max₁ + m` implies `min₂ ≤ fl(max₁ + m)`, overflow included.
//!
//! **Spheres.** Let `D` be the distance of the centres, `S = r₁ + r₂ + m`, both in real
//! arithmetic, and `u = 2⁻²⁴`. Half the margin goes on each radius. Without underflow
//!
//! * `fl(D²) ≤ D² (1 + u)⁵`: difference, product and two sums, the difference counted twice;
//! * `s = fl(fl(r₁ + m/2) + fl(r₂ + m/2)) ≥ S (1 − u)²`, so `fl(s²) ≥ S² (1 − u)⁵`;
//! * `fl(fl(s² K) + A) ≥ S² K (1 − u)⁷` for any `A ≥ 0`.
//!
//! So `D ≤ S` passes `fl(D²) ≤ fl(fl(s² K) + A)` if `K ≥ (1 + u)⁵ / (1 − u)⁷ = 1 + 12 u + O(u²)`;
//! `K = 1 + 16 u` is the next float with room for the `O(u²)`. Underflow costs at most 2⁻¹⁵⁰ for
//! each of the three squares of `D²` and for `s²` and `s² K`, together less than 2⁻¹⁴⁷. Half a
//! subnormal margin costs at most 2⁻¹⁵⁰ on a radius. `A = 2⁻¹²⁶` covers all of this. Overflow is
//! monotonic, and `∞ ≤ ∞` passes. In the other direction a pair that passes has `D ≤ S (1 + 16 u) +
//! 2⁻⁶²`.

mod lanes;
mod tree;

use glamx::Vec3;

use crate::volumes::Aabb;
use tree::BlockTree;

/// `K` of the module's derivation, a factor on a squared distance. Lower: pairs are missed by
/// rounding; higher: more false pairs.
const RELATIVE_SLACK: f32 = 1.0 + 8.0 * f32::EPSILON;

/// `A` of the module's derivation, a squared length. Lower: pairs are missed by underflow; higher:
/// more false pairs.
const ABSOLUTE_SLACK: f32 = f32::MIN_POSITIVE;

/// Bounding sphere and axis-aligned bounding box of one object, in the world frame.
///
/// Each must contain the object, and a pair must pass both. Round them outward: a broad phase takes
/// these numbers as exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Centre of the sphere.
    pub centre: Vec3,
    /// Radius of the sphere, at least 0.
    pub radius: f32,
    /// Lower corner of the box.
    pub min: Vec3,
    /// Upper corner of the box.
    pub max: Vec3,
}

impl Bounds {
    /// Returns true if the gap between the spheres, and the gap between the boxes on each axis, are
    /// at most `margin`. False where a number is NaN.
    ///
    /// [`BroadPhase`] computes exactly this. It misses no pair by rounding, and takes spheres up to
    /// 2⁻²⁰ of the sum of radii and margin too far apart.
    pub fn is_pair_with(&self, other: &Self, margin: f32) -> bool {
        let (one, two) = (self.widened(margin), other.widened(margin));
        // The test of the tree, for one pair.
        one.min.cmple(two.max).all() && two.min.cmple(one.max).all() && one.spheres_overlap(&two)
    }

    /// Returns these bounds, widened by the margin. A pair is then an overlap, touching included.
    fn widened(mut self, margin: f32) -> Self {
        self.max += margin;
        self.radius += 0.5 * margin;
        self
    }

    fn aabb(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }

    fn spheres_overlap(&self, other: &Self) -> bool {
        let Vec3 { x, y, z } = self.centre - other.centre;
        let reach = self.radius + other.radius;
        x * x + y * y + z * z <= reach * reach * RELATIVE_SLACK + ABSOLUTE_SLACK
    }
}

/// Finds all pairs among moving objects; see [the module](self) for an example.
#[derive(Clone, Debug)]
pub struct BroadPhase {
    margin: f32,
    /// Widened.
    reaches: Vec<Bounds>,
    /// Objects whose bounds differ from those of the last step.
    changed: Vec<bool>,
    tree: BlockTree,
    pairs: Vec<[u32; 2]>,
}

impl BroadPhase {
    /// A broad phase without objects. `margin` is the largest gap between two objects of a pair:
    /// the prediction distance of the narrow phase that follows.
    pub fn new(margin: f32) -> Self {
        let (reaches, changed, pairs) = Default::default();
        Self { margin, reaches, changed, tree: BlockTree::default(), pairs }
    }

    /// Returns the pairs of objects with these bounds, as indices into `bounds`, the lower first.
    ///
    /// Call it once a step with the same objects in the same order: it only tests what moved. The
    /// order of the pairs depends on earlier steps. Steps of equally many objects and pairs
    /// allocate nothing.
    pub fn pairs(&mut self, bounds: &[Bounds]) -> &[[u32; 2]] {
        let is_new = bounds.len() != self.reaches.len();
        let reaches = bounds.iter().map(|bounds| bounds.widened(self.margin));
        if is_new {
            self.reaches.clear();
            self.reaches.extend(reaches);
            self.changed.clear();
            self.changed.resize(bounds.len(), true);
            self.pairs.clear();
        } else {
            for (object, reach) in reaches.enumerate() {
                self.changed[object] = reach != self.reaches[object];
                if self.changed[object] {
                    self.reaches[object] = reach;
                    self.tree.update(object, &reach.aabb());
                }
            }
            let changed = &self.changed;
            self.pairs.retain(|pair| !pair.iter().any(|&object| changed[object as usize]));
        }
        if is_new || self.tree.refit() {
            self.tree.pack(&self.reaches, &self.changed);
        }
        let (reaches, pairs) = (&self.reaches, &mut self.pairs);
        self.tree.take_pairs(|one, other| {
            if reaches[one as usize].spheres_overlap(&reaches[other as usize]) {
                pairs.push([one.min(other), one.max(other)]);
            }
        });
        &self.pairs
    }
}
