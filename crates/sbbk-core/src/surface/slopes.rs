//! Slopes of a surface around a point: how far it rises towards a direction, and bends.

use std::hash::Hash;
use std::sync::{Mutex, PoisonError};

use glamx::DVec3;
use rustc_hash::FxHashMap;

/// Rise of a neighbour in bends of the surface, as it bends on both sides of a triangle. Higher: blunt
/// edges stop bodies. Lower: a polyhedron that rolls meets the next vertex late and is braked.
pub(super) const BENDS: f64 = 2.0;

/// Sine of the angle by which a neighbour may rise towards a direction and still count as no nearer,
/// where the surface bends as much. Higher: bodies catch on edges between facets. Lower: faces that
/// lie on each other, not quite flat, lose contacts.
pub(super) const RISE: f64 = 0.05;

/// [`RISE`] if the other feature is a face. Higher: blunt edges stop bodies that slide over
/// them. Lower: a body that rocks from point to point gets the next point too late.
pub(super) const RISE_TO_FACE: f64 = 0.3;

/// Sine of the angle up to which triangles count as one plane, and directions as parallel to it.
/// Higher: a nut locks on its bolt. Lower: flat sides end at rounding.
pub(super) const FLAT: f64 = 1.0e-3;

/// Triangles of a one-ring beyond which its [`Slopes`] are looked up by place and direction. Higher: fans
/// take longer. Lower: ordinary vertices do.
pub(super) const LONG: usize = 32;

/// The surface around a point, seen along a direction.
#[derive(Clone, Copy, Default)]
pub(super) struct Slopes {
    /// Greatest slope towards the direction, as the square of a sine.
    pub(super) rise: f64,
    /// Height of the direction along the [pseudo-normal](Heights) out of the body.
    pub(super) height: f64,
    /// The bend of a long one-ring: twice that from its mean plane.
    pub(super) bend: Option<Bend>,
}

impl Slopes {
    /// Takes note of the way to a corner.
    #[inline(always)]
    pub(super) fn add(&mut self, edge: DVec3, direction: DVec3) {
        let height = edge.dot(direction);
        if height > 0.0 {
            self.rise = self.rise.max(height * height / edge.length_squared());
        }
    }
}

/// Greatest slope out of the plane of a triangle, as the square of a sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    normal: DVec3,
    square: f64,
}

impl From<DVec3> for Bend {
    /// A triangle without an area has no plane to bend from.
    fn from(normal: DVec3) -> Self {
        Self { normal, square: if normal == DVec3::ZERO { f64::INFINITY } else { 0.0 } }
    }
}

impl Bend {
    /// Takes note of the way to a corner.
    #[inline(always)]
    pub(super) fn add(&mut self, edge: DVec3) {
        let off = edge.dot(self.normal);
        let square = off * off / (edge.length_squared() * self.normal.length_squared());
        self.square = self.square.max(square);
    }

    /// Returns twice the bend.
    pub(super) fn doubled(self) -> Self {
        Self { square: 4.0 * self.square, ..self }
    }

    /// True if a surface rises more than it bends, at most by `most`. A flat place is no feature.
    pub(super) fn is_exceeded(&self, rise: f64, most: f64) -> bool {
        rise > (BENDS * BENDS * self.square).clamp(FLAT * FLAT, most * most)
    }
}

/// Answers by key, which threads share.
struct Memo<K, V>(Mutex<FxHashMap<K, V>>);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, V: Copy> Memo<K, V> {
    /// Returns the known answer of a key, or that of `find`. Keeps answers that took more than [`LONG`]
    /// triangles.
    fn answer(memo: Option<&Self>, key: K, find: impl FnOnce() -> (V, usize)) -> V {
        let known = memo.and_then(|memo| memo.get(&key));
        known.unwrap_or_else(|| {
            let (value, count) = find();
            memo.filter(|_| count > LONG).inspect(|memo| memo.insert(key, value));
            value
        })
    }

    fn get(&self, key: &K) -> Option<V> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(key).copied()
    }

    fn insert(&self, key: K, value: V) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, value);
    }
}

/// Slopes at places where many triangles meet, or touch without a common edge, by one-ring, place and direction,
/// and borders by one-ring and place. All contacts there ask for the same. Also walls within bodies, by triangle:
/// many rays meet the same walls. For one query.
#[derive(Default)]
pub struct PlaceMemo {
    /// The least half-edge of a long one-ring, by half-edge.
    rings: Memo<u32, u32>,
    slopes: Memo<((u32, bool), [i64; 6]), Slopes>,
    borders: Memo<(u32, [u64; 3]), bool>,
    walls: Memo<u32, (bool, i64)>,
}

