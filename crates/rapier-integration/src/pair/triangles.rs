//! Contacts of a mesh and another mesh or a height field.
//!
//! Each candidate is a pair of triangles with an exact contact
//! ([`sbbk_core::contact`](mod@sbbk_core::contact)). The first pass keeps those that are contacts
//! of the surfaces ([`SurfaceFilter`]). A second pass adds contacts to crossing triangles that too
//! few contacts push apart ([`OverlapIslands`]).
//!
//! Stock Parry finds no contacts of a mesh and a height field. Triangles of a field have the
//! numbers that Parry gives them in contacts with convex shapes.
//!
//! Hosts drop the workspace of a pair when they edit a shape. If a host does not, another field,
//! scale or flag is noticed at once. A removed triangle is noticed when the pair moves, and an
//! added one at the next descent.

mod overlaps;

use std::cell::Cell;
use std::sync::OnceLock;
use std::thread::LocalKey;

use glamx::DVec3;
use parry3d::math::Real;
use sbbk_core::contact::{ManifoldPoints, TriangleContact, clip, push_closest};
use sbbk_core::surface::{Side, longest_side};
use sbbk_core::traverse::{DescentCounts, SlackLimits};

use super::borders::meet_borders;
use super::contours::ContourMemory;
use super::descents::{ChunkResult, DescentMemory, in_chunks};
use super::field::FieldToken;
use super::islands::OverlapIslands;
use super::pose::{Moving, PairPose};
use super::query::{Candidate, ContactList, ContactPoints, Limits, Memory, Pair, PairQuery};
use super::reduce::{ContactSummary, PatchPlan};
use super::shapes::{
    ContactSource, Hint, NEARLY_TOUCHING, Room, ShapeView, TriangleHit, TriangleShape,
    TriangleShapes, TriangleSurfaceContact, as_cones, contact_of, filter_distance,
};
use super::sides::{HeldMesh, InsideTest};
use super::surface::{SurfaceFilter, Verdict, leans};
use super::triangle_points::{constrained_normal, write_triangle_points};
use super::tuning::DEEPEST;
use super::ways::resting_depth;
use crate::SbbkConfig;
use crate::mesh::{Change, KnownMesh, LazySurface, use_trees};

/// Least number of candidates of a chunk. Higher: threads wait for each other; lower: threads
/// take turns for chunks of a few microseconds.
const LEAST_CANDIDATES: usize = 256;

/// Share of the least distance below which a distance is less. Higher: rounding decides where
/// triangles have equal distances.
const NEARER: f64 = 0.999;

/// A query about two shapes made of triangles.
pub(crate) struct TriangleQuery<'q> {
    pub(super) shapes: TriangleShapes<'q>,
    pub(super) patches: Option<PatchPlan>,
    /// See [`KnownPair`].
    in_room: &'q InsideTest,
    inside: &'q mut InsideTest,
}

/// A mesh and another mesh or a height field.
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) shapes: [ShapeView<'a>; 2],
    pub(crate) config: &'a SbbkConfig,
}

/// Knowledge that a pair keeps from query to query.
#[derive(Clone, Default)]
pub(crate) struct KnownPair {
    shapes: [KnownShape; 2],
    /// Tells if one mesh is a room for the other.
    in_room: InsideTest,
    /// Tells if one mesh is inside the other.
    inside: InsideTest,
}

/// A pair's knowledge of one of its shapes, which is a mesh or a field.
#[derive(Clone, Default)]
pub(crate) struct KnownShape {
    mesh: KnownMesh,
    field: Option<FieldToken>,
}

impl KnownShape {
    /// Compares with the shape of the last query, and stores the one of this query.
    fn update(&mut self, shape: &ShapeView<'_>) -> Change {
        let field = match shape {
            ShapeView::Mesh(mesh) => {
                self.field = None;
                return self.mesh.update(mesh);
            }
            ShapeView::Field(field) => FieldToken::of(field.0),
        };
        match self.field.replace(field) {
            None => {
                self.mesh = KnownMesh::default();
                Change::Unknown
            }
            Some(known) if known == field => Change::Unchanged,
            Some(_) => Change::Replaced,
        }
    }
}

impl MeshPair<'_> {
    /// Returns true for two meshes that use trees.
    fn needs_trees(&self) -> bool {
        let [ShapeView::Mesh(one), ShapeView::Mesh(two)] = &self.shapes else { return false };
        use_trees([one.mesh, two.mesh])
    }

    /// Returns true if no shape can change while its token stays.
    fn are_rigid(&self) -> bool {
        self.shapes.iter().all(|shape| match shape {
            ShapeView::Mesh(mesh) => mesh.is_rigid(),
            ShapeView::Field(_) => true,
        })
    }

    /// Returns true for contacts of surfaces.
    fn has_surfaces(&self) -> bool {
        self.config.wants_surfaces() && self.are_rigid()
    }

    /// Begins a query of a shape. Meshes get trees for each other.
    fn opened<'q>(&self, view: &'q ShapeView<'q>, known: &'q mut KnownShape) -> TriangleShape<'q> {
        let (has_surfaces, needs_trees) = (self.has_surfaces(), self.needs_trees());
        let (mut surface, mut side) = (None, None);
        match view {
            ShapeView::Mesh(mesh) => {
                let is_needed = has_surfaces || needs_trees && self.are_rigid();
                surface = is_needed.then(|| known.mesh.acquire(mesh, needs_trees)).flatten();
            }
            ShapeView::Field(field) => {
                let is_solid = self.config.solid_height_fields && field.points_up();
                let of_ground = if is_solid { Side::Outer } else { Side::Sheet };
                side = has_surfaces.then_some(of_ground);
            }
        }
        let tree = surface.as_ref().and_then(LazySurface::tree).filter(|_| needs_trees);
        let surface = surface.filter(|_| has_surfaces);
        TriangleShape { view, surface, tree, room: Room::No, side }
    }
}

