//! Contacts of two shapes that are both made of triangles.
//!
//! Each candidate is a pair of triangles with an exact contact ([`sbbk_core::contact`]). The first
//! pass keeps those that are contacts of the surfaces ([`SurfaceFilter`]). A second pass adds
//! contacts to crossing triangles that too few contacts push apart ([`OverlapIslands`]).

use std::cell::Cell;
use std::thread::LocalKey;

use glamx::DVec3;
use parry3d::math::Real;
use sbbk_core::contact::{ManifoldPoints, TriangleContact, clip, push_closest};
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::longest_side;
use sbbk_core::traverse::{DescentCounts, SlackLimits};

use super::borders::{is_past_border, lead_one_way};
use super::chunks::{ChunkResult, in_chunks};
use super::deep::{self, ContourMemory};
use super::descents::DescentMemory;
use super::inside::{HeldMesh, InsideTest};
use super::islands::{Crossing, Overlap, OverlapIslands};
use super::passed::PassedTriangles;
use super::pose::{Moving, PairPose};
use super::query::{ContactList, ContactPoints, Limits, Memory, PairQuery};
use super::reduce::{ContactSummary, PatchPlan};
use super::state::Candidate;
use super::surface::{NEARLY_TOUCHING, SurfaceFilter, Verdict};
use super::triangle_contacts::{constrained_normal, contact_of, write_points};
use super::triangle_shapes::{
    ContactSource, Hint, TriangleHit, TriangleShapes, TriangleSurfaceContact,
};

/// Greatest depth of points in prediction distances, at least. Rapier recycles contacts until bodies
/// have moved by 2.5. Higher: bodies that are deep leave faster; lower: they fall asleep inside.
const DEEPEST: f64 = 4.0;

/// Least number of candidates of a [chunk](super::chunks). Higher: threads wait for each other; lower: threads
/// take turns for chunks of a few microseconds.
const LEAST_CANDIDATES: usize = 256;

/// Share of the least distance below which a distance is less. Higher: rounding decides where triangles have equal distances.
const NEARER: f64 = 0.999;

/// Least cosine between a face and a direction that leads out of it rather than along it. Higher: deep boxes get contacts with the
/// sides; lower: bodies in sockets lose contacts.
const OUT_OF_FACE: f64 = 0.7;

/// A query about two shapes made of triangles.
pub(crate) struct TriangleQuery<'q> {
    pub(super) shapes: TriangleShapes<'q>,
    pub(super) patches: Option<PatchPlan>,
    /// Tells if one mesh is a room for the other.
    pub(super) in_room: &'q InsideTest,
    /// Tells if one mesh is inside the other.
    pub(super) inside: &'q mut InsideTest,
}

/// Memory for queries.
#[derive(Default)]
pub(crate) struct TriangleScratch {
    descent: DescentMemory,
    first: FirstPass,
    contours: ContourMemory,
    /// Normals of contacts.
    directions: Vec<DVec3>,
    passed: PassedTriangles,
}

/// Result of the first pass over candidates, and memory for it.
#[derive(Default)]
struct FirstPass {
    contacts: ContactList<TriangleSurfaceContact>,
    /// Normals of the faces, for contacts at borders.
    upright: ContactList<DVec3>,
    /// Edges and vertices that may pass each other.
    passing: ContactList<TriangleContact>,
    islands: OverlapIslands,
    /// True if triangles are in reach.
    is_near: bool,
    clipped: ManifoldPoints,
}

impl FirstPass {
    fn clear(&mut self) {
        self.upright.clear();
        self.passing.clear();
        self.islands.clear();
        self.is_near = false;
    }
}

impl ChunkResult for FirstPass {
    fn append(&mut self, next: Self) {
        self.contacts.extend(next.contacts);
        self.upright.extend(next.upright);
        self.passing.extend(next.passing);
        self.islands.append(next.islands);
        self.is_near |= next.is_near;
    }
}

thread_local! {
    static MEMORY: Cell<Option<Box<super::query::QueryMemory<TriangleScratch, TriangleSurfaceContact>>>> =
        Cell::default();
}

