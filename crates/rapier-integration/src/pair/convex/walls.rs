//! Removes contacts with walls that are not in the way of a convex shape. These are walls within
//! the mesh, walls behind an edge, and walls over which one way lifts the shape.

use glamx::{DVec3, Vec3};
use sbbk_core::contact::Feature;
use sbbk_core::surface::{Side, SurfaceKind, area_vector};

use super::contact::{Hit, NormalSource, PartContact};
use super::points::contact_points;
use super::query::{ConvexQuery, DroppedContacts, PlacedParts};
use crate::mesh::{LazySurface, is_covered};
use crate::pair::query::ContactList;
use crate::pair::shapes::{filter_distance, filter_unit};
use crate::pair::tuning::{SAME_DIRECTION, SAME_SIDE};
use crate::pair::ways::{Ways, equal_height, greatest_overlap, resting_depth};

/// Least sine of the angle between a triangle and a contact that leads behind the triangle. Higher:
/// bodies catch on walls behind the edge that they slide over. Lower: rounding decides about
/// contacts along the surface.
const TANGENTIAL: f64 = 1.0e-4;

/// Two distances count as equal if they differ by less than this share. Higher: contacts apart are
/// lost. Lower: bodies catch on the foot of a step or chamfer that they slide over.
const AT_ONE_PLACE: f64 = 1.0e-6;

