//! A few manifolds for all contacts of two shapes, each with at most four points.
//!
//! A *patch* is a direction and a place: contacts whose normals agree and that are near each other.
//! Rapier's solver uses four points of those with one direction: the deepest, the one farthest from
//! it, and the outermost ones on both sides of the line between these. The same choice is made here
//! twice: of contacts, by their closest points, before their other points are made, and of the
//! points of those that were chosen.

use std::cmp::Ordering;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::driver::{Contacts, PairQuery, Scratch};
use super::pool::{ManifoldPool, reset};

/// The points of a patch. Rapier's solver uses no more.
const MOST_POINTS: usize = 4;

/// The least cosine of normals of one patch: that of Rapier's own clusters, so that its solver gets
/// as many directions as of all contacts.
const SAME_NORMAL: Real = 0.996;

/// Normals of a patch and of one of the step before that may be the same patch.
const LIKE_NORMAL: Real = 0.9;

/// How far contacts of a patch may be from its deepest one, in radii of the smaller shape. Higher:
/// legs of a table are one patch. Lower: a flat side is many.
const PATCH_SIZE: Real = 0.3;

/// The reach of the patches of a shape with such a radius.
pub(super) fn patch_size(radius: Real) -> Real {
    PATCH_SIZE * radius
}

/// A contact, as far as patches are chosen by it. In the frame of shape 1 or of a part: the same for
/// all contacts of a part.
#[derive(Copy, Clone)]
pub(crate) struct Outline {
    /// Points of parts with poses of their own cannot be in one manifold.
    pub(super) part: u32,
    /// A unit vector across the contact.
    pub(super) normal: Vec3,
    pub(super) point: Vec3,
    pub(super) distance: Real,
    /// Whether cones have a say in the points: how deep they are, and whether there are any.
    pub(super) has_cones: bool,
}

/// Memory for the choice of patches.
#[derive(Default)]
pub(crate) struct Patches {
    members: Vec<Member>,
    /// The deepest contact of each patch.
    deepest: Vec<Outline>,
    points: Vec<Vec3>,
}

struct Member {
    outline: Outline,
    /// Its place among the contacts.
    contact: u32,
    patch: u32,
}

/// The deepest first; those of one depth in stock order.
fn by_depth(a: &Member, b: &Member) -> Ordering {
    let by_depth = a.outline.distance.total_cmp(&b.outline.distance);
    by_depth.then(a.contact.cmp(&b.contact))
}

impl Patches {
    pub(super) fn shrink_to(&mut self, limit: usize) {
        self.members.shrink_to(limit);
        self.deepest.shrink_to(limit);
        self.points.shrink_to(limit);
    }

    /// Divides the contacts up: each joins the first patch of its direction that it is near to, the
    /// deepest first.
    fn divide(&mut self, size: Real) {
        self.members.sort_unstable_by(by_depth);
        self.deepest.clear();
        for Member { outline, patch, .. } in &mut self.members {
            let is_near = |deepest: &Outline| {
                deepest.part == outline.part
                    && deepest.normal.dot(outline.normal) >= SAME_NORMAL
                    && (deepest.point - outline.point).length_squared() <= size * size
            };
            let place = self.deepest.iter().position(is_near).unwrap_or_else(|| {
                self.deepest.push(*outline);
                self.deepest.len() - 1
            });
            *patch = place as u32;
        }
        self.members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
    }
}

