//! Manifolds on their way through a query, and spare ones: a new one costs ten times as much as a used
//! one.

use std::any::Any;
use std::cell::Cell;

use parry3d::query::{ContactManifold, TrackedContact};

use super::outline::{OldPoint, PatchPoint};

/// So many spare manifolds stay with a thread, at some 500 bytes. More serve pairs that lose and gain
/// more contacts at once.
const MOST_SPARE: usize = 256;

thread_local! {
    /// The pool of the last host whose pairs were asked for, if its data has the same types: else a
    /// query makes its own.
    static POOL: Cell<Option<Box<dyn Any>>> = Cell::default();
}

/// The manifolds of a query, and memory that all pairs of a thread share. (With a pool in each pair a
/// pile of 200 heads took 1.6 times as much memory, and its steps 1.1 times as long.)
///
/// As long as no manifold comes or goes, all stay in their place in the host's list: to move one
/// takes as long as to update its distances.
pub(crate) struct ManifoldPool<M, C> {
    /// Length of the prefix of the host's list that stays in place. Zero once `next` is in use;
    /// `next` then holds all that is kept.
    in_place: usize,
    next: Vec<ContactManifold<M, C>>,
    spare: Vec<ContactManifold<M, C>>,
    /// Memory for the points that a manifold had before.
    pub(super) previous_points: Vec<TrackedContact<C>>,
    /// Memory for the points that the patches of a pair had before, and for those that one may have.
    pub(super) old_points: Vec<OldPoint<C>>,
    pub(super) patch_points: Vec<PatchPoint<C>>,
}

/// How much memory to keep: as much as was needed of late. What was not needed for some queries is
/// given back, a quarter at a time.
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct Demand {
    peak: usize,
    /// Queries since as much was needed.
    age: u8,
}

impl Demand {
    /// More: memory is kept longer. Fewer: allocations where contacts come and go.
    const PATIENCE: u8 = 64;

    /// Notes what a query has needed. If it is time to keep less, how much.
    pub(super) fn note(&mut self, needed: usize) -> Option<usize> {
        self.age += 1;
        if needed >= self.peak {
            (self.peak, self.age) = (needed, 0);
        } else if self.age >= Self::PATIENCE {
            (self.peak, self.age) = (needed.max(self.peak - self.peak.div_ceil(4)), 0);
            return Some(self.peak);
        }
        None
    }
}

impl<M, C> Default for ManifoldPool<M, C> {
    fn default() -> Self {
        Self {
            in_place: 0,
            next: Vec::new(),
            spare: Vec::new(),
            previous_points: Vec::new(),
            old_points: Vec::new(),
            patch_points: Vec::new(),
        }
    }
}

impl<M: Default + 'static, C: Default + Copy + 'static> ManifoldPool<M, C> {
    /// The pool of this thread. A query within another makes its own, and one that a panic ends takes
    /// it away.
    pub(super) fn borrow() -> Box<Self> {
        POOL.take().and_then(|pool| pool.downcast().ok()).unwrap_or_default()
    }

    /// Gives it back for the next query.
    pub(super) fn give_back(self: Box<Self>) {
        POOL.set(Some(self));
    }

    /// Gives back memory beyond so many manifolds.
    pub(super) fn shrink_to(&mut self, limit: usize) {
        self.next.shrink_to(limit);
        self.old_points.shrink_to(limit);
        self.patch_points.shrink_to(limit);
    }

    /// Ends the manifolds of a query: `manifolds` become those that were kept.
    pub(super) fn end(&mut self, manifolds: &mut Vec<ContactManifold<M, C>>) {
        manifolds.truncate(std::mem::take(&mut self.in_place));
        manifolds.append(&mut self.next);
    }

    /// How many manifolds at the front of the host's list have stayed there.
    pub(super) fn in_place(&self) -> usize {
        self.in_place
    }

    /// An empty manifold.
    pub(super) fn take(&mut self) -> ContactManifold<M, C> {
        self.spare.pop().unwrap_or_default()
    }

    /// Adds a manifold, if there is one, to those of this query.
    #[inline(always)]
    pub(super) fn keep_new(
        &mut self,
        manifold: Option<ContactManifold<M, C>>,
        manifolds: &mut [ContactManifold<M, C>],
    ) {
        self.leave_place(manifolds);
        self.next.extend(manifold);
    }

    /// Keeps the manifold at `place` of the host's list, if it has points. Whether it has.
    #[inline(always)]
    pub(super) fn keep_old(
        &mut self,
        place: usize,
        manifolds: &mut [ContactManifold<M, C>],
    ) -> bool {
        if manifolds[place].points.is_empty() {
            self.retire(std::mem::take(&mut manifolds[place]));
            return false;
        }
        if self.next.is_empty() && place == self.in_place {
            self.in_place += 1;
        } else {
            self.leave_place(manifolds);
            self.next.push(std::mem::take(&mut manifolds[place]));
        }
        true
    }

