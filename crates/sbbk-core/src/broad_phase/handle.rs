//! Generational handles: a handle kept after its object was removed is an error, never another
//! object.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;

use thiserror::Error;

/// Names one object of a [`BroadPhase`](super::BroadPhase) until that object is removed.
///
/// Handles order by index, then by generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ObjectHandle {
    index: u32,
    generation: u32,
}

impl ObjectHandle {
    /// Position of the object among all objects: below the largest count of objects ever alive
    /// between two steps, hence fit to index a table of the caller's own data.
    ///
    /// An index is given to another object, with the next generation, at the earliest after the
    /// step that follows the removal.
    pub fn index(self) -> usize {
        self.index as usize
    }

    /// How many objects had this index before.
    pub fn generation(self) -> u32 {
        self.generation
    }
}

impl fmt::Display for ObjectHandle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "object {} (generation {})", self.index, self.generation)
    }
}

/// The object of this handle was removed, or the handle comes from another broad phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0} is not in this broad phase: it was removed, or its handle belongs to another one")]
pub struct StaleHandle(pub ObjectHandle);

/// Every index that a handle can hold is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "all {limit} object indices are taken; remove objects and step, or split the world over \
     several broad phases"
)]
pub struct CapacityExceeded {
    /// Count of indices there are.
    pub limit: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    Free,
    Live,
    /// Removed, but named by the last step's pairs until the next step has ended them.
    Leaving,
}

/// Hands out the handles, lowest free index first, so that the indices in use do not depend on
/// the order of past removals.
#[derive(Clone, Debug)]
pub(super) struct HandleTable {
    slots: Vec<Slot>,
    generations: Vec<u32>,
    free: BinaryHeap<Reverse<u32>>,
    leaving: Vec<u32>,
    live_count: usize,
    limit: u32,
}

impl HandleTable {
    /// A table of at most `limit` indices.
    pub(super) fn new(limit: u32) -> Self {
        Self {
            slots: Vec::new(),
            generations: Vec::new(),
            free: BinaryHeap::new(),
            leaving: Vec::new(),
            live_count: 0,
            limit,
        }
    }

    pub(super) fn insert(&mut self) -> Result<ObjectHandle, CapacityExceeded> {
        let index = match self.free.pop() {
            Some(Reverse(index)) => index,
            None if self.slots.len() < self.limit as usize => {
                self.slots.push(Slot::Free);
                self.generations.push(0);
                (self.slots.len() - 1) as u32
            }
            None => return Err(CapacityExceeded { limit: self.limit }),
        };
        self.slots[index as usize] = Slot::Live;
        self.live_count += 1;
        Ok(self.handle(index))
    }

    /// Makes the handle stale at once; its index stays taken until [`HandleTable::recycle`].
    pub(super) fn remove(&mut self, handle: ObjectHandle) -> Result<usize, StaleHandle> {
        let index = self.resolve(handle)?;
        self.slots[index] = Slot::Leaving;
        self.leaving.push(handle.index);
        self.live_count -= 1;
        Ok(index)
    }

    /// Frees the indices of all removed objects. An index whose generations are used up is
    /// never given out again.
    pub(super) fn recycle(&mut self) {
        for index in self.leaving.drain(..) {
            self.slots[index as usize] = Slot::Free;
            if let Some(next) = self.generations[index as usize].checked_add(1) {
                self.generations[index as usize] = next;
                self.free.push(Reverse(index));
            }
        }
    }

    /// The index of a live object.
    pub(super) fn resolve(&self, handle: ObjectHandle) -> Result<usize, StaleHandle> {
        let index = handle.index();
        let is_named = self.slots.get(index) == Some(&Slot::Live)
            && self.generations[index] == handle.generation;
        is_named.then_some(index).ok_or(StaleHandle(handle))
    }

    /// The handle of an object that is live or leaving.
    pub(super) fn handle(&self, index: u32) -> ObjectHandle {
        ObjectHandle { index, generation: self.generations[index as usize] }
    }

    pub(super) fn is_live(&self, index: usize) -> bool {
        self.slots[index] == Slot::Live
    }

    pub(super) fn live_indices(&self) -> impl Iterator<Item = u32> {
        (0..self.slots.len() as u32).filter(|&index| self.is_live(index as usize))
    }

    pub(super) fn live_count(&self) -> usize {
        self.live_count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches an index that wraps around or is handed out twice when the indices run out.
    #[test]
    fn full_table_is_an_error_until_an_index_is_recycled() {
        let mut table = HandleTable::new(2);
        let first = table.insert().unwrap();
        let second = table.insert().unwrap();
        assert_eq!((first.index(), second.index()), (0, 1));
        assert_eq!(table.insert(), Err(CapacityExceeded { limit: 2 }));

        table.remove(first).unwrap();
        assert_eq!(table.insert(), Err(CapacityExceeded { limit: 2 }));
        table.recycle();
        let third = table.insert().unwrap();
        assert_eq!((third.index(), third.generation()), (0, 1));
        assert_eq!(table.resolve(first), Err(StaleHandle(first)));
        assert_eq!(table.live_count(), 2);
    }

    /// Catches a generation that wraps, which would make the very first handle valid again.
    #[test]
    fn index_with_used_up_generations_is_retired() {
        let mut table = HandleTable::new(2);
        let first = table.insert().unwrap();
        table.generations[0] = u32::MAX;
        table.remove(table.handle(0)).unwrap();
        table.recycle();
        assert_eq!(table.insert().unwrap().index(), 1);
        assert_eq!(table.insert(), Err(CapacityExceeded { limit: 2 }));
        assert!(table.resolve(first).is_err());
    }

    /// Catches indices that depend on the order of removal.
    #[test]
    fn lowest_free_index_comes_first() {
        for removal in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let mut table = HandleTable::new(u32::MAX);
            let handles: Vec<_> = (0..4).map(|_| table.insert().unwrap()).collect();
            for index in removal {
                table.remove(handles[index]).unwrap();
            }
            table.recycle();
            let again: Vec<_> = (0..4).map(|_| table.insert().unwrap().index()).collect();
            assert_eq!(again, [0, 1, 2, 4]);
        }
    }
}
