//! Contacts of meshes that overlap, after the first pass.

use glamx::DVec3;
use sbbk_core::contact::{ManifoldPoints, contact_along};
use sbbk_core::query::TrianglePair;

use super::TriangleQuery;
use crate::pair::deep::{self, ContourMemory};
use crate::pair::islands::{Crossing, OverlapIslands, Support};
use crate::pair::query::ContactList;
use crate::pair::shapes::{ContactSource, TriangleHit, TriangleSurfaceContact};
use crate::pair::surface::SurfaceFilter;
use crate::pair::ways::{RESTING_DEPTH, SAME_DIRECTION, greatest_overlap};

impl TriangleQuery<'_> {
    /// Ends the first pass. Returns true if a second pass is needed.
    pub(super) fn finish_first_pass(&self, islands: &mut OverlapIslands) -> bool {
        let small = RESTING_DEPTH * self.shapes.filter_distance;
        let is_parted = |pair: [u32; 2], way: DVec3, length: f64| self.is_parted(pair, way, length);
        islands.finish_first_pass(small, is_parted)
    }

    /// Removes contacts apart that a way out of an overlap lifts over their triangles. These are at the height of the overlap.
    pub(super) fn drop_lifted(
        &self,
        ways: &[(DVec3, f64)],
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        contacts.retain(|(pair, TriangleSurfaceContact { contact, .. })| {
            let is_lifted = |(way, depth): &(DVec3, f64)| {
                way.dot(contact.normal) < SAME_DIRECTION && self.is_parted(*pair, *way, *depth)
            };
            contact.distance <= 0.0 || !ways.iter().any(is_lifted)
        });
    }

    /// Adds the contacts of crossing triangles if all contacts are apart, as these do not part the triangles.
    pub(super) fn add_of_crossing(
        &self,
        islands: &OverlapIslands,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        let is_crossing = islands.crossings.iter().any(|crossing| crossing.is_crossing);
        let is_apart = |(_, hit): &TriangleHit| hit.contact.distance > 0.0;
        if is_crossing && !contacts.is_empty() && contacts.iter().all(is_apart) {
            contacts.extend(self.of_overlaps(islands));
            contacts.sort_unstable_by_key(|(pair, _)| *pair);
        }
    }

    /// Returns the contacts of the triangles of all overlaps.
    pub(super) fn of_overlaps(
        &self,
        islands: &OverlapIslands,
    ) -> impl Iterator<Item = TriangleHit> {
        let within = f64::from(self.shapes.pose.prediction);
        islands.overlaps().filter_map(move |pair| self.shapes.nearest_points(pair, within))
    }

    /// Returns true if a way parts two triangles at their height, and both surfaces end there.
    fn is_parted(&self, pair: [u32; 2], way: DVec3, length: f64) -> bool {
        let most = greatest_overlap(length, self.shapes.filter_unit());
        let ends = |filter: &SurfaceFilter<'_>| filter.ends_along(way);
        self.overlap(pair, way).is_some_and(|length| length.abs() <= most)
            && self.shapes.with_filter(pair, ends) == Some(true)
    }

    /// Returns the overlap of two triangles along a direction in which triangle 2 leaves.
    fn overlap(&self, pair: [u32; 2], way: DVec3) -> Option<f64> {
        let heights = self.shapes.local(pair)?.corners.map(|of| of.map(|corner| corner.dot(way)));
        let highest = heights[0].into_iter().fold(f64::NEG_INFINITY, f64::max);
        let lowest = heights[1].into_iter().fold(f64::INFINITY, f64::min);
        Some(highest - lowest)
    }

    /// Replaces the contacts that push the wrong way, and adds contacts to islands that have too few.
    #[inline(never)]
    pub(super) fn second_pass(
        &self,
        islands: &mut OverlapIslands,
        contours: &mut ContourMemory,
        clipped: &mut ManifoldPoints,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        contacts.retain(|(pair, _)| islands.is_final(*pair));
        deep::add_contacts(&self.shapes, islands, contours, contacts);
        contacts.retain(|hit| !deep::pushes_farther(&self.shapes, islands, hit));
        for i in 0..islands.crossings.len() {
            let Some(crossing) = islands.open(i) else { continue };
            let Some(support) = islands.open_support(&crossing) else { continue };
            let contact = self.supporting_contact(&crossing, support, clipped);
            contacts.extend(contact.map(|contact| (crossing.pair, contact)));
        }
        // Contacts of contours come first.
        contacts.sort_unstable_by_key(|(pair, hit)| (*pair, hit.source != ContactSource::PushOut));
        contacts.dedup_by_key(|(pair, _)| *pair);
    }

    /// Returns a contact of a crossing pair, along the way out of its island if there is one.
    fn supporting_contact(
        &self,
        crossing: &Crossing,
        support: Support,
        clipped: &mut ManifoldPoints,
    ) -> Option<TriangleSurfaceContact> {
        let Some(way) = support.way else {
            return self.shapes.with_filter(crossing.pair, |filter| {
                filter.supporting_contact(crossing, support, clipped)
            })?;
        };
        let TrianglePair { corners, .. } = self.shapes.local(crossing.pair)?;
        let direction = way.towards(crossing.outward_normals(&corners).unwrap_or_default());
        let contact = contact_along(corners.each_ref(), direction, clipped)?;
        let source = ContactSource::OutwardAxis;
        (contact.distance <= 0.0).then_some(TriangleSurfaceContact { contact, source })
    }
}