impl PairQuery for TriangleQuery<'_> {
    type Hint = Hint;
    type Contact = TriangleSurfaceContact;
    type Scratch = TriangleScratch;

    const SLACK: SlackLimits = SlackLimits::TRIANGLES;

    fn memory() -> &'static LocalKey<Memory<Self>> {
        &MEMORY
    }

    fn pose(&self) -> &PairPose {
        self.shapes.pose
    }

    fn moving(&self) -> Moving {
        self.shapes.moving()
    }

    fn reach(&self) -> Real {
        self.shapes.reach()
    }

    fn clearance(&self, margin: Real) -> Option<Real> {
        self.shapes.clearance(margin)
    }

    fn calm(&self) -> f64 {
        HeldMesh::of(&self.shapes)
            .map_or(f64::INFINITY, |held| held.calm(self.in_room, self.inside))
    }

    fn descend(
        &mut self,
        margin: Real,
        counts: &mut DescentCounts,
        scratch: &mut TriangleScratch,
        found: &mut Vec<Candidate<Hint>>,
    ) {
        self.shapes.descend(margin, counts, &mut scratch.descent, found);
    }

    fn contacts(
        &mut self,
        candidates: &mut [Candidate<Hint>],
        limits: Limits,
        scratch: &mut TriangleScratch,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        let TriangleScratch { first, contours, directions, passed, .. } = scratch;
        first.clear();
        std::mem::swap(&mut first.contacts, contacts);
        let pass = |chunk: &mut [_], first: &mut FirstPass| {
            chunk.iter_mut().for_each(|candidate| self.first_pass(candidate, limits, first));
        };
        in_chunks(candidates, LEAST_CANDIDATES, first, &pass);
        self.add_passing(first);
        std::mem::swap(&mut first.contacts, contacts);
        let FirstPass { islands, clipped, is_near, upright, .. } = first;
        if self.shapes.is_side_doubtful(&islands.crossings) {
            return self.hold(candidates, limits, contacts);
        }
        let lead_one_way = meet_borders(upright, contacts);
        let separation = islands.is_undecided().then(|| self.shapes.separation()).flatten();
        if islands.finish_first_pass(separation, |pair, way| self.overlap(pair, way)) {
            self.second_pass(islands, contours, clipped, contacts);
        }
        if limits.reach < f64::from(self.pose().prediction) {
            self.shapes.add_far(!*is_near, lead_one_way, clipped, contacts);
        } else if limits.reach > self.shapes.filter_distance {
            self.shapes.reject_aside(directions, islands, contacts);
        }
        self.reject_passed(islands, passed, contacts);
        self.shapes.reject_through(&islands.crossings, contacts);
        if contacts.is_empty() {
            let is_in_both = islands.separation.is_some();
            let held = HeldMesh::of(&self.shapes);
            contacts.extend(held.and_then(|held| held.push_out(is_in_both, self.inside)));
        }
        if contacts.is_empty() {
            let within = f64::from(self.pose().prediction);
            let contact = |pair: [u32; 2]| self.shapes.nearest_points(pair, within);
            contacts.extend(islands.overlaps().filter_map(contact));
        }
    }

    /// Makes one patch for each direction if all contacts are beyond the filter distance. Rapier's solver
    /// drops such points of manifolds of more than four, and a falling plate would turn about one point.
    fn reduction(&self, contacts: &ContactList<TriangleSurfaceContact>) -> Option<PatchPlan> {
        let near = self.shapes.filter_distance;
        let may_be_far = f64::from(self.pose().prediction) > near;
        let is_far = |(_, hit): &TriangleHit| hit.contact.distance > near;
        if may_be_far && contacts.iter().all(is_far) {
            return Some(PatchPlan::ALL_FAR);
        }
        self.patches
    }

    fn summary(
        &mut self,
        hit: &TriangleHit,
        scratch: &mut TriangleScratch,
        points: &mut ContactPoints,
    ) -> Option<ContactSummary> {
        let (pair, TriangleSurfaceContact { contact, source }) = hit;
        let corners = [self.shapes[0].corners(pair[0])?, self.shapes[1].corners(pair[1])?];
        let [[origin, ..], _] = corners;
        let [side1, side2] = corners.map(|of| longest_side(&of.map(|corner| corner.as_dvec3())));
        let of_triangles = self.shapes.cones(*pair);
        let cones = source.cones(&of_triangles);
        let normal = constrained_normal(contact, cones, &self.pose().pos12)?;
        let point = (origin.as_dvec3() + contact.point1).as_vec3();
        let mut distance = contact.distance as Real;
        if cones.iter().any(Option::is_some) {
            // Cones move points.
            self.points(hit, scratch, points);
            distance = points.points.iter().map(|point| point.dist).reduce(Real::min)?;
        }
        let reach = side1.min(side2) as Real;
        Some(ContactSummary { part: 0, normal, point, distance, reach })
    }

    #[inline(always)]
    fn points(
        &mut self,
        (pair, TriangleSurfaceContact { contact, source }): &TriangleHit,
        scratch: &mut TriangleScratch,
        points: &mut ContactPoints,
    ) {
        let shapes = &mut self.shapes;
        let clipped = &mut scratch.first.clipped;
        points.points.clear();
        let Some(local) = shapes.local(*pair) else { return };
        let of_triangles = shapes.cones(*pair);
        let [t1, t2] = &local.corners;
        clipped.clear();
        if *source != ContactSource::PushOut {
            clip(t1, t2, contact.normal, clipped);
        }
        if *source == ContactSource::OutwardAxis {
            deepen(clipped, contact);
        } else {
            push_closest(t1, t2, contact, clipped);
        }
        let pose = shapes.pose;
        let deepest = -shapes.filter_distance.max(DEEPEST * f64::from(pose.prediction));
        clipped.iter_mut().for_each(|point| point.distance = point.distance.max(deepest));
        write_points(pose, &local, contact, clipped, source.cones(&of_triangles), points);
    }
}

