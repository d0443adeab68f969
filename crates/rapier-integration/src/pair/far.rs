//! Far contacts of two shapes made of triangles: what may be hit in the next step, but is not near.
//!
//! A host asks for them where a body is small beside the prediction distance, or fast and has soft
//! CCD. Fine meshes only have contacts from their tips to the nearest points of the other shape.
//! Rays from up to 128 triangles of each mesh find obstacles ahead. Walks add the places where
//! shapes are nearest to each other. A walk goes from a point of one shape to the nearest point of
//! the other, and back. It may end at another place. Shapes of few triangles that nearly touch keep
//! all contacts in the directions of local minima. Others keep the local minima of the larger
//! shape; without any, they keep all contacts.

use glamx::{DVec3, Vec3};
use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::Real;
use parry3d::query::Ray;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact, contact};

use super::borders::is_past_border;
use super::islands::OverlapIslands;
use super::query::ContactList;
use super::shapes::{TriangleHit, TriangleShapes, TriangleSurfaceContact};
use super::surface::{SurfaceFilter, Verdict};
use super::tuning::{NEAR_NORMAL, SAME_DIRECTION, SAME_FAR_DIRECTION};
use crate::mesh::LazySurface;

/// Greatest number of steps from a tip to the nearest point. Higher: more time for surfaces that
/// are nearly parallel; lower: the contact is farther than the nearest one.
const STEPS_TO_NEAREST: usize = 32;

/// Triangles of each mesh from which rays look ahead. Higher: more time. Lower: small parts of fine
/// meshes are met late.
const RAYS_AHEAD: usize = 128;

/// Square of the ratio of sizes from which the larger mesh does not look ahead. Higher: slow on
/// large terrains. Lower: small parts meet the teeth of larger ones late.
const MUCH_LARGER: Real = 16.0;