impl ConvexQuery<'_> {
    /// Removes the contacts of triangles that have the body on both sides, those that lead into the
    /// body, and those behind these. Asks for sides only where contacts push in different
    /// directions. Parts whose middle is in a solid keep all contacts: the solid is a room, and the
    /// triangles are of what stands there.
    pub(super) fn drop_walls(
        &self,
        contacts: &mut ContactList<PartContact>,
        at_hand: &mut PlacedParts,
        dropped: &mut DroppedContacts,
    ) {
        let Some(surface) = self.surface.as_ref() else { return };
        if !self.push_different_ways(contacts, SAME_SIDE, at_hand)
            || surface.kind() == SurfaceKind::Sheet
        {
            return;
        }
        self.find_walls(surface, contacts, at_hand, &mut dropped.removed);
        self.find_behind(contacts, 1.0 - AT_ONE_PLACE, at_hand, dropped);
        dropped.remove_from(contacts);
    }

    /// Returns true if a normal is farther from the first one than an angle.
    fn push_different_ways(
        &self,
        contacts: &[Hit],
        cosine: f64,
        at_hand: &mut PlacedParts,
    ) -> bool {
        let mut normals =
            contacts.iter().map(|(of, hit)| self.shared_normal(*of, &hit.contact, at_hand));
        normals.next().is_some_and(|first| normals.any(|normal| first.dot(normal) < cosine))
    }

    /// Finds contacts of walls within the body, and contacts that lead into the body. Crossing
    /// triangles keep contacts that lead in unless another one leads out.
    fn find_walls(
        &self,
        surface: &LazySurface<'_>,
        contacts: &[Hit],
        at_hand: &mut PlacedParts,
        removed: &mut Vec<bool>,
    ) {
        let leads_out =
            |hit: &Hit| hit.1.contact.distance < 0.0 && !self.leads_in(surface, hit, at_hand);
        let has_way_out = contacts.iter().any(leads_out);
        let mut last = None;
        removed.clear();
        removed.extend(contacts.iter().map(|hit @ (of, PartContact { contact, .. })| {
            let [triangle, part] = self.pair.mesh_place.swap(*of);
            let is_wall = surface.around(triangle).side == Side::Inner
                || (has_way_out || contact.distance > 0.0) && self.leads_in(surface, hit, at_hand);
            is_wall && {
                let known = last.filter(|(of, _)| *of == part);
                let within = || (part, self.is_middle_within(surface, part, at_hand));
                !last.insert(known.unwrap_or_else(within)).1
            }
        }));
    }

    /// Finds contacts apart that are behind the triangle of a removed contact: at their points,
    /// that triangle is nearer than `near` times their distance.
    fn find_behind(
        &self,
        contacts: &[Hit],
        near: f64,
        at_hand: &mut PlacedParts,
        DroppedContacts { removed, apart, .. }: &mut DroppedContacts,
    ) {
        if !removed.contains(&true) {
            return;
        }
        let distance = |i: usize| contacts[i].1.contact.distance;
        apart.clear();
        let may_be_behind =
            |&i: &usize| self.depth(&contacts[i]) <= 0.0 && contacts[i].1.feature != Feature::Face;
        apart.extend((0..contacts.len()).filter(may_be_behind));
        apart.sort_unstable_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        // All triangles at a vertex have the same contact there.
        let mut last = None;
        for &i in &*apart {
            let (of, PartContact { contact, .. }) = &contacts[i];
            let [_, part] = self.pair.mesh_place.swap(*of);
            let place = self.with_pair(*of, at_hand, |pair| pair.touched_place(contact)).flatten();
            let Some((place, seam)) = place.filter(|_| !removed[i]) else { continue };
            let known = last.filter(|(at, _)| *at == (part, place));
            let (_, is_behind) = *last.insert(known.unwrap_or_else(|| {
                let mut is_behind = false;
                self.strays_at(contacts, *of, place, seam, |other| {
                    let other = other as usize;
                    is_behind |= removed[other] && distance(other) < near * contact.distance;
                });
                ((part, place), is_behind)
            }));
            removed[i] = is_behind;
        }
    }

    /// Returns true if a contact leads into the body behind its triangle.
    fn leads_in(
        &self,
        surface: &LazySurface<'_>,
        (of, hit): &Hit,
        at_hand: &mut PlacedParts,
    ) -> bool {
        let [triangle, _] = self.pair.mesh_place.swap(*of);
        let around = surface.around(triangle);
        let area = area_vector(&self.pair.mesh.corners(triangle).map(Vec3::as_dvec3));
        let inward = -around.side.outward().unwrap_or(0.0) * area;
        let direction =
            self.with_pair(*of, at_hand, |pair| pair.placed.directions(hit.contact.normal)[0]);
        direction.is_some_and(|direction| {
            inward.dot(direction) > TANGENTIAL * inward.length()
                && around.points_inside(triangle, hit.feature, direction)
        })
    }

    /// Returns true if the middle of a part is in a solid, or in a room whose faces lead inwards.
    fn is_middle_within(
        &self,
        surface: &LazySurface<'_>,
        part: u32,
        at_hand: &mut PlacedParts,
    ) -> bool {
        let is_within = self.pair.parts.with(part, |shape| {
            let middle = self.placed(part, &shape, at_hand).in_mesh(shape.shape.middle()?);
            let is_in = || surface.winding_sign(middle).is_some_and(|sign| sign != 0);
            Some(is_covered(self.pair.mesh.mesh, middle) && is_in())
        });
        is_within.flatten() == Some(true)
    }

    /// Marks contacts that push aside, if one [way](crate::pair::ways) leads a part out of all
    /// triangles. Also marks contacts apart over whose triangles the way lifts the part, and
    /// contacts behind them.
    pub(super) fn find_lifted(
        &self,
        contacts: &[Hit],
        at_hand: &mut PlacedParts,
        dropped: &mut DroppedContacts,
    ) {
        let Some(surface) = self.surface.as_ref().filter(|_| !self.pair.is_ball()) else { return };
        if !self.push_different_ways(contacts, SAME_DIRECTION, at_hand) {
            return;
        }
        let DroppedContacts { removed, ways, .. } = &mut *dropped;
        self.find_ways(surface, contacts, ways, at_hand);
        for (is_removed, hit) in removed.iter_mut().zip(contacts) {
            let [_, part] = self.pair.mesh_place.swap(hit.0);
            let Some((way, length)) = ways.least(part as usize) else { continue };
            let along = way.dot(hit.1.contact.normal);
            *is_removed = if self.depth(hit) > 0.0 {
                along < SAME_SIDE
            } else {
                along < SAME_DIRECTION && self.is_parted(surface, hit, (way, length), at_hand)
            };
        }
        self.find_behind(contacts, 1.0 + AT_ONE_PLACE, at_hand, dropped);
    }

    /// Finds the ways that part each part from all triangles that it crosses. Contacts that hardly
    /// hover know ways, too.
    fn find_ways(
        &self,
        surface: &LazySurface<'_>,
        contacts: &[Hit],
        ways: &mut Ways,
        at_hand: &mut PlacedParts,
    ) {
        let hits = contacts.iter().map(|hit @ (of, PartContact { contact, .. })| {
            let [_, part] = self.pair.mesh_place.swap(*of);
            (part as usize, contact.normal, hit, self.depth(hit))
        });
        let least = -equal_height(self.filter_unit());
        let known = hits.clone().filter(|(.., depth)| *depth >= least);
        let known = known.map(|(part, normal, _, depth)| (part, normal, depth.max(0.0)));
        let overlaps = hits.filter(|(.., depth)| *depth > 0.0);
        let overlaps = overlaps.map(|(part, normal, hit, _)| (part, normal, hit));
        let small = resting_depth(self.filter_distance());
        ways.find(small, known, overlaps, |hit, way, length| {
            self.is_parted(surface, hit, (way, length), at_hand)
        });
    }

    /// Returns the depth of a contact; negative if it is apart.
    fn depth(&self, (of, hit): &Hit) -> f64 {
        let [_, part] = self.pair.mesh_place.swap(*of);
        let radius = self.pair.parts.with(part, |part| part.shape.radius()).unwrap_or_default();
        f64::from(radius) - hit.contact.distance
    }

    /// Returns the filter distance of the smaller shape.
    fn filter_distance(&self) -> f64 {
        filter_distance(true, self.pair.mesh.ball().radius.min(self.part_data.ball.radius))
    }

    /// Returns the unit of the filter.
    fn filter_unit(&self) -> f64 {
        filter_unit(self.pair.pose, self.filter_distance())
    }

    /// Returns true if a triangle, and the surface, end near the lowest point of a contact along a
    /// way. The way then parts both.
    fn is_parted(
        &self,
        surface: &LazySurface<'_>,
        (of, hit): &Hit,
        (way, length): (DVec3, f64),
        at_hand: &mut PlacedParts,
    ) -> bool {
        let [triangle, _] = self.pair.mesh_place.swap(*of);
        let is_parted = self.with_pair(*of, at_hand, |pair| {
            let corners = &pair.placed.in_part(pair.corners);
            let heights = corners.map(|corner| corner.dot(way));
            let highest = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let overlap = |on_shape: DVec3| highest - on_shape.dot(way) + pair.radius();
            let most = greatest_overlap(length, self.filter_unit());
            // Spares the points: the lowest one is no higher.
            if hit.source == NormalSource::Own && overlap(hit.contact.on_shape) > most {
                return false;
            }
            let mut greatest = f64::NEG_INFINITY;
            contact_points(corners, pair.part.shape, hit, None, 0.0, |point| {
                greatest = greatest.max(overlap(point.on_shape));
            });
            let [axis, _] = pair.placed.directions(way);
            // A contact without points stops nothing.
            greatest == f64::NEG_INFINITY
                || greatest.abs() <= most
                    && surface.around(triangle).ends_along(triangle, heights, axis)
        });
        is_parted == Some(true)
    }
}