impl TriangleQuery<'_> {
    /// Adds the contact of a candidate, unless the surfaces have none there.
    #[inline(always)]
    fn first_pass(&self, candidate: &mut Candidate<Hint>, limits: Limits, first: &mut FirstPass) {
        if !limits.may_touch(candidate) {
            return;
        }
        let pair = candidate.subshapes;
        let Some(local) = self.shapes.local(pair) else { return };
        let Some(contact) = touch(&local, candidate, limits) else { return };
        first.is_near = true;
        let Some(filter) = SurfaceFilter::new(&self.shapes, pair, &local) else {
            return first.contacts.push((pair, TriangleSurfaceContact::of_triangles(contact)));
        };
        match filter.apply(contact, true, &mut first.clipped) {
            Verdict::None if filter.is_touching(&contact, NEARLY_TOUCHING) => {
                first.islands.touching.push(pair);
            }
            Verdict::None => {}
            Verdict::Passing => first.passing.push((pair, contact)),
            Verdict::Contact(contact, upright) => {
                first.contacts.push((pair, contact));
                first.upright.extend(upright.map(|upright| (pair, upright)));
            }
            Verdict::Crossing(crossing, contact) => {
                first.islands.crossings.push(crossing);
                first.contacts.extend(contact.map(|contact| (pair, contact)));
            }
        }
    }

    /// Replaces all contacts by the contacts of single triangles. These push both ways.
    fn hold(
        &self,
        candidates: &[Candidate<Hint>],
        limits: Limits,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        contacts.clear();
        let within = f64::from(self.pose().prediction);
        let contact = |of: &Candidate<Hint>| self.shapes.nearest_points(of.subshapes, within);
        let is_near = |(_, hit): &TriangleHit| hit.contact.distance <= limits.reach;
        let may_touch = candidates.iter().filter(|candidate| limits.may_touch(candidate));
        contacts.extend(may_touch.filter_map(contact).filter(is_near));
    }

    /// Adds the contacts of edges and vertices that may pass each other, if they are nearer than all other contacts.
    fn add_passing(&self, first: &mut FirstPass) {
        let FirstPass { contacts, upright, passing, islands, clipped, .. } = first;
        if passing.is_empty() || !islands.crossings.is_empty() {
            return;
        }
        let old_count = contacts.len();
        let distances = contacts.iter().map(|(_, hit)| hit.contact.distance);
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let is_nearest = |contact: &TriangleContact| contact.distance < NEARER * nearest;
        for &(pair, contact) in passing.iter().filter(|(_, contact)| is_nearest(contact)) {
            let verdict =
                self.shapes.with_filter(pair, |filter| filter.apply(contact, false, clipped));
            if let Some(Verdict::Contact(hit, border)) = verdict {
                contacts.push((pair, hit));
                upright.extend(border.map(|border| (pair, border)));
            }
        }
        if contacts.len() > old_count {
            contacts.sort_by_key(|(pair, _)| *pair);
            upright.sort_by_key(|(pair, _)| *pair);
        }
    }

    /// Removes the contacts of sheets that have passed sheets.
    fn reject_passed(
        &self,
        islands: &OverlapIslands,
        passed: &mut PassedTriangles,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        // Surfaces are asked for only where something crosses.
        let Some(Crossing { pair, .. }) = islands.crossings.first() else { return };
        if self.shapes[0].is_solid() || self.shapes[1].is_solid() {
            return;
        }
        for i in 0..2 {
            if let Some(surface) = self.shapes[i].around(pair[i]) {
                passed.reject(i, &surface.facets, islands.final_normals(i), contacts);
            }
        }
    }

    /// Returns the overlap of two triangles along a direction in which triangle 2 leaves.
    fn overlap(&self, pair: [u32; 2], way: DVec3) -> Overlap {
        let Some(local) = self.shapes.local(pair) else {
            return Overlap { length: 0.0, leads_out: false };
        };
        let heights = local.corners.map(|corners| corners.map(|corner| corner.dot(way)));
        let highest = heights[0].into_iter().fold(f64::NEG_INFINITY, f64::max);
        let lowest = heights[1].into_iter().fold(f64::INFINITY, f64::min);
        let leads_out = |[a, b, c]: [DVec3; 3]| {
            let area = (b - a).cross(c - a);
            area.dot(way).abs() > OUT_OF_FACE * area.length()
        };
        let leads_out = local.corners.into_iter().any(leads_out);
        Overlap { length: highest - lowest, leads_out }
    }

    /// Replaces the contacts that push the wrong way, and adds contacts to islands that have too few.
    #[inline(never)]
    fn second_pass(
        &self,
        islands: &mut OverlapIslands,
        contours: &mut ContourMemory,
        clipped: &mut ManifoldPoints,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        contacts.retain(|(pair, _)| islands.is_final(*pair));
        deep::add_contacts(&self.shapes, islands, contours, contacts);
        deep::remove_farther(&self.shapes, islands, contacts);
        for i in 0..islands.crossings.len() {
            let Some(crossing) = islands.open(i) else { continue };
            let Some(support) = islands.open_support(&crossing) else { continue };
            let contact = self.shapes.with_filter(crossing.pair, |filter| {
                filter.supporting_contact(&crossing, support, clipped)
            });
            contacts.extend(contact.flatten().map(|contact| (crossing.pair, contact)));
        }
        // Contacts of contours come first.
        contacts.sort_unstable_by_key(|(pair, hit)| (*pair, hit.source != ContactSource::PushOut));
        contacts.dedup_by_key(|(pair, _)| *pair);
    }
}

