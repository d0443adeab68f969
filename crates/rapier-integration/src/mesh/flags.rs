//! Flags store the results of searches around a triangle in 64 bits. Threads share them.

use std::sync::atomic::{AtomicU64, Ordering};

use sbbk_core::contact::Feature;
use sbbk_core::surface::{MinimumCones, Side};

/// Memory of searches around a triangle: strays of its edges and vertices, its [`Side`], its
/// [`MinimumCones`], and whether it has a front.
#[derive(Debug, Default)]
pub(crate) struct TriangleFlags(AtomicU64);

/// [`Side`] by the number in the flags.
const SIDES: [Side; 4] = [Side::Outer, Side::Turned, Side::Inner, Side::Sheet];

impl TriangleFlags {
    const HAS_SIDE: u64 = 1 << 7;
    const FRONT_IS_SEARCHED: u64 = 1 << 32;
    const HAS_FRONT: u64 = 1 << 33;

    fn bits(feature: Feature) -> [u64; 2] {
        let place = match feature {
            Feature::Edge(i) => i,
            Feature::Vertex(i) => 3 + i,
            Feature::Face => return [0; 2],
        };
        [1 << place, 1 << (8 + place)]
    }

    /// Returns true if an edge or a vertex has no strays; `None` before a search.
    pub(super) fn is_whole(&self, feature: Feature) -> Option<bool> {
        let [is_searched, has_strays] = Self::bits(feature);
        let flags = self.0.load(Ordering::Relaxed);
        (flags & is_searched != 0).then_some(flags & has_strays == 0)
    }

    pub(super) fn side(&self) -> Option<Side> {
        let flags = self.0.load(Ordering::Relaxed);
        (flags & Self::HAS_SIDE != 0).then(|| SIDES[flags as usize >> 14 & 3])
    }

    pub(super) fn set_side(&self, side: Side) {
        self.0.fetch_or(Self::HAS_SIDE | (side as u64) << 14, Ordering::Relaxed);
    }

    /// `None` before a search.
    pub(super) fn has_front(&self) -> Option<bool> {
        let flags = self.0.load(Ordering::Relaxed);
        (flags & Self::FRONT_IS_SEARCHED != 0).then_some(flags & Self::HAS_FRONT != 0)
    }

    pub(super) fn set_front(&self, has_front: bool) {
        let found = if has_front { Self::HAS_FRONT } else { 0 };
        self.0.fetch_or(Self::FRONT_IS_SEARCHED | found, Ordering::Relaxed);
    }

    #[inline]
    pub(super) fn cones(&self) -> Option<MinimumCones> {
        MinimumCones::of_bits((self.0.load(Ordering::Relaxed) >> 16) as u16)
    }

    pub(super) fn set_cones(&self, cones: MinimumCones) {
        self.0.fetch_or(u64::from(cones.bits()) << 16, Ordering::Relaxed);
    }

    pub(super) fn set(&self, feature: Feature, found: bool) {
        let [is_searched, has_strays] = Self::bits(feature);
        self.0.fetch_or(is_searched | if found { has_strays } else { 0 }, Ordering::Relaxed);
    }
}
