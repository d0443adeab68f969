use std::hash::Hash;

use rustc_hash::FxHashMap;

/// Disjoint sets of values.
///
/// The least value of a set represents it.
///
/// ```
/// use sbbk_core::collections::UnionFind;
///
/// let mut sets = UnionFind::default();
/// sets.join(3, 7);
/// sets.join(9, 7);
/// assert_eq!([3, 7, 9, 5].map(|value| sets.first(value)), [3, 3, 3, 5]);
/// ```
#[derive(Clone, Debug)]
pub struct UnionFind<T> {
    /// Another value of the same set, nearer to its representative, or the value itself.
    above: FxHashMap<T, T>,
}

impl<T> Default for UnionFind<T> {
    fn default() -> Self {
        Self { above: FxHashMap::default() }
    }
}

impl<T: Copy + Ord + Hash> UnionFind<T> {
    /// Makes every value a set of its own. Keeps the memory.
    pub fn clear(&mut self) {
        self.above.clear();
    }

    /// Joins the sets of two values.
    pub fn join(&mut self, one: T, other: T) {
        let [one, other] = [one, other].map(|value| self.first(value));
        self.above.insert(one.max(other), one.min(other));
    }

    /// Returns the least value of the set of a value. Takes nearly constant time.
    pub fn first(&mut self, mut value: T) -> T {
        loop {
            let above = *self.above.entry(value).or_insert(value);
            if above == value {
                return value;
            }
            let next = *self.above.get(&above).unwrap_or(&above);
            self.above.insert(value, next);
            value = above;
        }
    }
}
