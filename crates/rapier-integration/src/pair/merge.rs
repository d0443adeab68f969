use std::iter::Peekable;
use std::slice::Iter;

use parry3d::query::ContactManifold;

use super::order::OrderKey;
use super::pool::ManifoldPool;

/// The manifolds of the query before, walked in stock order beside the candidates of this one.
pub(super) struct Previous<'a>(Peekable<Iter<'a, Place>>);

/// The key of a manifold and its index in the host's list.
pub(super) type Place = (OrderKey, u32);

impl<'a> Previous<'a> {
    /// Lists `manifolds` by their keys in `places`. They are in order unless the host moved them.
    pub(super) fn new<M, C>(
        manifolds: &[ContactManifold<M, C>],
        key: impl Fn([u32; 2]) -> OrderKey,
        places: &'a mut Vec<Place>,
    ) -> Self {
        places.clear();
        places.extend(manifolds.iter().enumerate().map(|(place, manifold)| {
            (key([manifold.subshape1, manifold.subshape2]), place as u32)
        }));
        if !places.is_sorted() {
            places.sort_unstable();
        }
        // A host may have copied one.
        places.dedup_by_key(|old| old.0);
        Self(places.iter().peekable())
    }

    /// The index of the manifold of a candidate, if there is one. To be asked in ascending order;
    /// manifolds between are retired.
    #[inline(always)]
    pub(super) fn find<M: Default, C: Default + Copy>(
        &mut self,
        wanted: OrderKey,
        manifolds: &mut [ContactManifold<M, C>],
        pool: &mut ManifoldPool<M, C>,
    ) -> Option<usize> {
        while let Some(&(_, place)) = self.0.next_if(|old| old.0 < wanted) {
            pool.retire(std::mem::take(&mut manifolds[place as usize]));
        }
        self.0.next_if(|old| old.0 == wanted).map(|&(_, place)| place as usize)
    }

    /// Retires the manifolds that are left.
    pub(super) fn retire_rest<M: Default, C: Default + Copy>(
        self,
        manifolds: &mut [ContactManifold<M, C>],
        pool: &mut ManifoldPool<M, C>,
    ) {
        for &(_, place) in self.0 {
            pool.retire(std::mem::take(&mut manifolds[place as usize]));
        }
    }
}