/// Replaces `manifolds` by patches. Those that were there before keep their data, and so do points
/// of the same features.
pub(super) fn write_patches<Q, M, C>(
    Contacts { query, candidates, contacts, limits }: Contacts<'_, Q>,
    size: Real,
    scratch: &mut Scratch,
    pool: &mut ManifoldPool<M, C>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) where
    Q: PairQuery,
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    pool.begin();
    let mut patches = std::mem::take(&mut scratch.patches);
    patches.members.clear();
    let mut blank = pool.take();
    for (place, &(of, contact)) in (0..).zip(contacts) {
        let candidate = &mut candidates[of as usize];
        let Some(mut outline) = query.outline(&contact, candidate, scratch) else { continue };
        if outline.has_cones {
            reset(&mut blank);
            query.write(contact, candidate, limits, scratch, &mut pool.previous_points, &mut blank);
            let distances = blank.points.iter().map(|point| point.dist);
            let Some(distance) = distances.reduce(Real::min) else { continue };
            outline.distance = distance;
        }
        patches.members.push(Member { outline, contact: place, patch: 0 });
    }
    patches.divide(size);
    let mut old_points = std::mem::take(&mut pool.old_points);
    let mut points = std::mem::take(&mut pool.patch_points);
    old_points.clear();
    old_points.extend(manifolds.iter().flat_map(|manifold| &manifold.points));
    for members in patches.members.chunk_by(|a, b| a.patch == b.patch) {
        points.clear();
        patches.points.clear();
        patches.points.extend(members.iter().map(|member| member.outline.point));
        let chosen = outermost(&patches.points, members[0].outline.normal);
        let mut of_patch = None;
        for member in chosen {
            let (of, contact) = contacts[members[member].contact as usize];
            let candidate = &mut candidates[of as usize];
            reset(&mut blank);
            query.name(candidate, &mut blank);
            query.write(contact, candidate, limits, scratch, &mut pool.previous_points, &mut blank);
            points.extend(blank.points.iter().map(|&point| named(point, candidate.subshapes)));
            if !blank.points.is_empty() {
                of_patch.get_or_insert((of, blank.local_n1, blank.local_n2));
            }
        }
        let Some((of, local_n1, local_n2)) = of_patch else {
            continue;
        };
        // The deepest one comes first.
        if let Some(deepest) =
            (0..points.len()).min_by(|&a, &b| points[a].dist.total_cmp(&points[b].dist))
        {
            points.swap(0, deepest);
        }
        let is_like = |old: &ContactManifold<M, C>| {
            !old.points.is_empty() && old.local_n1.dot(local_n1) >= LIKE_NORMAL
        };
        let like = manifolds.iter().enumerate().filter(|(_, old)| is_like(old));
        let place = like
            .max_by(|(_, a), (_, b)| a.local_n1.dot(local_n1).total_cmp(&b.local_n1.dot(local_n1)));
        let mut manifold = match place.map(|(place, _)| place) {
            Some(place) => std::mem::take(&mut manifolds[place]),
            None => pool.take(),
        };
        query.name(&candidates[of as usize], &mut manifold);
        (manifold.local_n1, manifold.local_n2) = (local_n1, local_n2);
        patches.points.clear();
        patches.points.extend(points.iter().map(|point| point.local_p1));
        manifold.points.clear();
        manifold.points.extend(outermost(&patches.points, local_n1).into_iter().map(|i| {
            let mut point = points[i];
            let is_same =
                |old: &&TrackedContact<C>| old.fid1 == point.fid1 && old.fid2 == point.fid2;
            if let Some(old) = old_points.iter().find(is_same) {
                point.data = old.data;
            }
            point
        }));
        pool.keep_new(Some(manifold), manifolds);
    }
    pool.retire(blank);
    // Those without points were taken.
    let gone = manifolds.drain(..).filter(|manifold| !manifold.points.is_empty());
    gone.for_each(|manifold| pool.retire(manifold));
    pool.end(manifolds);
    (pool.old_points, pool.patch_points) = (old_points, points);
    scratch.patches = patches;
}

/// Up to four of `points`: the first one, the one farthest from it, and those farthest from the line
/// between these on both sides, as seen along `normal`.
fn outermost(points: &[Vec3], normal: Vec3) -> ArrayVec<usize, MOST_POINTS> {
    if points.len() <= MOST_POINTS {
        return (0..points.len()).collect();
    }
    let most = |along: &dyn Fn(Vec3) -> Real| {
        let farthest = (1..points.len()).map(|i| (i, along(points[i])));
        farthest.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most }).0
    };
    let first = points[0];
    let second = most(&|point| (point - first).length_squared());
    let across = (points[second] - first).cross(normal);
    let sides = [1.0, -1.0].map(|sign| most(&|point| sign * (point - first).dot(across)));
    let mut chosen = ArrayVec::new();
    for point in [0, second].into_iter().chain(sides) {
        if !chosen.contains(&point) {
            chosen.push(point);
        }
    }
    chosen
}

/// A point whose features have names of their own among all of both shapes.
fn named<C>(mut point: TrackedContact<C>, [subshape1, subshape2]: [u32; 2]) -> TrackedContact<C> {
    point.fid1 = name(point.fid1, subshape1);
    point.fid2 = name(point.fid2, subshape2);
    point
}

/// The name of a feature of a subshape: the kind of feature stays, and numbers are told apart while
/// a subshape has up to 256 and the shape up to four million.
fn name(feature: PackedFeatureId, subshape: u32) -> PackedFeatureId {
    const NUMBER: u32 = (1 << 30) - 1;
    let number = (feature.0 & NUMBER).wrapping_add(subshape.wrapping_shl(8)) & NUMBER;
    PackedFeatureId(feature.0 & !NUMBER | number)
}
