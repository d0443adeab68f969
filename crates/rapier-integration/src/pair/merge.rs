//! Which manifold of the query before is a candidate's.

use parry3d::query::ContactManifold;
use rustc_hash::FxHashMap;

use super::order::{Candidate, Place};
use super::pool::ManifoldPool;

/// So many are looked through one by one.
const FEW: usize = 16;

/// Memory for looking things up by a pair of subshapes.
#[derive(Default)]
pub(super) struct Lookup(FxHashMap<[u32; 2], u32>);

impl Lookup {
    /// Hands on to `new` candidates what is known of those of the same subshapes among `old`: hints and
    /// places.
    pub(super) fn hand_on<H: Copy>(&mut self, old: &[Candidate<H>], new: &mut [Candidate<H>]) {
        if old.is_empty() {
            return;
        }
        let hand_on = |old: &Candidate<H>, candidate: &mut Candidate<H>| {
            (candidate.place, candidate.hint) = (old.place, old.hint);
        };
        if old.len() <= FEW {
            for candidate in new {
                let is_same = |old: &&Candidate<H>| old.subshapes == candidate.subshapes;
                if let Some(old) = old.iter().find(is_same) {
                    hand_on(old, candidate);
                }
            }
            return;
        }
        self.0.clear();
        self.0.extend(old.iter().map(|old| old.subshapes).zip(0..));
        for candidate in new {
            if let Some(&index) = self.0.get(&candidate.subshapes) {
                hand_on(&old[index as usize], candidate);
            }
        }
    }

    /// Makes the places of candidates those of a list that they do not know.
    pub(super) fn find_places<M, C, H>(
        &mut self,
        manifolds: &[ContactManifold<M, C>],
        candidates: &mut [Candidate<H>],
    ) {
        let subshapes = |m: &ContactManifold<M, C>| [m.subshape1, m.subshape2];
        self.0.clear();
        // A host may have copied one: the last copy counts.
        self.0.extend(manifolds.iter().map(subshapes).zip(0..));
        for candidate in candidates {
            let index = self.0.get(&candidate.subshapes);
            candidate.place = index.and_then(|&index| Place::new(index as usize));
        }
    }

    /// How much is kept for later, in entries.
    pub(super) fn shrink_to(&mut self, limit: usize) {
        self.0.shrink_to(limit);
    }
}

/// Whether the manifolds are where the candidates have them. Others may be there besides.
pub(super) fn are_in_place<M, C, H>(
    manifolds: &[ContactManifold<M, C>],
    candidates: &[Candidate<H>],
) -> bool {
    let is_there = |candidate: &Candidate<H>, place: Place| {
        let manifold = manifolds.get(place.index());
        manifold.is_some_and(|m| [m.subshape1, m.subshape2] == candidate.subshapes)
    };
    candidates.iter().all(|candidate| candidate.place.is_none_or(|at| is_there(candidate, at)))
}

/// The manifolds of a query that keeps no candidates, in the order in which contacts are found.
pub(super) struct Merge<'m, M, C> {
    pool: &'m mut ManifoldPool<M, C>,
    manifolds: &'m mut Vec<ContactManifold<M, C>>,
    /// After all places of the host's list that are dealt with: where the next one should be.
    next: usize,
    /// The places of all others of a long list, once one was asked for that was not the next.
    lookup: &'m mut Lookup,
    is_filled: bool,
}

impl<'m, M: Default + 'static, C: Default + Copy + 'static> Merge<'m, M, C> {
    pub(super) fn begin(
        pool: &'m mut ManifoldPool<M, C>,
        manifolds: &'m mut Vec<ContactManifold<M, C>>,
        lookup: &'m mut Lookup,
    ) -> Self {
        Self { pool, manifolds, next: 0, lookup, is_filled: false }
    }

