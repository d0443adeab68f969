//! The current pairs, kept sorted, and the events between two steps.

use super::counting_sort::CountingSort;

/// Two object indices, the lower one first; orders by the first, then by the second.
type IndexPair = [u32; 2];

/// What a step did to a pair of indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    Started,
    Ended,
}

/// Sorted set of index pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct PairSet {
    current: Vec<IndexPair>,
    found: Vec<IndexPair>,
    next: Vec<IndexPair>,
    sort: CountingSort<IndexPair>,
}

impl PairSet {
    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = IndexPair> {
        self.current.iter().copied()
    }

    /// Notes a pair that holds now; [`PairSet::advance`] takes the notes in.
    pub(super) fn note(&mut self, index1: u32, index2: u32) {
        self.found.push([index1.min(index2), index1.max(index2)]);
    }

    /// Replaces all pairs with a changed member by the noted ones, and reports the difference in
    /// ascending order. Each noted pair has a changed member.
    pub(super) fn advance(
        &mut self,
        has_changed: &[bool],
        mut on_change: impl FnMut(Change, IndexPair),
    ) {
        self.sort_found(has_changed.len());
        self.next.clear();
        let mut found = self.found.iter().copied().peekable();
        for &old in &self.current {
            while let Some(new) = found.next_if(|&new| new < old) {
                self.next.push(new);
                on_change(Change::Started, new);
            }
            let may_end = old.iter().any(|&index| has_changed[index as usize]);
            if !may_end || found.next_if_eq(&old).is_some() {
                self.next.push(old);
            } else {
                on_change(Change::Ended, old);
            }
        }
        for new in found {
            self.next.push(new);
            on_change(Change::Started, new);
        }
        self.found.clear();
        std::mem::swap(&mut self.current, &mut self.next);
    }

    /// Two passes over the pairs, or a comparison sort where there are few for so many indices.
    fn sort_found(&mut self, index_limit: usize) {
        if self.found.len() < index_limit / 4 {
            self.found.sort_unstable();
            return;
        }
        for member in [1, 0] {
            self.sort.sort(&mut self.found, index_limit, |pair| pair[member] as usize);
        }
    }
}
