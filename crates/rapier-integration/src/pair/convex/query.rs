//! The contact query of a mesh and one or more convex shapes.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::thread::LocalKey;

use glamx::DVec3;
use parry3d::math::Real;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::Ball;
use sbbk_core::contact::convex::{ConvexContact, PointSupport, convex_contact};
use sbbk_core::traverse::{BoxTest, DescentCounts, MovingBody, SlackLimits, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::contact::{Hit, PartContact, core_contact};
use super::ghosts::GhostContacts;
use super::near::triangles_near;
use super::pair::ConvexPair;
use super::parts::{Part, PartData, Parts, PlacedPart};
use super::shape::ConvexShape;
use super::triangle_part::TrianglePartPair;
use crate::mesh::{Change, KnownMesh, LazySurface};
use crate::pair::pose::{Moving, PairPose};
use crate::pair::query::{Candidate, ContactList, ContactPoints, Limits, Memory, Pair, PairQuery};
use crate::pair::reduce::{ContactSummary, PatchPlan};
use crate::pair::ways::Ways;

impl<'a> Pair for ConvexPair<'a> {
    /// Data of the mesh and of the parts that the candidates belong to.
    type State = (KnownMesh, PartData);
    type Hint = ();
    type Query<'q>
        = ConvexQuery<'q>
    where
        Self: 'q;

    fn pose(&self) -> &PairPose {
        self.pose
    }

    fn update(&self, (known_mesh, part_data): &mut Self::State) -> Change {
        let change = known_mesh.update(&self.mesh);
        if part_data.update(&self.parts) { Change::Replaced } else { change }
    }

    fn open<'q>(&'q self, (known_mesh, part_data): &'q mut Self::State) -> Self::Query<'q> {
        let needs_surface = self.config.leave_solids() || self.has_surface();
        let surface = needs_surface.then(|| known_mesh.acquire(&self.mesh, false)).flatten();
        ConvexQuery { pair: self, part_data, surface }
    }
}

/// A contact query of a mesh and its convex shapes.
pub(crate) struct ConvexQuery<'q> {
    pub(super) pair: &'q ConvexPair<'q>,
    pub(super) part_data: &'q PartData,
    /// Surface of the mesh, for push-outs, borders and walls within the mesh.
    pub(super) surface: Option<LazySurface<'q>>,
}

/// Memory for queries.
#[derive(Default)]
pub(crate) struct ConvexScratch {
    pub(super) at_hand: PlacedParts,
    pub(super) ghosts: GhostContacts,
    pub(super) dropped: DroppedContacts,
    /// Parts with the distances of their contacts, and push-outs.
    pub(super) push_outs: (Vec<(u32, f64)>, ContactList<PartContact>),
    /// True for each vertex of the mesh that has a contact with a [half-space](super::half_space).
    /// All false between queries.
    pub(super) is_vertex_known: Vec<bool>,
}

/// Parts at the pose of the query.
pub(super) type PlacedParts = Vec<Option<PlacedPart>>;

/// Memory for the search for [walls](super::walls).
#[derive(Default)]
pub(super) struct DroppedContacts {
    /// True for each contact that is removed.
    pub(super) removed: Vec<bool>,
    /// Contacts apart, the nearest first.
    pub(super) apart: Vec<usize>,
    /// Ways out of the triangles, by part.
    pub(super) ways: Ways,
}

impl DroppedContacts {
    /// Removes the marked contacts.
    pub(super) fn remove_from(&self, contacts: &mut ContactList<PartContact>) {
        let mut removed = self.removed.iter();
        contacts.retain(|_| removed.next() != Some(&true));
    }
}

thread_local! {
    static MEMORY: Memory<ConvexQuery<'static>> = Cell::default();
}

