//! The broad phase itself: objects come, move and go, and a step reports what that did to the
//! pairs.

use thiserror::Error;

use super::block_tree::BlockTree;
use super::bounds::{Bounds, BoundsError, Reach};
use super::handle::{CapacityExceeded, HandleTable, ObjectHandle, StaleHandle};
use super::pairs::{Change, PairSet};

/// Two objects, the one with the lower handle index first.
pub type ObjectPair = [ObjectHandle; 2];

/// What happened to a pair between two steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairEvent {
    /// The two objects have become a pair.
    Started(ObjectPair),
    /// The two objects are no longer a pair: they moved apart, or one of them was removed. The
    /// handle of a removed object is stale.
    Ended(ObjectPair),
}

/// The margin of a broad phase is negative, NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("margin {margin} is not a finite number of at least 0")]
pub struct MarginError {
    /// The margin given.
    pub margin: f32,
}

/// An object cannot be inserted.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum InsertError {
    /// Its bounds are invalid.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// There is no index left for it.
    #[error(transparent)]
    Full(#[from] CapacityExceeded),
}

/// An object cannot be updated; it keeps its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum UpdateError {
    /// The object is not there.
    #[error(transparent)]
    Stale(#[from] StaleHandle),
    /// Its new bounds are invalid.
    #[error("{handle}: {error}")]
    Bounds {
        /// The object.
        handle: ObjectHandle,
        /// What is wrong with the bounds.
        error: BoundsError,
    },
}

/// Finds all pairs among moving objects; see the [module](super) for an example.
///
/// Two objects are a pair when [`Bounds::is_pair_with`] says so, no matter how they came to
/// where they are. Changes take effect at the next [`step`](Self::step).
#[derive(Clone, Debug)]
pub struct BroadPhase {
    margin: f32,
    handles: HandleTable,
    /// By object index, as `has_changed`.
    reaches: Vec<Reach>,
    /// Whether the object was inserted, moved or removed since the last step.
    has_changed: Vec<bool>,
    /// The indices of the objects that `has_changed` marks.
    changed: Vec<u32>,
    tree: BlockTree,
    pairs: PairSet,
}

impl BroadPhase {
    /// An empty broad phase.
    ///
    /// `margin` is the gap up to which two objects count as a pair, in world units: the
    /// prediction distance of the narrow phase that follows.
    pub fn new(margin: f32) -> Result<Self, MarginError> {
        if !(margin.is_finite() && margin >= 0.0) {
            return Err(MarginError { margin });
        }
        Ok(Self {
            margin,
            handles: HandleTable::new(u32::MAX),
            reaches: Vec::new(),
            has_changed: Vec::new(),
            changed: Vec::new(),
            tree: BlockTree::new(),
            pairs: PairSet::default(),
        })
    }

    /// The gap up to which two objects count as a pair.
    pub fn margin(&self) -> f32 {
        self.margin
    }

    /// Count of objects.
    pub fn len(&self) -> usize {
        self.handles.live_count()
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the handle names an object that is still here.
    pub fn contains(&self, handle: ObjectHandle) -> bool {
        self.handles.resolve(handle).is_ok()
    }

    /// Adds an object.
    pub fn insert(&mut self, bounds: &Bounds) -> Result<ObjectHandle, InsertError> {
        bounds.validate()?;
        let handle = self.handles.insert()?;
        let reach = Reach::new(bounds, self.margin);
        if handle.index() == self.reaches.len() {
            self.reaches.push(reach);
            self.has_changed.push(false);
        } else {
            self.reaches[handle.index()] = reach;
        }
        self.mark_changed(handle);
        Ok(handle)
    }

    /// Removes an object. Its handle is stale at once; its pairs end at the next step.
    pub fn remove(&mut self, handle: ObjectHandle) -> Result<(), StaleHandle> {
        self.handles.remove(handle)?;
        self.mark_changed(handle);
        Ok(())
    }

    /// Moves an object, by any distance. Bounds equal to the old ones cost nothing at the step.
    pub fn update(&mut self, handle: ObjectHandle, bounds: &Bounds) -> Result<(), UpdateError> {
        let index = self.handles.resolve(handle)?;
        bounds.validate().map_err(|error| UpdateError::Bounds { handle, error })?;
        let reach = Reach::new(bounds, self.margin);
        if reach != self.reaches[index] {
            self.reaches[index] = reach;
            self.mark_changed(handle);
        }
        Ok(())
    }

    fn mark_changed(&mut self, handle: ObjectHandle) {
        if !std::mem::replace(&mut self.has_changed[handle.index()], true) {
            self.changed.push(handle.index() as u32);
        }
    }

    /// Brings the pairs up to date and reports each that started or ended since the last step,
    /// ordered by handle index, first member first.
    ///
    /// Which events come, and in which order, depends only on the handles and bounds now and at
    /// the last step. Costs time in proportion to the objects and pairs, with a small factor for
    /// those that did not change, and nothing if none did. Allocates only when there are more
    /// objects or pairs than ever before.
    pub fn step(&mut self, mut on_event: impl FnMut(PairEvent)) {
        if self.changed.is_empty() {
            return;
        }
        self.refresh_tree();
        self.tree.take_pairs(|index1, index2| self.pairs.note(index1, index2));
        let handles = &self.handles;
        self.pairs.advance(&self.has_changed, |change, pair| {
            let pair = pair.map(|index| handles.handle(index));
            on_event(match change {
                Change::Started => PairEvent::Started(pair),
                Change::Ended => PairEvent::Ended(pair),
            });
        });
        for index in self.changed.drain(..) {
            self.has_changed[index as usize] = false;
        }
        self.handles.recycle();
    }

    fn refresh_tree(&mut self) {
        let mut has_room = true;
        for index in self.changed.iter().map(|&index| index as usize) {
            if self.handles.is_live(index) {
                has_room &= self.tree.update(index, &self.reaches[index]);
            } else {
                self.tree.remove(index);
            }
        }
        if !has_room || self.tree.refit() {
            let objects = self.handles.live_indices();
            self.tree.pack(objects, &self.reaches, &self.has_changed);
        }
    }

    /// The pairs as of the last step, ordered by handle index, first member first. Objects
    /// removed since are still among them.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = ObjectPair> {
        self.pairs.iter().map(|pair| pair.map(|index| self.handles.handle(index)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::Vec3;

    /// Catches a full table that overwrites an object, or loses one, instead of saying so.
    #[test]
    fn insertion_beyond_the_last_index_is_an_error() {
        let point = Bounds { centre: Vec3::ZERO, radius: 0.0, min: Vec3::ZERO, max: Vec3::ZERO };
        let mut phase =
            BroadPhase { handles: HandleTable::new(2), ..BroadPhase::new(0.0).unwrap() };
        let handles = [(); 2].map(|()| phase.insert(&point).unwrap());
        let full = Err(InsertError::Full(CapacityExceeded { limit: 2 }));
        assert_eq!(phase.insert(&point), full);
        phase.step(|_| ());
        assert!(phase.pairs().eq([handles]));

        phase.remove(handles[0]).unwrap();
        assert_eq!(phase.insert(&point), full);
        phase.step(|_| ());
        assert!(phase.insert(&point).is_ok());
    }
}