    /// From here on the manifolds of this query are in `next`.
    fn leave_place(&mut self, manifolds: &mut [ContactManifold<M, C>]) {
        let stayed = &mut manifolds[..std::mem::take(&mut self.in_place)];
        self.next.extend(stayed.iter_mut().map(std::mem::take));
    }

    /// Takes back a manifold that is no longer used. Only its memory is kept.
    pub(super) fn retire(&mut self, mut manifold: ContactManifold<M, C>) {
        if self.spare.len() < MOST_SPARE {
            reset(&mut manifold);
            self.spare.push(manifold);
        }
    }
}

/// Makes a manifold an empty one, of which only the memory is left.
pub(super) fn reset<M: Default, C>(manifold: &mut ContactManifold<M, C>) {
    manifold.points.clear();
    manifold.set_subshape_pos1(None);
    manifold.set_subshape_pos2(None);
    manifold.local_n1 = Default::default();
    manifold.local_n2 = Default::default();
    manifold.data = M::default();
}

#[cfg(test)]
mod tests {
    use oorandom::Rand32;
    use parry3d::math::{Pose, Vector};
    use parry3d::shape::PackedFeatureId;

    use super::*;

    type Manifold = ContactManifold<(), ()>;

    fn manifold(name: u32, has_points: bool) -> Manifold {
        let mut manifold = Manifold::with_data(name, 0, ());
        let (at, id) = (Vector::ZERO, PackedFeatureId::UNKNOWN);
        manifold.points.extend(has_points.then(|| TrackedContact::new(at, at, id, id, 0.0)));
        manifold
    }

    /// Would catch anything of the pair before in a manifold that is used again.
    #[test]
    fn a_spare_manifold_is_as_a_new_one() {
        let mut pool = ManifoldPool::<u32, ()>::default();
        let mut used = ContactManifold::<u32, ()>::with_data(3, 4, 5);
        (used.local_n1, used.local_n2) = (Vector::X, Vector::Y);
        used.set_subshape_pos1(Some(Pose::IDENTITY));
        used.set_subshape_pos2(Some(Pose::IDENTITY));
        let (at, id) = (Vector::ZERO, PackedFeatureId::UNKNOWN);
        used.points.push(TrackedContact::new(at, at, id, id, 0.0));
        pool.retire(used);
        let spare = pool.take();
        assert!(spare.points.capacity() > 0 && spare.points.is_empty() && spare.data == 0);
        assert_eq!([spare.local_n1, spare.local_n2], [Vector::ZERO; 2]);
        assert!(spare.subshape_pos1().is_none() && spare.subshape_pos2().is_none());
    }

    /// Would catch manifolds that are lost, doubled or out of order when some stay in place, some
    /// go and some are new, and a query before, ended by a panic, that is not over.
    #[test]
    fn what_is_kept_is_there_in_the_order_in_which_it_was_kept() {
        let mut random = Rand32::new(3);
        let mut pool = ManifoldPool::<(), ()>::default();
        let mut manifolds = Vec::new();
        let (mut next_name, mut stayed, mut moved) = (0, 0, 0);
        for _ in 0..3000 {
            let is_lively = random.rand_float() < 0.6;
            let is_cut_off = random.rand_float() < 0.05;
            let mut chance = |share: f32| is_lively && random.rand_float() < share;
            let before: Vec<u32> =
                manifolds.iter().map(|manifold: &Manifold| manifold.subshape1).collect();
            let mut expected = Vec::new();
            for place in 0..manifolds.len() {
                if chance(0.1) {
                    next_name += 1;
                    if chance(0.3) {
                        pool.retire(manifold(next_name, false));
                    } else {
                        pool.keep_new(Some(manifold(next_name, true)), &mut manifolds);
                        expected.push(next_name);
                    }
                }
                let name = manifolds[place].subshape1;
                if chance(0.1) {
                    pool.retire(std::mem::take(&mut manifolds[place]));
                    continue;
                }
                if chance(0.1) {
                    manifolds[place].points.clear();
                } else {
                    expected.push(name);
                }
                pool.keep_old(place, &mut manifolds);
            }
            if is_cut_off {
                // What a panic leaves: no promise which manifolds, and no pool.
                manifolds.clear();
                pool = ManifoldPool::default();
                continue;
            }
            if manifolds.len() < 8 {
                next_name += 1;
                pool.keep_new(Some(manifold(next_name, true)), &mut manifolds);
                expected.push(next_name);
            }
            pool.end(&mut manifolds);
            let names: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
            assert_eq!(names, expected);
            *(if names == before { &mut stayed } else { &mut moved }) += 1;
        }
        assert!(stayed > 300 && moved > 300, "{stayed} stayed, {moved} moved");
    }

    /// Would catch spare manifolds without end, and such as are not empty.
    #[test]
    fn so_many_spare_ones_are_kept() {
        let mut pool = ManifoldPool::<(), ()>::default();
        (0..2 * MOST_SPARE as u32).for_each(|name| pool.retire(manifold(name, true)));
        assert_eq!(pool.spare.len(), MOST_SPARE);
        assert!(pool.take().points.is_empty());
    }
}