impl ConvexQuery<'_> {
    /// Calls `then` with the triangle and the part that two subshapes are.
    #[inline(always)]
    pub(super) fn with_pair<T>(
        &self,
        subshapes: [u32; 2],
        at_hand: &mut PlacedParts,
        then: impl FnOnce(TrianglePartPair<'_>) -> T,
    ) -> Option<T> {
        let ConvexPair { mesh, parts, mesh_place, .. } = self.pair;
        let [triangle, part] = mesh_place.swap(subshapes);
        let cone = if self.pair.has_surface() {
            None
        } else {
            mesh.mesh.triangle_normal_constraints(triangle)
        };
        let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
        let corners = mesh.corners(triangle);
        parts.with(part, |shape| {
            let placed = self.placed(part, &shape, at_hand);
            then(TrianglePartPair { pair: self.pair, placed, part: &shape, corners, cone })
        })
    }

    /// Returns a part at its pose.
    #[inline]
    pub(super) fn placed<'s>(
        &self,
        index: u32,
        part: &Part<'_>,
        at_hand: &'s mut PlacedParts,
    ) -> &'s PlacedPart {
        /// Parts kept at a time. Higher: more memory; lower: parts of large compounds are placed
        /// again.
        const AT_HAND: usize = 64;
        let slot = index as usize % AT_HAND;
        if at_hand.len() <= slot {
            at_hand.resize_with(slot + 1, || None);
        }
        at_hand[slot].take_if(|placed| placed.index != index);
        at_hand[slot].get_or_insert_with(|| {
            let placements = self.pair.mesh_place.placements(self.pair.pose);
            let extent = self.part_data.extent(index, part);
            let has_mesh_axes = matches!(part.shape, ConvexShape::Ball(_));
            PlacedPart { has_mesh_axes, ..PlacedPart::new(index, part, placements, extent) }
        })
    }
}

