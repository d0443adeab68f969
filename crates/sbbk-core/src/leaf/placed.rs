//! The triangles of a leaf, transformed to another frame once, against triangles there that come
//! one at a time.
//!
//! # Rounding
//!
//! [`separation`](super::separation) gives the bounds. Coordinates are relative to an origin near
//! the mesh, so that the test is as sharp far from the middle of a wide terrain. Subtracting the
//! origin rounds once more: `γ_18` for `γ_16`. `M1` is the size of the one triangle.

use glamx::{DVec3, Vec3};

use super::separation::{Corners, LeafFrame, apart};
use super::{splat, used};
use crate::simd::each;
use crate::traverse::Placement;
use crate::tree::LeafBatch;
use crate::volumes::rounding::gamma;

/// Tests leaves of a tree against triangles of another frame. Made once a query.
#[derive(Copy, Clone)]
pub(crate) struct PlacedTest {
    frame: LeafFrame,
    origin: Vec3,
    margin: f32,
    /// `T + 2·s·M2`.
    size2: f32,
}

/// A leaf, placed.
pub(crate) struct PlacedBatch<'a> {
    test: &'a PlacedTest,
    corners: Corners,
    used: u32,
}

impl PlacedTest {
    /// For a tree with coordinates up to `magnitude`, at `placement`, around `centre` of its own
    /// frame.
    pub(crate) fn new(placement: &Placement, centre: Vec3, magnitude: f32, margin: f32) -> Self {
        let origin = placement.to_frame1(centre, Vec3::ZERO).as_vec3();
        let translation: DVec3 = placement.translation - origin.as_dvec3();
        let local = Placement { translation, ..*placement };
        let size2 = translation.abs().max_element() as f32 + 2.0 * local.scale() as f32 * magnitude;
        Self { frame: LeafFrame::at(&local), origin, margin, size2 }
    }

    /// Places a leaf.
    #[inline]
    pub(crate) fn place(&self, batch: &LeafBatch) -> PlacedBatch<'_> {
        let corners = Corners::from_frame2(&self.frame, batch.lanes());
        PlacedBatch { test: self, corners, used: used(batch) }
    }
}

impl PlacedBatch<'_> {
    /// The triangles of the leaf, as bits, that no axis separates from `triangle` by more than the
    /// margin.
    #[inline]
    pub(crate) fn near(&self, triangle: &[Vec3; 3]) -> u32 {
        let PlacedTest { frame, origin, margin, size2 } = self.test;
        let corners = each(|i| triangle[i] - origin);
        let size1 = corners[0].abs().max(corners[1].abs()).max(corners[2].abs()).max_element();
        let frame = frame.with_margin(*margin, gamma(18) * (size1 + size2));
        let one = Corners::new(splat(|corner, axis| corners[corner][axis]));
        !apart(&frame, &one, &self.corners).to_bitmask() & self.used
    }
}
