use std::iter::Peekable;
use std::slice::Iter;

use parry3d::query::ContactManifold;

use super::candidates::OrderKey;
use super::state::History;

/// The manifolds of the query before, walked in stock order beside the candidates of this one.
pub(super) struct Previous<'a>(Peekable<Iter<'a, (OrderKey, u32)>>);

impl<'a> Previous<'a> {
    /// Lists the places of `manifolds` by the keys of their subshapes in `places`. They are in order unless somebody else
    /// touched them.
    pub(super) fn new<M, C>(
        manifolds: &[ContactManifold<M, C>],
        key: impl Fn([u32; 2]) -> OrderKey,
        places: &'a mut Vec<(OrderKey, u32)>,
    ) -> Self {
        places.clear();
        places.extend(manifolds.iter().enumerate().map(|(place, manifold)| {
            (key([manifold.subshape1, manifold.subshape2]), place as u32)
        }));
        if !places.is_sorted() {
            places.sort_unstable();
        }
        // Of several manifolds of the same triangles, which nobody should make, the first.
        places.dedup_by_key(|old| old.0);
        Self(places.iter().peekable())
    }

    /// The next manifold, if it comes before `wanted`.
    pub(super) fn next_before(&mut self, wanted: OrderKey) -> Option<(OrderKey, usize)> {
        let &(key, place) = self.0.next_if(|old| old.0 < wanted)?;
        Some((key, place as usize))
    }

    /// The place of the next manifold, if it is that of `wanted`.
    pub(super) fn next_of(&mut self, wanted: OrderKey) -> Option<usize> {
        self.0.next_if(|old| old.0 == wanted).map(|&(_, place)| place as usize)
    }

    /// The place of the manifold of a candidate, if there is one. To be asked in ascending order; manifolds between are
    /// retired.
    pub(super) fn find<M, C, K>(
        &mut self,
        wanted: OrderKey,
        manifolds: &mut [ContactManifold<M, C>],
        history: &mut History<M, C, K>,
    ) -> Option<usize>
    where
        M: Default,
        C: Default + Copy,
        K: Copy,
    {
        while let Some((_, place)) = self.next_before(wanted) {
            history.retire(std::mem::take(&mut manifolds[place]));
        }
        self.next_of(wanted)
    }

    /// Retires the manifolds that are left.
    pub(super) fn retire_rest<M, C, K>(
        self,
        manifolds: &mut [ContactManifold<M, C>],
        history: &mut History<M, C, K>,
    ) where
        M: Default,
        C: Default + Copy,
        K: Copy,
    {
        for &(_, place) in self.0 {
            history.retire(std::mem::take(&mut manifolds[place as usize]));
        }
    }
}
