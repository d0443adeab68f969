//! Contact reduction: chooses the contacts of patches before their points are made, and then
//! points.
//!
//! Contacts are grouped by normal. Each group keeps a deepest contact and up to three that span the
//! contact area. Contacts as deep but far from that area stay, too. Within the area a contact adds
//! nothing: the velocities of a rigid body along the normal are linear there. Wide contacts stay,
//! as one point tells little about them. Points are then chosen in the same way.

use std::cmp::Ordering;

use glamx::{Vec2, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::TrackedContact;

use super::tuning::{
    DEPTH_SHARE, EQUAL_DEPTH, FILTERED, HOVER, NEAR_NORMAL, PATCH_SIZE, SAME_DIRECTION,
    SAME_FAR_DIRECTION, SMALL_RADIUS,
};

/// Points of a patch. Rapier's solver uses no more.
pub(super) const MOST_POINTS: usize = 4;

/// [`PatchPlan::one_normal`]. Lower: threads of a screw lock.
const ONE_NORMAL: Real = 0.99999;

/// Distances and cosines by which contacts make patches.
#[derive(Copy, Clone, Debug)]
pub(crate) struct PatchPlan {
    /// Filter distance of surfaces. A contact beyond it joins patches by [`SAME_FAR_DIRECTION`]. A
    /// patch of such contacts is one manifold.
    pub(super) far: Real,
    /// Distance beyond which a contact hovers: near one that touches, it joins its patch by
    /// [`NEAR_NORMAL`]. Infinite if the prediction distance is a tenth of the radius or more.
    hover_distance: Real,
    /// Difference to the deepest contact of a patch up to which another counts as equally deep.
    pub(super) equal_depth: Real,
    /// Contacts closer than this to the hull of the chosen ones are dropped. A point that has moved
    /// by no more is the same point.
    pub(super) size: Real,
    /// Least cosine of normals of one manifold of a patch.
    pub(super) one_normal: Real,
}

impl PatchPlan {
    /// Plan where all contacts are far: one patch for each direction. The deepest contact may
    /// change before they touch, and Rapier's solver leaves one point of two equal manifolds that
    /// have more than four.
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
        let small = (SMALL_RADIUS * prediction / radius).max(1.0);
        Self { equal_depth: (small * small * plan.equal_depth).min(plan.size), ..plan }
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
    /// Distance from `point` that no point of the contact exceeds.
    pub(super) spread: Real,
}

/// Memory for contact reduction.
#[derive(Default)]
pub(crate) struct Reduction {
    pub(super) members: Vec<Member>,
    /// First contacts of patches, by part and by direction.
    seeds: Vec<ContactSummary>,
    pub(super) places: Vec<(Vec3, Real)>,
    pub(super) outermost: Outermost,
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
        self.keep_outermost(plan);
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
                let same_direction = if is_far { SAME_FAR_DIRECTION } else { SAME_DIRECTION };
                let hovers = |seed: &ContactSummary| {
                    summary.distance > plan.hover_distance
                        && seed.distance <= 0.0
                        && seed.point.distance(summary.point) <= plan.size
                };
                let is_like = |seed: &ContactSummary| {
                    let cosine = seed.normal.dot(summary.normal);
                    cosine >= same_direction as Real
                        || cosine >= NEAR_NORMAL as Real && hovers(seed)
                };
                let known = seeds[first..].iter().position(is_like);
                *patch = known.map_or(seeds.len(), |i| first + i) as u32;
                if known.is_none() {
                    seeds.push(*summary);
                }
            }
        }
        members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
    }

    /// Keeps the outermost contacts of each patch. Also keeps contacts that may reach far out of
    /// the hull of the outermost ones.
    fn keep_outermost(&mut self, plan: PatchPlan) {
        let Self { members, places, outermost, .. } = self;
        for members in members.chunk_by_mut(|a, b| a.patch == b.patch) {
            if members.len() <= MOST_POINTS {
                continue;
            }
            places.clear();
            places.extend(members.iter().map(|Member { summary: of, .. }| (of.point, of.distance)));
            outermost.choose(plan, places, |i| members[i].summary.normal);
            for (i, member) in members.iter_mut().enumerate() {
                let excess = member.summary.spread - plan.size;
                let is_needed = outermost.chosen.contains(&i)
                    || excess > 0.0 && !is_inside(&outermost.hull, outermost.flat[i], excess);
                member.patch = if is_needed { member.patch } else { NO_PATCH };
            }
        }
        members.retain(|member| member.patch != NO_PATCH);
    }
}

/// Least distance of a chosen point from the hull, in distances between the first two points.
/// Higher: narrow sides lose corners; lower: rounding adds points to a line. Also the share of
/// [`PatchPlan::equal_depth`] that counts as rounding.
const LINE: Real = 1.0e-3;

/// Direction in which the first point is outermost. It is along no side of common meshes.
const ANY_WAY: Vec2 = Vec2::new(0.9, 0.4);

/// The outermost ones of some points, with memory for their choice.
#[derive(Default)]
pub(super) struct Outermost {
    /// The points, seen along the normal.
    flat: Vec<Vec2>,
    /// Squares of the distances from the hull.
    squares: Vec<Real>,
    /// Convex hull of the chosen points, counterclockwise.
    hull: Vec<Vec2>,
    chosen: Vec<usize>,
}

