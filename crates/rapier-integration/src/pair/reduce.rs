//! Contact reduction: which contacts make patches, before their points are made.
//!
//! Contacts are grouped by normal. Each group keeps its deepest contact and up to three that span
//! the contact area. Contacts as deep but far from that area make patches of their own. Within the area
//! a contact adds nothing: the velocities of a rigid body along the normal are linear there.

use std::cmp::Ordering;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::{Pose, Real};
use parry3d::query::TrackedContact;

/// Points of a patch. Rapier's solver uses no more.
pub(super) const MOST_POINTS: usize = 4;

/// Least cosine of normals of one patch. Higher: more points, and nested bowls are less calm; lower:
/// gears lose speed.
const SAME_NORMAL: Real = 0.99;

/// Least cosine of normals of one patch of [far](PatchPlan::far) contacts. Higher: more points; lower:
/// contacts about to touch are left out.
const SAME_FAR_NORMAL: Real = 0.97;

/// Least cosine of the normals of a contact and of one that it [hovers](PatchPlan::hover_distance)
/// beside. Higher: more points in piles at rest; lower: contacts about to touch are left out.
const SAME_NORMAL_OVER: Real = 0.9;

/// [`PatchPlan::hover_distance`] as a share of the prediction distance. Higher: more points; lower:
/// bodies in motion come deeper into others.
const HOVER: Real = 0.1;

/// Filter distance in radii of the smaller shape. Higher: plates that soft CCD sees turn through what
/// they meet; lower: small bodies keep contacts at internal edges.
pub(super) const FILTERED: Real = 0.1;

/// [`PatchPlan::equal_depth`] as a share of the prediction distance. Higher: points that hover replace points that carry, and
/// bodies rock; lower: thin plates turn through what they hit.
const EQUAL_DEPTH: Real = 0.02;

/// Radius, in prediction distances, below which a convex shape is small. Small shapes turn far in a step, so
/// [`PatchPlan::equal_depth`] grows with the square of their ratio. Higher: cones on uneven ground stay awake. Lower: coins stand on
/// one arc of the rim, and turn through floors.
const SMALL: Real = 20.0;

/// Share of the depth of the deepest point that counts like [`PatchPlan::equal_depth`] where points are chosen. Higher: points
/// that hover replace points that carry. Lower: thin discs stand on one arc of the rim, and turn through floors.
const SUNK: Real = 0.5;

/// [`PatchPlan::one_normal`]. Lower: threads of a screw lock.
const ONE_NORMAL: Real = 0.99999;

/// [`PatchPlan::size`] in radii of the smaller shape. Higher: legs of a table are left out; lower: a
/// flat side is many patches, and points that move lose their data.
const PATCH_SIZE: Real = 0.2;

/// Distances and cosines by which contacts make patches.
#[derive(Copy, Clone, Debug)]
pub(crate) struct PatchPlan {
    /// Filter distance of surfaces. A contact beyond it joins patches by [`SAME_FAR_NORMAL`]. A patch of
    /// such contacts is one manifold.
    pub(super) far: Real,
    /// Distance beyond which a contact hovers: near one that touches, it joins its patch by
    /// [`SAME_NORMAL_OVER`]. Infinite if the prediction distance is a tenth of the radius or more.
    hover_distance: Real,
    /// Difference to the deepest contact of a patch up to which another counts as equally deep.
    pub(super) equal_depth: Real,
    /// Contacts closer than this to the hull of the chosen ones are dropped. A point that has moved by no more is
    /// the same point.
    pub(super) size: Real,
    /// Least cosine of normals of one manifold of a patch.
    pub(super) one_normal: Real,
}

impl PatchPlan {
    /// Plan where all contacts are far: one patch for each direction. The deepest contact may change
    /// before they touch, and Rapier's solver leaves one point of two equal manifolds that have more
    /// than four.
    pub(super) const ALL_FAR: Self = Self {
        far: Real::INFINITY,
        hover_distance: Real::INFINITY,
        equal_depth: Real::INFINITY,
        size: Real::INFINITY,
        one_normal: -1.0,
    };

    /// Plan for a mesh and a convex shape, which may have a round rim.
    pub(super) fn of_convex(prediction: Real, radius: Real) -> Self {
        let plan = Self::new(prediction, radius);
        let small = (SMALL * prediction / radius).max(1.0);
        Self { equal_depth: small * small * plan.equal_depth, ..plan }
    }

    /// Plan for two shapes, from the radius of the smaller one.
    pub(super) fn new(prediction: Real, radius: Real) -> Self {
        let far = FILTERED * radius;
        let hover_distance = if prediction < far { HOVER * prediction } else { Real::INFINITY };
        Self {
            far,
            hover_distance,
            equal_depth: EQUAL_DEPTH * if prediction > 0.0 { prediction } else { far },
            size: PATCH_SIZE * radius,
            one_normal: ONE_NORMAL,
        }
    }
}