impl<'a> Pair for MeshPair<'a> {
    type State = KnownPair;
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q>
    where
        Self: 'q;

    fn pose(&self) -> &PairPose {
        self.pose
    }

    fn update(&self, KnownPair { shapes, in_room, inside }: &mut KnownPair) -> Change {
        let [shape1, shape2] = &self.shapes;
        let change = shapes[0].update(shape1).max(shapes[1].update(shape2));
        if change != Change::Unchanged {
            (*in_room, *inside) = Default::default();
        }
        change
    }

    fn open<'q>(&'q self, known: &'q mut KnownPair) -> TriangleQuery<'q> {
        let KnownPair { shapes: [known1, known2], in_room, inside } = known;
        let [shape1, shape2] = &self.shapes;
        let [shape1, shape2] = [self.opened(shape1, known1), self.opened(shape2, known2)];
        let radius = shape1.ball().radius.min(shape2.ball().radius);
        let mut shapes = TriangleShapes {
            pose: self.pose,
            larger: usize::from(shape1.size_squared() < shape2.size_squared()),
            shapes: [shape1, shape2],
            filter_distance: filter_distance(self.has_surfaces(), radius),
            reach: OnceLock::new(),
            over_sheets: Default::default(),
        };
        let room = HeldMesh::of(&shapes).map_or(Room::No, |mesh| mesh.room(in_room));
        shapes.shapes[shapes.larger].room = room;
        let has_patches = self.config.has_patches() && self.are_rigid();
        let patches = has_patches.then(|| PatchPlan::new(self.pose.prediction, radius));
        TriangleQuery { shapes, patches, in_room, inside }
    }
}

/// Memory for queries.
#[derive(Default)]
pub(crate) struct TriangleScratch {
    descent: DescentMemory,
    first: FirstPass,
    contours: ContourMemory,
    /// Normals of contacts.
    directions: Vec<DVec3>,
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
        self.islands.crossings.extend(next.islands.crossings);
        self.islands.touching.extend(next.islands.touching);
        self.is_near |= next.is_near;
    }
}

thread_local! {
    static MEMORY: Memory<TriangleQuery<'static>> = Cell::default();
}