impl Outermost {
    /// Chooses the outermost of `points`, which come with their distances. Point 0 must be the
    /// deepest. The body reaches each next point after the least turn. Along `normal` it is far
    /// outside the convex hull, and little above the deepest point. More than four are chosen if
    /// others as deep are far from these.
    pub(super) fn choose(
        &mut self,
        plan: PatchPlan,
        points: &[(Vec3, Real)],
        normal: impl Fn(usize) -> Vec3,
    ) -> &[usize] {
        self.chosen.clear();
        if points.len() <= MOST_POINTS {
            self.chosen.extend(0..points.len());
            return &self.chosen;
        }
        self.begin(plan, points, normal);
        let deepest = points[0].1;
        let equal_depth = plan.equal_depth + DEPTH_SHARE * (-deepest).max(0.0);
        // Zero until there is a second point.
        let mut least = 0.0;
        loop {
            let is_full = self.chosen.len() >= MOST_POINTS;
            let weighed = points.iter().zip(&self.squares).map(|((_, distance), &square)| {
                let hover = distance - deepest;
                let is_needed =
                    !is_full || hover <= plan.equal_depth && square > plan.size * plan.size;
                if is_needed { square / (1.0 + hover.max(0.0) / equal_depth).powi(2) } else { 0.0 }
            });
            let farthest = |most: (usize, Real), next: (usize, Real)| {
                if next.1 > most.1 { next } else { most }
            };
            let (next, square) = weighed.enumerate().fold((0, least), farthest);
            if square <= least {
                break;
            }
            self.add(next);
            if least == 0.0 {
                least = LINE * LINE * square;
            }
        }
        // Points about as far from the others must not change places from step to step.
        if let [first, second, third, _, ..] = self.chosen[..] {
            let [first, second, third] = [first, second, third].map(|i| self.flat[i]);
            if (second - first).perp_dot(third - first) > 0.0 {
                self.chosen.swap(2, 3);
            }
        }
        &self.chosen
    }

    /// Chooses the first point: an outermost one with the normal of the deepest point and, up to
    /// rounding, its depth.
    fn begin(&mut self, plan: PatchPlan, points: &[(Vec3, Real)], normal: impl Fn(usize) -> Vec3) {
        let (x, y) = normal(0).any_orthonormal_pair();
        let flat = |&(point, _): &(Vec3, Real)| Vec2::new(x.dot(point), y.dot(point));
        self.flat.clear();
        self.flat.extend(points.iter().map(flat));
        self.squares.clear();
        self.squares.resize(points.len(), Real::INFINITY);
        self.hull.clear();
        let limit = points[0].1 + if plan.far.is_finite() { LINE * plan.equal_depth } else { 0.0 };
        let is_as_deep =
            |i: &usize| points[*i].1 <= limit && normal(*i).dot(normal(0)) >= plan.one_normal;
        let along = |i: &usize| self.flat[*i].dot(ANY_WAY);
        let first =
            (0..points.len()).filter(is_as_deep).max_by(|a, b| along(a).total_cmp(&along(b)));
        self.add(first.unwrap_or_default());
    }

    /// Chooses a point outside of the hull.
    fn add(&mut self, index: usize) {
        let Self { flat, squares, hull, chosen } = self;
        let corner = flat[index];
        chosen.push(index);
        add_corner(hull, corner);
        let (before, after) = (hull[hull.len().max(2) - 2], hull[0]);
        for (&point, square) in flat.iter().zip(squares) {
            if *square > 0.0 {
                let to_sides =
                    to_segment(before, corner, point).min(to_segment(corner, after, point));
                *square = if is_inside(hull, point, 0.0) { 0.0 } else { square.min(to_sides) };
            }
        }
    }
}

/// Adds a corner at the end of a convex hull. Removes the corners that are now inside.
fn add_corner(hull: &mut Vec<Vec2>, corner: Vec2) {
    let count = hull.len();
    let is_seen = |start: Vec2, end: Vec2| (end - start).perp_dot(corner - start) < 0.0;
    let is_side_seen = |i: usize| is_seen(hull[i % count], hull[(i + 1) % count]);
    // A corner on the line of a side may see none.
    if let Some(first) = (0..count).find(|&i| is_side_seen(i) && !is_side_seen(i + count - 1)) {
        hull.rotate_left((first + 1) % count);
    }
    while hull.len() > 2 && is_seen(hull[0], hull[1]) {
        hull.remove(0);
    }
    hull.push(corner);
}

/// Returns true if a point is inside of a convex hull, and farther than a distance from its border.
fn is_inside(hull: &[Vec2], point: Vec2, distance: Real) -> bool {
    let mut last = hull[hull.len() - 1];
    hull.len() > 2
        && hull.iter().all(|&corner| {
            let start = std::mem::replace(&mut last, corner);
            let side = corner - start;
            let height = side.perp_dot(point - start);
            height > 0.0 && height * height > distance * distance * side.length_squared()
        })
}

/// Returns the square of the distance of a point from a segment.
fn to_segment(a: Vec2, b: Vec2, point: Vec2) -> Real {
    let (along, way) = (b - a, point - a);
    let length = along.length_squared();
    let share = if length > 0.0 { along.dot(way) / length } else { 0.0 };
    (way - along * share.clamp(0.0, 1.0)).length_squared()
}

#[cfg(test)]
mod tests;