/// A contact as contact reduction sees it: in the frame of shape 1, or of a part.
#[derive(Copy, Clone)]
pub(crate) struct ContactSummary {
    /// Points of parts with poses of their own cannot be in one manifold.
    pub(super) part: u32,
    /// Unit vector across the contact.
    pub(super) normal: Vec3,
    pub(super) point: Vec3,
    pub(super) distance: Real,
}

impl ContactSummary {
    /// Returns the point and the distance.
    pub(super) fn place(&self) -> (Vec3, Real) {
        (self.point, self.distance)
    }
}

/// Memory for contact reduction.
#[derive(Default)]
pub(crate) struct Reduction {
    pub(super) members: Vec<Member>,
    /// First contacts of patches, by part, by direction and then by place.
    seeds: Vec<ContactSummary>,
    pub(super) places: Vec<(Vec3, Real)>,
    pub(super) beyond: Beyond,
    /// Points of the chosen contacts of a patch.
    pub(super) points: Vec<PatchPoint>,
}

/// A contact and its patch.
pub(super) struct Member {
    pub(super) summary: ContactSummary,
    /// Index among the contacts.
    pub(super) contact: u32,
    pub(super) patch: u32,
}

/// A point of a chosen contact.
#[derive(Copy, Clone)]
pub(super) struct PatchPoint {
    pub(super) point: TrackedContact<()>,
    /// Index of the contact.
    pub(super) contact: u32,
    pub(super) normals: [Vec3; 2],
    pub(super) poses: [Option<Pose>; 2],
}

/// Patch number of a contact that is left out.
const NO_PATCH: u32 = u32::MAX;

/// Orders by depth, and contacts of equal depth by index.
fn by_depth(a: &Member, b: &Member) -> Ordering {
    let by_depth = a.summary.distance.total_cmp(&b.summary.distance);
    by_depth.then(a.contact.cmp(&b.contact))
}

impl Reduction {
    /// Assigns contacts to patches and removes those that no patch needs. The members of a patch
    /// follow each other, the deepest first. Contacts without a summary count as absent.
    pub(super) fn reduce(
        &mut self,
        plan: PatchPlan,
        summaries: impl Iterator<Item = Option<ContactSummary>>,
    ) {
        let members = (0..)
            .zip(summaries)
            .filter_map(|(contact, summary)| Some(Member { summary: summary?, contact, patch: 0 }));
        self.members.clear();
        self.members.extend(members);
        self.group_by_normal(plan);
        self.split_by_place(plan);
    }

    fn group_by_normal(&mut self, plan: PatchPlan) {
        let Self { members, seeds, .. } = self;
        let part = |member: &Member| member.summary.part;
        members.sort_unstable_by(|a, b| part(a).cmp(&part(b)).then_with(|| by_depth(a, b)));
        seeds.clear();
        for members in members.chunk_by_mut(|a, b| part(a) == part(b)) {
            let first = seeds.len();
            for Member { summary, patch, .. } in members {
                let is_far = summary.distance > plan.far;
                let same_normal = if is_far { SAME_FAR_NORMAL } else { SAME_NORMAL };
                let hovers = |seed: &ContactSummary| {
                    summary.distance > plan.hover_distance
                        && seed.distance <= 0.0
                        && seed.point.distance(summary.point) <= plan.size
                };
                let is_like = |seed: &ContactSummary| {
                    let cosine = seed.normal.dot(summary.normal);
                    cosine >= same_normal || cosine >= SAME_NORMAL_OVER && hovers(seed)
                };
                *patch = first as u32 + seed_of(seeds, first, is_like, summary);
            }
        }
        members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
    }

    fn split_by_place(&mut self, plan: PatchPlan) {
        let Self { members, seeds, places, beyond, .. } = self;
        seeds.clear();
        let mut count = 0;
        for members in members.chunk_by_mut(|a, b| a.patch == b.patch) {
            places.clear();
            places.extend(members.iter().map(|Member { summary, .. }| summary.place()));
            let ContactSummary { normal, distance: deepest, .. } = members[0].summary;
            let chosen = plan.outermost(places, normal, beyond);
            let first = seeds.len();
            for (i, Member { summary, patch, .. }) in members.iter_mut().enumerate() {
                let mut is_needless = || {
                    summary.distance - deepest > plan.equal_depth
                        || beyond.squares()[i] <= plan.size * plan.size
                };
                *patch = if chosen.contains(&i) {
                    count
                } else if is_needless() {
                    NO_PATCH
                } else {
                    let is_there =
                        |seed: &ContactSummary| seed.point.distance(summary.point) <= plan.size;
                    count + 1 + seed_of(seeds, first, is_there, summary)
                };
            }
            count += 1 + (seeds.len() - first) as u32;
        }
        members.retain(|member| member.patch != NO_PATCH);
        members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
    }
}