impl PlaceMemo {
    /// Number of all short one-rings. Very many may be at one place, and share their answers.
    pub(super) const SHORT: u32 = u32::MAX;

    /// Steps of a direction. Rounding makes the directions of contacts at one place differ by less.
    const STEPS: f64 = (1_u64 << 30) as f64;

    /// Returns the least half-edge of a long one-ring, if known.
    pub(super) fn first_of_ring(&self, half_edge: u32) -> Option<u32> {
        self.rings.get(&half_edge)
    }

    /// Keeps the least half-edge of a long one-ring.
    pub(super) fn keep_ring(&self, ring: Vec<u32>, first: u32) {
        ring.into_iter().for_each(|half_edge| self.rings.insert(half_edge, first));
    }

    /// Returns the slopes at a place along a direction, which is rounded. Keeps those for which `find` has
    /// looked at many triangles. `ring` has a number of the one-ring, and whether the triangle is of a solid.
    pub(super) fn slopes(
        memo: Option<&Self>,
        ring: (u32, bool),
        place: DVec3,
        direction: DVec3,
        find: impl FnOnce(DVec3) -> (Slopes, usize),
    ) -> Slopes {
        let (key, direction) = Self::key(place, direction);
        Memo::answer(memo.map(|memo| &memo.slopes), (ring, key), || find(direction))
    }

    /// Returns true if a surface ends at a place. Keeps results for which `find` has looked at many
    /// triangles. `ring` is a number of the one-ring.
    pub(super) fn is_border(
        memo: Option<&Self>,
        ring: u32,
        place: DVec3,
        find: impl FnOnce() -> (bool, usize),
    ) -> bool {
        let key = (ring, (place + 0.0).to_array().map(f64::to_bits));
        Memo::answer(memo.map(|memo| &memo.borders), key, find)
    }

    /// Returns true if a triangle is a wall within a body, and the work of finding out.
    pub(super) fn is_wall(&self, triangle: u32, find: impl FnOnce() -> (bool, i64)) -> (bool, i64) {
        Memo::answer(Some(&self.walls), triangle, || (find(), usize::MAX))
    }

    /// Returns the key of a place and a direction, and the rounded direction.
    fn key(place: DVec3, direction: DVec3) -> ([i64; 6], DVec3) {
        let rounded = (direction * Self::STEPS).round();
        let [x, y, z] = (place + 0.0).to_array().map(|x| x.to_bits() as i64);
        let [u, v, w] = rounded.to_array().map(|x| x as i64);
        ([x, y, z, u, v, w], rounded / Self::STEPS)
    }
}

/// Height of a direction along the pseudo-normal of a point: the sum of the normals there, weighted by angles. The height is
/// negative if the direction leads to a point in the solid to which the place is nearest. Areas as weights would fail at acute corners.
///
/// Source: Bærentzen and Aanæs, *Signed Distance Computation Using the Angle Weighted Pseudonormal*, 2005.
#[derive(Default)]
pub(super) struct Heights {
    sum: f64,
    size: f64,
}

impl Heights {
    /// Share of the terms below which a sum is zero: directions are rounded.
    const ROUNDING: f64 = 1.0e-8;

    /// Adds a triangle by its area vector, and the angle that the triangle has at the point.
    pub(super) fn add(&mut self, area: DVec3, angle: f64, direction: DVec3) {
        self.sum += angle * area.normalize_or_zero().dot(direction);
        self.size += angle;
    }

    pub(super) fn sum(&self) -> f64 {
        if self.sum.abs() <= Self::ROUNDING * self.size { 0.0 } else { self.sum }
    }
}

/// Returns the angle between two vectors.
pub(super) fn angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}

/// The signs of heights of a direction along the normals of triangles.
#[derive(Default)]
pub(super) struct Signs {
    low: f64,
    high: f64,
}

impl Signs {
    #[inline(always)]
    pub(super) fn add(&mut self, height: f64) {
        self.low = self.low.min(height);
        self.high = self.high.max(height);
    }

    /// Returns true if the direction leads behind all triangles, false if behind none, else `None`.
    pub(super) fn lead_in(&self) -> Option<bool> {
        (self.low >= 0.0 || self.high <= 0.0).then_some(self.low < 0.0)
    }
}