impl TriangleShapes<'_> {
    /// Adds far contacts, and keeps the nearest one of each pair of triangles. `lead_one_way`:
    /// contacts that lead past borders do not count.
    pub(super) fn add_far(
        &self,
        is_apart: bool,
        lead_one_way: bool,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        let (old_count, reach) = (contacts.len(), f64::from(self.reach()));
        // The nearest contact counts, even if it may pass by.
        let may_pass = old_count > 0;
        self.find_far(is_apart, |(pair, TriangleSurfaceContact { contact, .. })| {
            if contact.distance <= reach {
                return;
            }
            let verdict = self.with_filter(pair, |filter| filter.apply(contact, may_pass));
            if let Some(Verdict::Contact(hit, upright)) = verdict {
                let cosine = upright.map_or(1.0, |normal| normal.dot(hit.contact.normal));
                let is_past = lead_one_way && is_past_border(hit.contact.distance, cosine);
                contacts.extend((!is_past).then_some((pair, hit)));
            }
        });
        if contacts.len() > old_count {
            contacts.sort_by(|(pair1, hit1), (pair2, hit2)| {
                let by_distance = hit1.contact.distance.total_cmp(&hit2.contact.distance);
                pair1.cmp(pair2).then(by_distance)
            });
            contacts.dedup_by_key(|(pair, _)| *pair);
        }
    }

    /// Removes most contacts beyond the filter distance. If a contact is near, far ones stay in the
    /// directions of near contacts and of local minima. Between shapes that cross, those that lead
    /// into solids go, as they would hold the shapes in each other. If no contact is near, only
    /// local minima of the larger shape stay. Shapes without such a minimum keep all contacts, as
    /// the smaller one may turn before both meet. `directions` is memory.
    pub(super) fn thin_out_far(
        &self,
        directions: &mut Vec<DVec3>,
        islands: &OverlapIslands,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        let limit = self.filter_distance;
        let is_near = |contact: &TriangleContact| contact.distance <= limit;
        if !contacts.iter().any(|(_, hit)| is_near(&hit.contact)) {
            let is_minimum = |(pair, hit): &TriangleHit| {
                let is_minimum =
                    |filter: &SurfaceFilter<'_>| filter.is_minimum_of_larger(&hit.contact);
                self.with_filter(*pair, is_minimum) == Some(true)
            };
            if contacts.iter().any(is_minimum) {
                contacts.retain(is_minimum);
            }
            return;
        }
        directions.clear();
        for (pair, TriangleSurfaceContact { contact, .. }) in &*contacts {
            let is_minimum = |filter: &SurfaceFilter<'_>| filter.is_local_minimum(contact);
            let counts = || is_near(contact) || self.with_filter(*pair, is_minimum) == Some(true);
            // Some hundreds of such directions fit on a sphere.
            if !has_like(directions, contact.normal, SAME_DIRECTION) && counts() {
                directions.push(contact.normal);
            }
        }
        let is_overlap = !islands.crossings.is_empty();
        contacts.retain(|(pair, TriangleSurfaceContact { contact, .. })| {
            let leads_inside = |filter: &SurfaceFilter<'_>| filter.leads_inside(contact);
            is_near(contact)
                || has_like(directions, contact.normal, SAME_FAR_DIRECTION)
                    && !(is_overlap && self.with_filter(*pair, leads_inside) == Some(true))
        });
    }

    /// Calls `found` with the contacts of tips, and with those one step of a walk farther, which
    /// may be near. Shapes that are apart also get the contacts where walks from the nearest tips
    /// and from the middles end.
    fn find_far(&self, is_apart: bool, mut found: impl FnMut(TriangleHit)) {
        if !self.pose.placement12.is_finite() {
            return;
        }
        let within = self.pose.prediction;
        for i in 0..2 {
            let mut nearest: Option<TriangleHit> = None;
            for (half_edge, tip) in self[i].surface.iter().flat_map(LazySurface::tips) {
                let Some(hit) = self.of_point(i, half_edge, tip, within) else { continue };
                found(hit);
                self.step(1 - i, &hit, distance(&hit)).into_iter().for_each(&mut found);
                if nearest.is_none_or(|known| distance(&hit) < distance(&known)) {
                    nearest = Some(hit);
                }
            }
            if is_apart {
                let middle = self[i].bounds().center();
                let of_middle = self.of_point(i, 0, middle, Real::MAX);
                let from_middle = of_middle.and_then(|hit| self.step(1 - i, &hit, f64::INFINITY));
                let starts = [nearest.map(|hit| (1 - i, hit)), from_middle.map(|hit| (i, hit))];
                let ends = starts.into_iter().flatten().map(|(next, hit)| self.walked(next, hit));
                ends.filter(|end| distance(end) <= f64::from(within)).for_each(&mut found);
            }
        }
        self.find_ahead(&mut found);
    }

    /// Calls `found` with the contacts of triangles and what lies straight in front of them, for
    /// some triangles spread over each mesh. Sides that touch may hide them from walks.
    fn find_ahead(&self, found: &mut impl FnMut(TriangleHit)) {
        for i in 0..2 {
            let Some(view) = self[i].mesh() else { continue };
            // Few of its triangles would be near.
            if self[i].size_squared() > MUCH_LARGER * self[1 - i].size_squared() {
                continue;
            }
            let (count, signs) = (view.mesh.indices().len(), self[i].ways_out());
            let looks = RAYS_AHEAD.min(count);
            let triangles = (0..looks).map(|k| (k * count / looks) as u32);
            for (triangle, &sign) in triangles.flat_map(|t| signs.iter().map(move |s| (t, s))) {
                self.ahead(i, triangle, sign).into_iter().for_each(&mut *found);
            }
        }
    }

    /// Returns the contact of a triangle and of the triangle that a ray along its normal meets
    /// first, if both face each other.
    fn ahead(&self, i: usize, triangle: u32, sign: Real) -> Option<TriangleHit> {
        let within = self.pose.prediction;
        let [a, b, c] = self[i].corners(triangle)?;
        let start = self.pose.in_other(i, (a + b + c) / 3.0);
        if !self[1 - i].bounds().loosened(within).contains_local_point(start) {
            return None;
        }
        let rotation = self.pose.pos12.rotation;
        let way = sign * (b - a).cross(c - a).normalize_or_zero();
        let way = if i == 0 { rotation.inverse() * way } else { rotation * way };
        let (met, distance, cosine) = self[1 - i].first_met(&Ray::new(start, way), within)?;
        if f64::from(distance) <= f64::from(self.reach()) || cosine < NEAR_NORMAL as Real {
            return None;
        }
        let mut pair = [met; 2];
        pair[i] = triangle;
        self.contact_within(pair, f64::from(within))
    }

    /// Walks on from a contact. The first step starts at the point of shape `i`.
    fn walked(&self, mut i: usize, mut hit: TriangleHit) -> TriangleHit {
        let mut is_nearest = false;
        for _ in 0..STEPS_TO_NEAREST {
            let known = distance(&hit);
            let next = self.step(i, &hit, known).filter(|next| distance(next) < known);
            // A step moves both points, so the walk ends only where no step of either shape gains.
            if is_nearest && next.is_none() {
                break;
            }
            is_nearest = next.is_none();
            (i, hit) = (1 - i, next.unwrap_or(hit));
        }
        hit
    }

    /// Returns the contact after a step from the point of shape `i`: the triangle of the other
    /// shape becomes the nearest one. `None` beyond a limit.
    fn step(&self, i: usize, (pair, known): &TriangleHit, limit: f64) -> Option<TriangleHit> {
        let placement = &self.pose.placement12;
        let [origin, ..] = self[0].corners(pair[0])?;
        let point = match i {
            0 => placement.to_frame2(known.contact.point1, origin),
            _ => known.contact.point2 + origin.as_dvec3(),
        };
        let mut pair = *pair;
        pair[1 - i] = self[1 - i].nearest_triangle(point.as_vec3(), limit as Real)?;
        self.contact_within(pair, limit)
    }

    /// Returns the contact of two triangles, if that is within a limit.
    pub(super) fn contact_within(&self, pair: [u32; 2], limit: f64) -> Option<TriangleHit> {
        let local = self.local(pair)?;
        let [t1, t2] = &local.corners;
        Some((pair, TriangleSurfaceContact::of_triangles(contact(t1, t2, limit)?)))
    }

    /// Returns the contact of a point and the nearest triangle of the other shape. The point is in
    /// the frame of shape `i`, and stands for the start of a half-edge.
    fn of_point(&self, i: usize, half_edge: u32, point: Vec3, within: Real) -> Option<TriangleHit> {
        let in_other = self.pose.in_other(i, point);
        let mut pair = [self[1 - i].nearest_triangle(in_other, within)?; 2];
        pair[i] = half_edge / 3;
        let mut local = self.local(pair)?;
        local.corners[i] = [self.pose.in_local(i, point, local.origin); 3];
        let [t1, t2] = &local.corners;
        let contact = contact(t1, t2, f64::from(within))?;
        let mut features = [contact.features.feature1(), contact.features.feature2()];
        features[i] = Feature::Vertex((half_edge % 3) as u8);
        let features = FeaturePair::new(features[0], features[1]);
        let contact = TriangleContact { features, ..contact };
        Some((pair, TriangleSurfaceContact::of_triangles(contact)))
    }
}

/// Returns true if one of some directions is within an angle of a normal.
fn has_like(directions: &[DVec3], normal: DVec3, cosine: f64) -> bool {
    directions.iter().any(|direction| direction.dot(normal) >= cosine)
}

fn distance((_, hit): &TriangleHit) -> f64 {
    hit.contact.distance
}