impl PairQuery for TriangleQuery<'_> {
    type Hint = Hint;
    type Contact = TriangleSurfaceContact;
    type Scratch = TriangleScratch;

    const SLACK: SlackLimits = SlackLimits::TRIANGLES;

    fn memory() -> &'static LocalKey<Memory<Self>> {
        &MEMORY
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
        let TriangleScratch { first, contours, directions, .. } = scratch;
        first.clear();
        std::mem::swap(&mut first.contacts, contacts);
        let pass = |chunk: &mut [_], first: &mut FirstPass| {
            chunk.iter_mut().for_each(|candidate| self.first_pass(candidate, limits, first));
        };
        in_chunks(candidates, LEAST_CANDIDATES, first, &pass);
        first.islands.keep_passed_if_crossing();
        self.add_passing(first);
        std::mem::swap(&mut first.contacts, contacts);
        let FirstPass { islands, is_near, upright, .. } = first;
        if self.shapes.is_side_doubtful(&islands.crossings) {
            return self.hold(candidates, limits, contacts);
        }
        let lead_one_way = meet_borders(upright, contacts);
        if !islands.crossings.is_empty() {
            self.add_island_contacts(islands, contours, contacts);
        }
        let small = resting_depth(self.shapes.filter_distance);
        if islands.settle_one_ways(small, |pair, way, length| self.is_parted(pair, way, length)) {
            self.second_pass(islands, contacts);
        }
        self.drop_lifted(&islands.one_ways, contacts);
        if limits.reach < f64::from(self.shapes.pose.prediction) {
            self.shapes.add_far(!*is_near, lead_one_way, contacts);
        } else if limits.reach > self.shapes.filter_distance {
            self.shapes.thin_out_far(directions, islands, contacts);
        }
        self.add_if_all_apart(islands, contacts);
        self.shapes.reject_through(&islands.crossings, contacts);
        if contacts.is_empty() {
            let held = HeldMesh::of(&self.shapes);
            contacts.extend(held.and_then(|held| held.push_out(self.inside)));
        }
        if contacts.is_empty() {
            contacts.extend(self.of_overlaps(islands));
        }
    }

    /// Makes one patch for each direction if all contacts are beyond the filter distance. Rapier's
    /// solver drops such points of manifolds of more than four, and a falling plate would turn
    /// about one point.
    fn reduction(&self, contacts: &ContactList<TriangleSurfaceContact>) -> Option<PatchPlan> {
        let near = self.shapes.filter_distance;
        let may_be_far = f64::from(self.shapes.pose.prediction) > near;
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
        let (pair, TriangleSurfaceContact { contact, .. }) = hit;
        let corners = [self.shapes[0].corners(pair[0])?, self.shapes[1].corners(pair[1])?];
        let [[origin, ..], _] = corners;
        let [side1, side2] = corners.map(|of| longest_side(&of.map(|corner| corner.as_dvec3())));
        let of_triangles = self.shapes.cones(*pair);
        let cones = as_cones(&of_triangles);
        let normal = constrained_normal(contact, cones, &self.shapes.pose.pos12)?;
        let point = (origin.as_dvec3() + contact.point1).as_vec3();
        let mut distance = contact.distance as Real;
        if cones.iter().any(Option::is_some) {
            // Cones move points.
            self.points(hit, scratch, points);
            distance = points.points.iter().map(|point| point.dist).reduce(Real::min)?;
        }
        let spread = side1.min(side2) as Real;
        Some(ContactSummary { part: 0, normal, point, distance, spread })
    }

    #[inline(always)]
    fn points(
        &mut self,
        (pair, TriangleSurfaceContact { contact, source }): &TriangleHit,
        _: &mut TriangleScratch,
        points: &mut ContactPoints,
    ) {
        let shapes = &self.shapes;
        let clipped = &mut ManifoldPoints::new();
        points.points.clear();
        let Some(local) = shapes.local(*pair) else { return };
        let of_triangles = shapes.cones(*pair);
        let [t1, t2] = &local.corners;
        if *source != ContactSource::PushOut {
            clip(t1, t2, contact.normal, clipped);
        }
        if *source == ContactSource::OutwardAxis {
            deepen(clipped, contact);
        } else {
            push_closest(t1, t2, contact, clipped);
        }
        let pose = shapes.pose;
        let leans = || local.corners.iter().any(|corners| leans(corners, contact.normal));
        if contact.distance > shapes.filter_distance && leans() {
            // Other triangles hide the far end of one that stands beside the normal.
            let within = f64::from(pose.prediction).max(contact.distance);
            clipped.retain(|point| point.distance <= within);
        }
        let deepest = -shapes.filter_distance.max(DEEPEST * f64::from(pose.prediction));
        clipped.iter_mut().for_each(|point| point.distance = point.distance.max(deepest));
        write_triangle_points(pose, &local, contact, clipped, as_cones(&of_triangles), points);
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
        let contact = contact_of(&local, limits.margin, candidate.hint);
        candidate.touches_at =
            contact.map_or(limits.margin, |contact| contact.distance) + limits.travel;
        let Some(contact) = contact else { return };
        candidate.hint = Some(contact.features);
        if contact.distance > limits.reach {
            return;
        }
        first.is_near = true;
        let Some(filter) = SurfaceFilter::new(&self.shapes, pair, &local) else {
            return first.contacts.push((pair, TriangleSurfaceContact::of_triangles(contact)));
        };
        match filter.apply(contact, true) {
            Verdict::None
                if filter.is_touching(&contact, NEARLY_TOUCHING) && !filter.has_wall_within() =>
            {
                first.islands.touching.push(pair);
            }
            Verdict::None => {}
            Verdict::Passing => first.passing.push((pair, contact)),
            Verdict::Contact(contact, upright) => {
                first.contacts.push((pair, contact));
                first.upright.extend(upright.map(|upright| (pair, upright)));
            }
            Verdict::Crossing(crossing) => first.islands.crossings.push(crossing),
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
        let within = f64::from(self.shapes.pose.prediction);
        let contact = |of: &Candidate<Hint>| {
            let has_contacts = |filter: &SurfaceFilter<'_>| !filter.has_wall_within();
            let counts = self.shapes.with_filter(of.subshapes, has_contacts) == Some(true);
            counts.then(|| self.shapes.contact_within(of.subshapes, within)).flatten()
        };
        let is_near = |(_, hit): &TriangleHit| hit.contact.distance <= limits.reach;
        let may_touch = candidates.iter().filter(|candidate| limits.may_touch(candidate));
        contacts.extend(may_touch.filter_map(contact).filter(is_near));
    }

    /// Adds the contacts of edges and vertices that may pass each other, if they are nearer than
    /// all other contacts.
    fn add_passing(&self, first: &mut FirstPass) {
        let FirstPass { contacts, upright, passing, islands, .. } = first;
        if passing.is_empty() || !islands.crossings.is_empty() {
            return;
        }
        let old_count = contacts.len();
        let distances = contacts.iter().map(|(_, hit)| hit.contact.distance);
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let is_nearest = |contact: &TriangleContact| contact.distance < NEARER * nearest;
        for &(pair, contact) in passing.iter().filter(|(_, contact)| is_nearest(contact)) {
            let verdict = self.shapes.with_filter(pair, |filter| filter.apply(contact, false));
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
