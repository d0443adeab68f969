//! Memory of a query for places where many triangles meet.

use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use glamx::DVec3;
use rustc_hash::FxHashMap;

use super::crowd::Crowd;
use super::slopes::LONG;

/// Answers by key, which threads share.
struct Memo<K, V>(Mutex<FxHashMap<K, V>>);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, V: Clone> Memo<K, V> {
    /// Returns the known answer of a key, or calls `find`. Keeps answers that took more than [`LONG`]
    /// triangles.
    fn answer(memo: Option<&Self>, key: K, find: impl FnOnce() -> (V, usize)) -> V {
        let known = memo.and_then(|memo| memo.get(&key));
        known.unwrap_or_else(|| {
            let (value, count) = find();
            memo.filter(|_| count > LONG).inspect(|memo| memo.insert(key, value.clone()));
            value
        })
    }

    fn get(&self, key: &K) -> Option<V> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
    }

    fn insert(&self, key: K, value: V) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, value);
    }
}

/// Crowds and borders, by one-ring and place. All contacts there ask for the same. Also walls within bodies, by triangle:
/// many rays meet the same walls. For one query.
#[derive(Default)]
pub struct PlaceMemo {
    /// The least half-edge of a long one-ring, by half-edge.
    rings: Memo<u32, u32>,
    crowds: Memo<((u32, bool), PlaceKey), Arc<Crowd>>,
    borders: Memo<(u32, PlaceKey), bool>,
    walls: Memo<u32, (bool, i64)>,
}

impl PlaceMemo {
    /// Number of all short one-rings. Very many may be at one place, and share their answers.
    pub(super) const SHORT: u32 = u32::MAX;

    /// Returns the least half-edge of a long one-ring, if known.
    pub(super) fn first_of_ring(&self, half_edge: u32) -> Option<u32> {
        self.rings.get(&half_edge)
    }

    /// Keeps the least half-edge of a long one-ring.
    pub(super) fn keep_ring(&self, ring: Vec<u32>, first: u32) {
        ring.into_iter().for_each(|half_edge| self.rings.insert(half_edge, first));
    }

    /// Returns a crowd, if known. `ring` has a number of the one-ring, and whether the triangle is of a solid.
    pub(super) fn crowd(&self, ring: (u32, bool), place: DVec3) -> Option<Arc<Crowd>> {
        self.crowds.get(&(ring, key(place)))
    }

    /// Keeps a crowd.
    pub(super) fn keep_crowd(&self, ring: (u32, bool), place: DVec3, crowd: Crowd) {
        self.crowds.insert((ring, key(place)), Arc::new(crowd));
    }

    /// Returns true if a surface ends at a place. Keeps results for which `find` has looked at many
    /// triangles. `ring` is a number of the one-ring.
    pub(super) fn is_border(
        memo: Option<&Self>,
        ring: u32,
        place: DVec3,
        find: impl FnOnce() -> (bool, usize),
    ) -> bool {
        Memo::answer(memo.map(|memo| &memo.borders), (ring, key(place)), find)
    }

    /// Returns true if a triangle is a wall within a body, and the work of finding out.
    pub(super) fn is_wall(&self, triangle: u32, find: impl FnOnce() -> (bool, i64)) -> (bool, i64) {
        Memo::answer(Some(&self.walls), triangle, || (find(), usize::MAX))
    }
}

/// A place as a key.
type PlaceKey = [u64; 3];

fn key(place: DVec3) -> PlaceKey {
    // Minus zero is zero.
    (place + 0.0).to_array().map(f64::to_bits)
}
