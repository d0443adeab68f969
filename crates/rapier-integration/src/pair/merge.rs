//! Which manifold of the query before is a candidate's.

use parry3d::query::ContactManifold;
use rustc_hash::FxHashMap;

use super::order::{Candidate, Place};

/// So many are looked through one by one.
const FEW: usize = 16;

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
        if old.is_empty() {
            return;
        }
        let hand_on = |old: &Candidate<H>, candidate: &mut Candidate<H>| {
            candidate.place = old.place;
            if candidate.hint == H::default() {
                candidate.hint = old.hint;
            }
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
