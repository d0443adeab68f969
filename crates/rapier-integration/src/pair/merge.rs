//! Which manifold of the query before is a candidate's.

use parry3d::query::ContactManifold;
use rustc_hash::FxHashMap;

use super::order::{Candidate, Place};

/// Memory for looking things up by a pair of subshapes.
#[derive(Default)]
pub(super) struct Lookup(FxHashMap<[u32; 2], u32>);

impl Lookup {
    /// Hands on to `new` candidates what is known of those of the same subshapes among `old`: hints,
    /// unless they have one, and places.
    pub(super) fn hand_on<H: Copy + Default + PartialEq>(
        &mut self,
        old: &[Candidate<H>],
        new: &mut [Candidate<H>],
    ) {
        let is_known = |old: &Candidate<H>| old.place.is_some() || old.hint != H::default();
        let known = old.iter().zip(0..).filter(|(old, _)| is_known(old));
        self.0.clear();
        self.0.extend(known.map(|(old, index)| (old.subshapes, index)));
        if self.0.is_empty() {
            return;
        }
        for candidate in new {
            let Some(&index) = self.0.get(&candidate.subshapes) else {
                continue;
            };
            let old = old[index as usize];
            candidate.place = old.place;
            if candidate.hint == H::default() {
                candidate.hint = old.hint;
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
