//! A union-find, and a compact list of indices.

/// Disjoint sets of indices.
///
/// The least index of a set represents it.
///
/// ```
/// use sbbk_core::collections::UnionFind;
///
/// let mut sets = UnionFind::default();
/// sets.reset(10);
/// sets.join(3, 7);
/// sets.join(9, 7);
/// assert_eq!([3, 7, 9, 5].map(|index| sets.first(index)), [3, 3, 3, 5]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct UnionFind {
    /// Another index of the same set, nearer to its representative, or the index itself.
    above: Vec<usize>,
}

impl UnionFind {
    /// Makes each of some indices a set of its own. Keeps the memory.
    pub fn reset(&mut self, count: usize) {
        self.above.clear();
        self.above.extend(0..count);
    }

    /// Joins the sets of two indices.
    pub fn join(&mut self, one: usize, other: usize) {
        let [one, other] = [one, other].map(|index| self.first(index));
        self.above[one.max(other)] = one.min(other);
    }

    /// Returns the least index of the set of an index. Takes nearly constant time.
    pub fn first(&mut self, mut index: usize) -> usize {
        while self.above[index] != index {
            self.above[index] = self.above[self.above[index]];
            index = self.above[index];
        }
        index
    }
}

const NONE: u32 = u32::MAX;

/// A list of optional indices that are less than its length, in 16 bits each if these are enough.
#[derive(Clone, Debug)]
pub(crate) enum CompactIndices {
    Narrow(Box<[u16]>),
    Wide(Box<[u32]>),
}

impl CompactIndices {
    /// Stores some indices.
    pub(crate) fn new(numbers: impl ExactSizeIterator<Item = Option<u32>>) -> Self {
        // Indices of a list up to this length are less than the low half of `NONE`.
        let is_narrow = numbers.len() <= usize::from(u16::MAX);
        let numbers = numbers.map(|number| number.unwrap_or(NONE));
        if is_narrow {
            Self::Narrow(numbers.map(|number| number as u16).collect())
        } else {
            Self::Wide(numbers.collect())
        }
    }

    /// Returns the index at a place; `None` beyond the end of the list.
    #[inline(always)]
    pub(crate) fn get(&self, place: u32) -> Option<u32> {
        match self {
            Self::Narrow(numbers) => {
                let number = *numbers.get(place as usize)?;
                (number != NONE as u16).then_some(number.into())
            }
            Self::Wide(numbers) => {
                let number = *numbers.get(place as usize)?;
                (number != NONE).then_some(number)
            }
        }
    }

    /// Memory in bytes, without this value.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Narrow(numbers) => size_of_val(&**numbers),
            Self::Wide(numbers) => size_of_val(&**numbers),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a number that is taken for none, or none for a number, where sixteen bits end.
    #[test]
    fn narrow_and_wide_lists_hold_the_same() {
        for length in [0, 1, 2, 65_534, 65_535, 65_536, 65_537, 100_000] {
            let number = |place: u32| (place % 5 != 3).then(|| length - 1 - place);
            let numbers =
                CompactIndices::new((0..length as usize).map(|place| number(place as u32)));
            for place in 0..length {
                assert_eq!(numbers.get(place), number(place), "{place} of {length}");
            }
            assert_eq!(numbers.get(length), None);
            let width = if length < 65_536 { 2 } else { 4 };
            assert_eq!(numbers.bytes(), length as usize * width, "{length}");
        }
    }
}