/// Returns the index, counted from `start`, of the first seed that fits, or of a new one.
fn seed_of(
    seeds: &mut Vec<ContactSummary>,
    start: usize,
    fits: impl Fn(&ContactSummary) -> bool,
    new: &ContactSummary,
) -> u32 {
    let place = seeds[start..].iter().position(fits).unwrap_or_else(|| {
        seeds.push(*new);
        seeds.len() - 1 - start
    });
    place as u32
}

/// Indices of points.
pub(super) type Chosen = ArrayVec<usize, MOST_POINTS>;

/// Memory for the distances of points from the convex hull of the chosen ones, seen along a normal.
#[derive(Default)]
pub(super) struct Beyond {
    /// The points, seen along the normal.
    flat: Vec<Vec3>,
    /// Squares of the distances.
    squares: Vec<Real>,
    corners: ArrayVec<Vec3, MOST_POINTS>,
    /// The chosen points that the distances are from. The last one may be missing.
    known: usize,
    /// Unit vector across the contacts.
    normal: Vec3,
}

impl Beyond {
    fn begin(&mut self, points: &[(Vec3, Real)], normal: Vec3) {
        let flat = |&(point, _): &(Vec3, Real)| point - normal.dot(point) * normal;
        self.flat.clear();
        self.flat.extend(points.iter().map(flat));
        self.squares.clear();
        self.squares.resize(points.len(), Real::INFINITY);
        self.corners.clear();
        (self.known, self.normal) = (0, normal);
    }

    fn add(&mut self, index: usize) {
        self.corners.push(self.flat[index]);
    }

    /// Returns the squares of the distances of all points.
    fn squares(&mut self) -> &[Real] {
        for (i, &corner) in self.corners.iter().enumerate().skip(self.known) {
            let before = &self.corners[..i];
            for (&point, square) in self.flat.iter().zip(&mut self.squares) {
                if *square > 0.0 {
                    *square = square.min(beyond(point, corner, before, self.normal));
                }
            }
        }
        self.known = self.corners.len();
        &self.squares
    }
}

/// Returns the square of the distance of a point from the segments and triangles between a corner and others.
fn beyond(point: Vec3, corner: Vec3, others: &[Vec3], normal: Vec3) -> Real {
    let side = |a: Vec3, b: Vec3| (b - a).cross(point - a).dot(normal);
    let mut least = corner.distance_squared(point);
    for (i, &other) in others.iter().enumerate() {
        least = least.min(to_segment(corner, other, point));
        let is_inside = |third: &Vec3| {
            let sides = [side(corner, other), side(other, *third), side(*third, corner)];
            sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
        };
        if others[..i].iter().any(is_inside) {
            return 0.0;
        }
    }
    least
}

/// Returns the square of the distance of a point from a segment.
fn to_segment(a: Vec3, b: Vec3, point: Vec3) -> Real {
    let (along, way) = (b - a, point - a);
    let length = along.length_squared();
    let share = if length > 0.0 { along.dot(way) / length } else { 0.0 };
    (way - along * share.clamp(0.0, 1.0)).length_squared()
}

/// Least distance of a chosen point from the hull, in distances between the first two points. Higher: narrow
/// sides lose corners; lower: rounding adds points to a line.
const LINE: Real = 1.0e-3;

impl PatchPlan {
    /// Returns up to four of `points`, which have distances. The first one is deepest. The body reaches the
    /// others after the least turn. They are far outside the convex hull, seen along `normal`, and hardly above the first one,
    /// compared with its depth.
    pub(super) fn outermost(
        self,
        points: &[(Vec3, Real)],
        normal: Vec3,
        beyond: &mut Beyond,
    ) -> Chosen {
        if points.len() <= MOST_POINTS {
            return (0..points.len()).collect();
        }
        beyond.begin(points, normal);
        let (mut chosen, (_, deepest)) = (Chosen::from_iter([0]), points[0]);
        let equal_depth = self.equal_depth + SUNK * (-deepest).max(0.0);
        beyond.add(0);
        let mut least = 0.0;
        while !chosen.is_full() {
            let weighed = points.iter().zip(beyond.squares()).map(|((_, distance), square)| {
                let hover = (distance - deepest).max(0.0) / equal_depth;
                square / (1.0 + hover).powi(2)
            });
            let farthest = |most: (usize, Real), next: (usize, Real)| {
                if next.1 > most.1 { next } else { most }
            };
            let (next, square) = weighed.enumerate().fold((0, least), farthest);
            if next == 0 {
                break;
            }
            chosen.push(next);
            beyond.add(next);
            if least == 0.0 {
                least = LINE * LINE * square;
            }
        }
        // Points about as far from the others must not change places from step to step.
        if let [first, second, third, _] = beyond.corners[..]
            && (second - first).cross(third - first).dot(normal) > 0.0
        {
            chosen.swap(2, 3);
        }
        chosen
    }
}

#[cfg(test)]
mod tests;
