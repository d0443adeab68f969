use std::num::NonZeroU32;

/// A pair of subshapes that may come within the prediction distance.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Candidate<H> {
    /// Their numbers in shape 1 and shape 2.
    pub(super) subshapes: [u32; 2],
    /// Where the last query left their manifold in the host's list.
    pub(super) place: Option<Place>,
    /// A lower bound of the distance when it was last measured, plus the travel of the pair then.
    /// Minus the present travel, it bounds the present distance.
    pub(super) clear: f64,
    /// What makes the next query about it cheaper. Never part of the answer.
    pub(super) hint: H,
}

/// An index in the host's list of manifolds.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place(NonZeroU32);

impl Place {
    /// `None` for the last of 2³² manifolds, which is then taken for a new one.
    pub(super) fn new(index: usize) -> Option<Self> {
        u32::try_from(index + 1).ok().and_then(NonZeroU32::new).map(Self)
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0.get() as usize - 1
    }
}

impl<H: Default> Candidate<H> {
    /// One of which nothing is known but that it may be near.
    pub(super) fn new(subshapes: [u32; 2]) -> Self {
        Self { subshapes, place: None, clear: f64::NEG_INFINITY, hint: H::default() }
    }
}

/// Adds a candidate of two subshapes, whose manifold is that of another of these, if there is one. Its place
/// in the list: behind those of the descent, whatever that has found.
pub(super) fn push_candidate<H: Default>(
    candidates: &mut Vec<Candidate<H>>,
    subshapes: [u32; 2],
) -> u32 {
    let same = candidates.iter_mut().find(|candidate| candidate.subshapes == subshapes);
    let place = same.and_then(|same| same.place.take());
    candidates.push(Candidate { place, ..Candidate::new(subshapes) });
    candidates.len() as u32 - 1
}
