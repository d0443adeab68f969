//! Memory of a query for places where many triangles meet.

use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use glamx::DVec3;
use rustc_hash::FxHashMap;

use super::crowd::Crowd;
use super::slopes::LONG;

/// Answers by key, which threads share.
pub(super) struct Memo<K, V>(Mutex<FxHashMap<K, V>>);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, V: Clone> Memo<K, V> {
    /// Returns the known answer of a key, or calls `find`. Keeps answers that took more than
    /// [`LONG`] triangles.
    pub(super) fn answer(memo: Option<&Self>, key: K, find: impl FnOnce() -> (V, usize)) -> V {
        let known = memo.and_then(|memo| memo.get(&key));
        known.unwrap_or_else(|| {
            let (value, count) = find();
            memo.filter(|_| count > LONG).inspect(|memo| memo.insert(key, value.clone()));
            value
        })
    }

    pub(super) fn get(&self, key: &K) -> Option<V> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
    }

    pub(super) fn insert(&self, key: K, value: V) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(key, value);
    }
}

/// Crowds and borders, by one-ring and place. All contacts there ask for the same. Also walls
/// within bodies, by triangle: many rays meet the same walls. For one query.
#[derive(Default)]
pub struct PlaceMemo {
    /// The least half-edge of a long one-ring, by half-edge.
    pub(super) rings: Memo<u32, u32>,
    /// By a number of the one-ring, and whether the triangle is of a solid.
    pub(super) crowds: Memo<(u32, bool, PlaceKey), Arc<Crowd>>,
    /// True if a surface ends, by a number of the one-ring.
    pub(super) borders: Memo<(u32, PlaceKey), bool>,
    /// True if a triangle is a wall within a body, and the work of finding out.
    pub(super) walls: Memo<u32, (bool, i64)>,
}

impl PlaceMemo {
    /// Number of all short one-rings. Very many may be at one place, and share their answers.
    pub(super) const SHORT: u32 = u32::MAX;
}

/// A place as a key.
pub(super) type PlaceKey = [u64; 3];

pub(super) fn key(place: DVec3) -> PlaceKey {
    // Minus zero is zero.
    (place + 0.0).to_array().map(f64::to_bits)
}