impl PairQuery for ConvexQuery<'_> {
    type Hint = ();
    type Contact = PartContact;
    type Scratch = ConvexScratch;

    /// Larger than for two meshes, as candidates out of reach cost little. Higher: slower in fast
    /// motion; lower: slower in slow motion.
    const SLACK: SlackLimits = SlackLimits { steps: 16.0, greatest: 5.0 };

    fn memory() -> &'static LocalKey<Memory<Self>> {
        &MEMORY
    }

    fn moving(&self) -> Moving {
        let (mesh, parts) = (self.pair.mesh.ball(), self.part_data.ball);
        let is_ball = self.pair.is_ball();
        // The smaller body moves less when it rotates.
        let is_mesh = mesh.radius <= parts.radius && !is_ball;
        let shape = usize::from(self.pair.mesh_place.is_second() == is_mesh);
        let ball = if is_mesh { mesh } else { parts };
        Moving { body: MovingBody { ball, is_ball }, shape }
    }

    fn calm(&self) -> f64 {
        if self.pair.config.leave_solids() { 0.0 } else { f64::INFINITY }
    }

    /// Returns the prediction distance plus the rounding of sixty operations on the largest
    /// coordinates. The rounding exceeds the error of contacts with curved shapes, 1e-7 of the
    /// distance.
    fn reach(&self) -> Real {
        let offset = self.pair.pose.pos12.translation.abs().max_element();
        let largest = self.pair.mesh.magnitude() + offset + self.part_data.magnitude;
        (self.pair.pose.prediction.max(0.0) + gamma(64) * largest).min(Real::MAX)
    }

    fn begin(&self, scratch: &mut ConvexScratch) {
        scratch.at_hand.clear();
    }

    /// Serves balls, whose contacts cost less than a list of candidates.
    fn contacts_without_candidates(
        &mut self,
        margin: Real,
        counts: &mut DescentCounts,
        scratch: &mut ConvexScratch,
        contacts: &mut ContactList<PartContact>,
    ) -> bool {
        let Parts::One(shape @ ConvexShape::Ball(ball)) = self.pair.parts else { return false };
        let part = Part { pose: None, shape, cone: None };
        let placed = self.placed(0, &part, &mut scratch.at_hand);
        triangles_near(placed, shape, &self.pair.mesh, margin, counts, |triangle| {
            self.add_ball(triangle, ball, placed, margin.into(), contacts);
            ControlFlow::Continue(())
        });
        contacts.sort_unstable_by_key(|(subshapes, _)| *subshapes);
        self.end_ball(scratch, contacts);
        true
    }

    fn descend(
        &mut self,
        margin: Real,
        counts: &mut DescentCounts,
        scratch: &mut ConvexScratch,
        found: &mut Vec<Candidate<()>>,
    ) {
        let ConvexPair { ref mesh, parts, mesh_place, .. } = *self.pair;
        parts.intersecting(&self.pair.mesh_box(margin), self.near_mesh(margin), |index| {
            parts.with(index, |part| {
                let placed = self.placed(index, &part, &mut scratch.at_hand);
                triangles_near(placed, part.shape, mesh, margin, counts, |triangle| {
                    found.push(Candidate::new(mesh_place.swap([triangle, index])));
                    ControlFlow::Continue(())
                });
            });
        });
    }

    fn contacts(
        &mut self,
        candidates: &mut [Candidate<()>],
        limits: Limits,
        scratch: &mut ConvexScratch,
        contacts: &mut ContactList<PartContact>,
    ) {
        if let Some(half_space) = self.pair.half_space_by_vertices() {
            self.add_vertices(half_space, candidates, limits, scratch, contacts);
            return;
        }
        if let Parts::One(shape @ ConvexShape::Ball(ball)) = self.pair.parts {
            let part = Part { pose: None, shape, cone: None };
            let placed = self.placed(0, &part, &mut scratch.at_hand);
            for candidate in candidates.iter_mut().filter(|it| limits.may_touch(it)) {
                let [triangle, _] = self.pair.mesh_place.swap(candidate.subshapes);
                let distance = self.add_ball(triangle, ball, placed, limits.margin, contacts);
                candidate.touches_at = distance + limits.travel;
            }
            self.end_ball(scratch, contacts);
            return;
        }
        for candidate in candidates {
            if limits.may_touch(candidate)
                && let Some(contact) = self.contact(candidate, limits, &mut scratch.at_hand)
            {
                contacts.push((candidate.subshapes, contact));
            }
        }
        self.drop_walls(contacts, &mut scratch.at_hand, &mut scratch.dropped);
        self.add_push_outs(contacts, scratch);
        self.correct(contacts, scratch);
    }

    fn reduction(&self, _: &ContactList<PartContact>) -> Option<PatchPlan> {
        self.pair.has_patches().then(|| {
            let radius = self.part_data.patch_radius(&self.pair.parts);
            PatchPlan::of_convex(
                self.pair.pose.prediction,
                radius.min(self.pair.mesh.ball().radius),
            )
        })
    }

    fn summary(
        &mut self,
        (subshapes, contact): &Hit,
        scratch: &mut ConvexScratch,
        points: &mut ContactPoints,
    ) -> Option<ContactSummary> {
        self.with_pair(*subshapes, &mut scratch.at_hand, |pair| pair.summary(contact, points))?
    }

    #[inline(always)]
    fn points(
        &mut self,
        (subshapes, contact): &Hit,
        scratch: &mut ConvexScratch,
        points: &mut ContactPoints,
    ) {
        points.points.clear();
        self.with_pair(*subshapes, &mut scratch.at_hand, |pair| pair.write(contact, points));
    }
}