/// Gives contacts at borders the normals of the faces, if these lead one way, and returns true then. Removes those that lead
/// [past a border](is_past_border). Both lists have one order.
fn meet_borders(
    upright: &ContactList<DVec3>,
    contacts: &mut ContactList<TriangleSurfaceContact>,
) -> bool {
    if !lead_one_way(upright.iter().map(|(_, normal)| *normal)) {
        return false;
    }
    let mut next = upright.iter().peekable();
    contacts.retain_mut(|(pair, TriangleSurfaceContact { contact, .. })| {
        let Some((_, normal)) = next.next_if(|(of, _)| of == pair) else { return true };
        let cosine = normal.dot(contact.normal);
        let distance = contact.distance * cosine.max(0.0);
        let (middle, half) = (contact.point1.midpoint(contact.point2), 0.5 * distance * normal);
        let (point1, point2) = (middle - half, middle + half);
        let is_past = is_past_border(contact.distance, cosine);
        *contact = TriangleContact { normal: *normal, distance, point1, point2, ..*contact };
        !is_past
    });
    true
}

/// Returns the contact of the triangles of a candidate, if that is in reach.
#[inline(always)]
fn touch(
    local: &TrianglePair,
    candidate: &mut Candidate<Hint>,
    Limits { reach, margin, travel }: Limits,
) -> Option<TriangleContact> {
    let contact = contact_of(local, margin, candidate.hint);
    candidate.clear = contact.map_or(margin, |contact| contact.distance) + travel;
    let contact = contact?;
    candidate.hint = Some(contact.features);
    (contact.distance <= reach).then_some(contact)
}

/// Makes points as deep as a contact that is deeper than all of them.
fn deepen(points: &mut ManifoldPoints, contact: &TriangleContact) {
    let distances = points.iter().map(|point| point.distance);
    let beyond = distances.fold(f64::INFINITY, f64::min) - contact.distance;
    if beyond > 0.0 {
        for point in points {
            point.point1 += 0.5 * beyond * contact.normal;
            point.point2 -= 0.5 * beyond * contact.normal;
            point.distance -= beyond;
        }
    }
}
