//! Contacts of meshes that overlap, after the first pass.

use glamx::DVec3;
use sbbk_core::contact::contact_along;
use sbbk_core::query::TrianglePair;

use super::TriangleQuery;
use crate::pair::contours::{self, ContourMemory};
use crate::pair::descents::{ChunkResult, in_chunks};
use crate::pair::islands::{Crossing, IslandWay, OverlapIslands};
use crate::pair::query::ContactList;
use crate::pair::shapes::{ContactSource, TriangleHit, TriangleSurfaceContact};
use crate::pair::surface::SurfaceFilter;
use crate::pair::tuning::{ALIKE, SAME_DIRECTION};
use crate::pair::ways::greatest_overlap;

/// Least number of crossings of a chunk. Higher: threads wait for each other; lower: threads take
/// turns for chunks of a few microseconds.
const LEAST_CROSSINGS: usize = 64;

impl<T: Send> ChunkResult for ContactList<T> {
    fn append(&mut self, next: Self) {
        self.extend(next);
    }
}

impl TriangleQuery<'_> {
    /// Adds the contacts of crossing triangles, and drops triangles that do not cross after all.
    #[inline(never)]
    pub(super) fn add_island_contacts(
        &self,
        islands: &mut OverlapIslands,
        contours: &mut ContourMemory,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        islands.join();
        contours::find_ways(&self.shapes, islands, contours);
        contacts.extend(islands.of_contours(|island| islands.leading_way(island).is_some()));
        let mut crossings = std::mem::take(&mut islands.crossings);
        let add = |chunk: &mut [Crossing], contacts: &mut ContactList<_>| {
            contacts.extend(chunk.iter_mut().filter_map(|crossing| {
                let way = islands.leading_way(crossing.island);
                Some((crossing.pair, self.of_crossing(crossing, way)?))
            }));
        };
        in_chunks(&mut crossings, LEAST_CROSSINGS, contacts, &add);
        crossings.retain(|crossing| {
            let is_touching = !crossing.counts && crossing.is_touching;
            islands.touching.extend(is_touching.then_some(crossing.pair));
            crossing.counts
        });
        islands.crossings = crossings;
        keep_deepest(contacts);
    }

    /// Returns the contact of a crossing pair: along the way out of its island, or else the
    /// extremal one.
    fn of_crossing(
        &self,
        crossing: &mut Crossing,
        way: Option<IslandWay>,
    ) -> Option<TriangleSurfaceContact> {
        let Some(way) = way else {
            return self
                .shapes
                .with_filter(crossing.pair, |filter| filter.find_extremal(crossing))
                .flatten();
        };
        (crossing.is_reliable, crossing.counts) = (true, true);
        (crossing.normal, crossing.depth) = (way.normal, way.length);
        self.contact_along(crossing, way)
    }

    /// Returns the contact of a crossing pair along the way out of its island.
    fn contact_along(&self, crossing: &Crossing, way: IslandWay) -> Option<TriangleSurfaceContact> {
        let TrianglePair { corners, .. } = self.shapes.local(crossing.pair)?;
        let direction = way.towards(crossing.outward_normals(&corners).unwrap_or_default());
        let contact = contact_along(corners.each_ref(), direction)?;
        let source = ContactSource::OutwardAxis;
        (contact.distance <= 0.0).then_some(TriangleSurfaceContact { contact, source })
    }

    /// Removes contacts apart that a way out of an overlap lifts over their triangles. These are at
    /// the height of the overlap.
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

    /// Adds the contacts of crossing triangles if all contacts are apart, as these do not part the
    /// triangles.
    pub(super) fn add_if_all_apart(
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

    /// Returns the contacts of the triangles that cross, or touch if none do.
    pub(super) fn of_overlaps(
        &self,
        islands: &OverlapIslands,
    ) -> impl Iterator<Item = TriangleHit> {
        let within = f64::from(self.shapes.pose.prediction);
        let crossing = islands.crossings.iter().map(|crossing| crossing.pair);
        let touching = islands.touching.iter().filter(|_| islands.crossings.is_empty());
        let pairs = crossing.chain(touching.copied());
        pairs.filter_map(move |pair| self.shapes.contact_within(pair, within))
    }

    /// Returns true if a way parts two triangles at their height, and both surfaces end there.
    /// Triangle 2 leaves along the way.
    pub(super) fn is_parted(&self, pair: [u32; 2], way: DVec3, length: f64) -> bool {
        let Some(local) = self.shapes.local(pair) else { return false };
        let heights = local.corners.map(|of| of.map(|corner| corner.dot(way)));
        let highest = heights[0].into_iter().fold(f64::NEG_INFINITY, f64::max);
        let lowest = heights[1].into_iter().fold(f64::INFINITY, f64::min);
        (highest - lowest).abs() <= greatest_overlap(length, self.shapes.filter_unit())
            && SurfaceFilter::new(&self.shapes, pair, &local)
                .is_some_and(|filter| filter.ends_along(way))
    }

    /// Replaces the contacts that push the wrong way, and adds contacts to islands that have too
    /// few.
    #[inline(never)]
    pub(super) fn second_pass(
        &self,
        islands: &OverlapIslands,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        contacts.retain(|(pair, _)| islands.is_final(*pair));
        // Islands with a leading way have enough contacts.
        contacts.extend(islands.of_contours(|island| islands.open_support(island).is_some()));
        for crossing in islands.crossings.iter().filter(|crossing| !crossing.is_fine()) {
            let Some(support) = islands.open_support(crossing.island) else { continue };
            let contact = match islands.ways_out[crossing.island] {
                Some(way) => self.contact_along(crossing, way),
                None => {
                    let then = |it: &SurfaceFilter<'_>| it.supporting_contact(crossing, support);
                    self.shapes.with_filter(crossing.pair, then).flatten()
                }
            };
            contacts.extend(contact.map(|contact| (crossing.pair, contact)));
        }
        keep_deepest(contacts);
    }
}

/// Sorts contacts by pair, and keeps the deepest of each pair. Points of a contour count if they
/// are much deeper.
fn keep_deepest(contacts: &mut ContactList<TriangleSurfaceContact>) {
    let height = |(_, TriangleSurfaceContact { contact, source }): &TriangleHit| {
        contact.distance / if *source == ContactSource::PushOut { ALIKE } else { 1.0 }
    };
    let order =
        |a: &TriangleHit, b: &TriangleHit| a.0.cmp(&b.0).then(height(a).total_cmp(&height(b)));
    contacts.sort_unstable_by(order);
    contacts.dedup_by_key(|(pair, _)| *pair);
}