    /// Hands on the manifold of two subshapes, not asked for before in this query, and keeps it if it
    /// has points then.
    #[inline(always)]
    pub(super) fn write(
        &mut self,
        subshapes: [u32; 2],
        write: impl FnOnce(&mut ContactManifold<M, C>),
    ) {
        let is_next =
            self.manifolds.get(self.next).is_some_and(|m| [m.subshape1, m.subshape2] == subshapes);
        let place = if is_next { Some(self.next) } else { self.find(subshapes) };
        if let Some(place) = place {
            self.next = self.next.max(place + 1);
            write(&mut self.manifolds[place]);
            self.pool.keep_old(place, self.manifolds);
        } else {
            let mut manifold = self.pool.take();
            [manifold.subshape1, manifold.subshape2] = subshapes;
            write(&mut manifold);
            if manifold.points.is_empty() {
                self.pool.retire(manifold);
            } else {
                self.pool.keep_new(Some(manifold), self.manifolds);
            }
        }
    }

    #[inline(never)]
    fn find(&mut self, subshapes: [u32; 2]) -> Option<usize> {
        // Those that were kept have been moved and own nothing, or stay where they are.
        let left = self.manifolds.iter().zip(0..).filter(|(m, _)| m.points.capacity() > 0);
        let mut names = left.map(|(m, place)| ([m.subshape1, m.subshape2], place));
        if self.manifolds.len() <= FEW {
            let same = names.find(|(name, _)| *name == subshapes);
            return same.map(|(_, place)| place as usize);
        }
        let Lookup(places) = &mut *self.lookup;
        if !self.is_filled {
            places.clear();
            places.extend(names);
            self.is_filled = true;
        }
        places.get(&subshapes).map(|&place| place as usize)
    }

    /// Ends the query: the host's list is what was added.
    pub(super) fn end(self) {
        let kept = self.pool.in_place();
        for manifold in &mut self.manifolds[kept..] {
            if manifold.points.capacity() > 0 {
                self.pool.retire(std::mem::take(manifold));
            }
        }
        self.pool.end(self.manifolds);
    }
}

#[cfg(test)]
mod tests {
    use oorandom::Rand32;
    use parry3d::math::Vector;
    use parry3d::query::TrackedContact;
    use parry3d::shape::PackedFeatureId;

    use super::*;

    /// Would catch manifolds that are lost, doubled or out of order, and data that is lost or given to
    /// another triangle: of short lists and long ones, also where a host has moved some.
    #[test]
    fn manifolds_keep_their_data_in_the_order_in_which_they_are_asked_for() {
        let mut random = Rand32::new(5);
        let mut pool = ManifoldPool::<u32, ()>::default();
        let mut lookup = Lookup::default();
        let mut manifolds: Vec<ContactManifold<u32, ()>> = Vec::new();
        let mut kept = 0;
        for round in 0..2000 {
            let before: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
            if round % 7 == 0 && !manifolds.is_empty() {
                let count = manifolds.len() as u32;
                manifolds.swap(random.rand_range(0..count) as usize, 0);
            }
            let most = if round % 100 < 50 { 12 } else { 90 };
            let mut merge = Merge::begin(&mut pool, &mut manifolds, &mut lookup);
            let mut expected = Vec::new();
            for name in 0..most {
                let [is_asked, touches] = [(); 2].map(|()| random.rand_float() < 0.9);
                if !is_asked {
                    continue;
                }
                merge.write([name, 0], |manifold| {
                    let is_old = manifold.data == name + 1;
                    assert_eq!(is_old, before.contains(&name), "{name}");
                    kept += usize::from(is_old);
                    manifold.data = name + 1;
                    manifold.points.clear();
                    let (at, id) = (Vector::ZERO, PackedFeatureId::UNKNOWN);
                    let point = TrackedContact::new(at, at, id, id, 0.0);
                    manifold.points.extend(touches.then_some(point));
                });
                expected.extend(touches.then_some(name));
            }
            merge.end();
            let names: Vec<u32> = manifolds.iter().map(|manifold| manifold.subshape1).collect();
            assert_eq!(names, expected);
        }
        assert!(kept > 10_000, "{kept}");
    }
}
