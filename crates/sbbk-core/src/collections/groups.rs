use std::hash::Hash;

use rustc_hash::FxHashMap;

/// Things that hang together, as disjoint sets: whatever is joined is in one group.
///
/// ```
/// use sbbk_core::collections::Groups;
///
/// let mut groups = Groups::default();
/// groups.join(3, 7);
/// groups.join(9, 7);
/// assert_eq!([3, 7, 9, 5].map(|thing| groups.first(thing)), [3, 3, 3, 5]);
/// ```
#[derive(Clone, Debug)]
pub struct Groups<T> {
    /// Another one of the same group, nearer to its first, or itself.
    above: FxHashMap<T, T>,
}

impl<T> Default for Groups<T> {
    fn default() -> Self {
        Self { above: FxHashMap::default() }
    }
}

impl<T: Copy + Ord + Hash> Groups<T> {
    /// Parts all that was joined, and keeps the memory.
    pub fn clear(&mut self) {
        self.above.clear();
    }

    /// Makes the groups of two things one.
    pub fn join(&mut self, one: T, other: T) {
        let [one, other] = [one, other].map(|thing| self.first(thing));
        self.above.insert(one.max(other), one.min(other));
    }

    /// The least thing of a group, by one of them. In all but constant time.
    pub fn first(&mut self, mut thing: T) -> T {
        loop {
            let above = *self.above.entry(thing).or_insert(thing);
            if above == thing {
                return thing;
            }
            let next = *self.above.get(&above).unwrap_or(&above);
            self.above.insert(thing, next);
            thing = above;
        }
    }
}