impl ConvexQuery<'_> {
    /// Adds the contact of a ball and a triangle within the prediction distance. Returns a lower
    /// bound of their distance, at most `margin`.
    #[inline(always)]
    fn add_ball(
        &self,
        triangle: u32,
        ball: &Ball,
        placed: &PlacedPart,
        margin: f64,
        contacts: &mut ContactList<PartContact>,
    ) -> f64 {
        let ConvexPair { ref mesh, mesh_place, pose, .. } = *self.pair;
        let corners = placed.in_part(mesh.corners(triangle));
        let radius = f64::from(ball.radius);
        let centre = &PointSupport(DVec3::ZERO);
        let Some(contact) = convex_contact(&corners, centre, margin + radius) else {
            return margin;
        };
        let distance = contact.distance - radius;
        if distance <= f64::from(pose.prediction) {
            contacts.push((mesh_place.swap([triangle, 0]), PartContact::new(contact, &corners)));
        }
        distance
    }

    /// Replaces the contacts of a ball by its push-out, if it has one, and corrects the rest.
    fn end_ball(&self, scratch: &mut ConvexScratch, contacts: &mut ContactList<PartContact>) {
        if let Some(push_out) = self.push_out(0, f64::INFINITY, &mut scratch.at_hand) {
            contacts.clear();
            contacts.push(push_out);
        }
        self.correct(contacts, scratch);
    }

    /// Corrects ghosts, and removes contacts that lead past a border or that one way lifts over.
    fn correct(&self, contacts: &mut ContactList<PartContact>, scratch: &mut ConvexScratch) {
        let ConvexScratch { at_hand, ghosts, dropped, .. } = scratch;
        dropped.removed.clear();
        dropped.removed.resize(contacts.len(), false);
        self.correct_ghosts(contacts, at_hand, ghosts);
        self.find_lifted(contacts, at_hand, dropped);
        for upright in ghosts.upright.iter().filter(|upright| upright.is_past) {
            dropped.removed[upright.index as usize] = true;
        }
        dropped.remove_from(contacts);
    }

    /// Returns the normal of a contact in the axes of the mesh. A single part needs no common axes
    /// and keeps its own.
    pub(super) fn shared_normal(
        &self,
        subshapes: [u32; 2],
        contact: &ConvexContact,
        at_hand: &mut PlacedParts,
    ) -> DVec3 {
        let Parts::Many(..) = self.pair.parts else { return contact.normal };
        let in_mesh = |pair: TrianglePartPair<'_>| pair.placed.directions(contact.normal)[0];
        self.with_pair(subshapes, at_hand, in_mesh).unwrap_or(contact.normal)
    }

    /// Returns a test for boxes around some parts: false only if all triangles are farther than
    /// `margin`.
    fn near_mesh(&self, margin: Real) -> impl Fn(TestedBox) -> bool {
        let ConvexPair { mesh, mesh_place, pose, .. } = self.pair;
        let [_, placement] = mesh_place.placements(pose);
        let test = BoxTest::new([mesh.magnitude(), self.part_data.magnitude], placement, margin);
        // Boxes do not contain half-spaces.
        let has_half_space = !self.part_data.ball.radius.is_finite();
        move |parts| {
            let around = test.of(parts);
            has_half_space || mesh.near(|node| around.meets(node)).next().is_some()
        }
    }

    /// Returns the contact of a candidate within the prediction distance.
    #[inline(always)]
    fn contact(
        &self,
        candidate: &mut Candidate<()>,
        limits: Limits,
        at_hand: &mut PlacedParts,
    ) -> Option<PartContact> {
        let [triangle, part] = self.pair.mesh_place.swap(candidate.subshapes);
        let (mesh, part_data) = (&self.pair.mesh, self.part_data);
        self.pair.parts.with(part, |part_shape| {
            let shape = part_shape.shape;
            let placed = self.placed(part, &part_shape, at_hand);
            let radius = f64::from(shape.radius());
            let corners = placed.in_part(mesh.corners(triangle));
            let reach = limits.margin + radius;
            let contact = core_contact(placed, &corners, shape, part_data.hull(part), reach);
            let distance = contact.map_or(limits.margin, |contact| contact.distance - radius);
            candidate.touches_at = distance + limits.travel;
            let is_near = distance <= f64::from(self.pair.pose.prediction);
            contact.filter(|_| is_near).map(|contact| PartContact::new(contact, &corners))
        })?
    }
}
