//! Stable counting sort into memory that is kept from call to call.
//!
//! The standard stable sorts allocate, and a comparison sort of a hundred thousand pairs costs
//! more than finding them.

/// Scratch memory of a sort.
#[derive(Clone, Debug)]
pub(super) struct CountingSort<T> {
    sorted: Vec<T>,
    starts: Vec<usize>,
}

impl<T> Default for CountingSort<T> {
    fn default() -> Self {
        Self { sorted: Vec::new(), starts: Vec::new() }
    }
}

impl<T: Copy> CountingSort<T> {
    /// Sorts by `key`, which is below `key_limit`; items with equal keys keep their order.
    ///
    /// Time and scratch memory grow with `items.len() + key_limit`.
    pub(super) fn sort(&mut self, items: &mut Vec<T>, key_limit: usize, key: impl Fn(&T) -> usize) {
        let Some(&first) = items.first() else { return };
        self.starts.clear();
        self.starts.resize(key_limit, 0);
        for item in items.iter() {
            self.starts[key(item)] += 1;
        }
        if self.starts[key(&first)] == items.len() {
            return;
        }
        let mut next_start = 0;
        for start in &mut self.starts {
            next_start += std::mem::replace(start, next_start);
        }
        self.sorted.resize(items.len(), first);
        for item in items.iter() {
            let start = &mut self.starts[key(item)];
            self.sorted[*start] = *item;
            *start += 1;
        }
        std::mem::swap(items, &mut self.sorted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches items lost, out of order, or of equal key swapped; the last would break a sort by
    /// two keys, one after the other.
    #[test]
    fn agrees_with_the_stable_sort_of_the_standard_library() {
        let mut sort = CountingSort::default();
        for (item_count, key_limit) in [(0, 1), (1, 1), (50, 1), (50, 3), (300, 1000), (2, 9)] {
            let key_of = |i: usize| (i * i + 7 * i) % key_limit;
            let mut items: Vec<_> = (0..item_count).map(|i| (key_of(i), i)).collect();
            let mut expected = items.clone();
            expected.sort_by_key(|item| item.0);
            sort.sort(&mut items, key_limit, |item| item.0);
            assert_eq!(items, expected);
        }
    }
}
