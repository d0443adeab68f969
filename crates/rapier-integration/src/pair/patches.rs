//! A few manifolds for all contacts of two shapes, each with at most four points.
//!
//! A *patch* has a direction: contacts whose normals agree. Four of them carry a body as well as all
//! do (`outline.rs` chooses). The choice is made twice: of contacts, by their closest points, before
//! their other points are made, and of the points of those that were chosen.

use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::driver::{Contacts, PairQuery, Scratch};
use super::outline::{Member, OldPoint, PatchPlan, PatchPoint};
use super::pool::{ManifoldPool, reset};

/// Normals of a patch and of one of the step before that may be the same patch.
const LIKE_NORMAL: Real = 0.9;

/// Replaces `manifolds` by patches. Those that were there before keep their data, and so do points
/// of the same features.
pub(super) fn write_patches<Q, M, C>(
    Contacts { query, candidates, contacts, limits }: Contacts<'_, Q>,
    plan: PatchPlan,
    scratch: &mut Scratch,
    pool: &mut ManifoldPool<M, C>,
    manifolds: &mut Vec<ContactManifold<M, C>>,
) where
    Q: PairQuery,
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
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
    patches.divide(plan);
    let mut old_points = std::mem::take(&mut pool.old_points);
    let mut points = std::mem::take(&mut pool.patch_points);
    old_points.clear();
    old_points.extend(manifolds.iter().flat_map(|manifold| {
        let part = part_of(manifold);
        manifold.points.iter().map(move |&point| OldPoint { point, part })
    }));
    for members in patches.members.chunk_by(|a, b| a.patch == b.patch) {
        points.clear();
        patches.points.clear();
        patches.points.extend(members.iter().map(|member| member.outline.place()));
        let chosen = plan.outermost(&patches.points, members[0].outline.normal);
        for member in chosen {
            let (of, contact) = contacts[members[member].contact as usize];
            let candidate = &mut candidates[of as usize];
            reset(&mut blank);
            query.name(candidate, &mut blank);
            query.write(contact, candidate, limits, scratch, &mut pool.previous_points, &mut blank);
            let normals = [blank.local_n1, blank.local_n2];
            points.extend(blank.points.iter().map(|&point| PatchPoint {
                point: named(point, candidate.subshapes),
                of,
                normals,
            }));
        }
        // The deepest one comes first.
        let Some(deepest) = (0..points.len())
            .min_by(|&a, &b| points[a].point.dist.total_cmp(&points[b].point.dist))
        else {
            continue;
        };
        points.swap(0, deepest);
        patches.points.clear();
        let places = points.iter().map(|PatchPoint { point, .. }| (point.local_p1, point.dist));
        patches.points.extend(places);
        let mut chosen = plan.outermost(&patches.points, points[0].normals[0]);
        let distance = |i: &usize| points[*i].point.dist;
        while let Some(&deepest) = chosen.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        {
            let PatchPoint { of, normals: [local_n1, local_n2], .. } = points[deepest];
            // In the place of one that was taken is an empty one, whose normal is zero.
            let like = |old: &ContactManifold<M, C>| old.local_n1.dot(local_n1);
            let likes =
                manifolds.iter().map(like).enumerate().filter(|(_, like)| *like >= LIKE_NORMAL);
            let place = likes.max_by(|(_, a), (_, b)| a.total_cmp(b));
            let mut manifold = match place.map(|(place, _)| place) {
                Some(place) => std::mem::take(&mut manifolds[place]),
                None => pool.take(),
            };
            query.name(&candidates[of as usize], &mut manifold);
            (manifold.local_n1, manifold.local_n2) = (local_n1, local_n2);
            manifold.points.clear();
            chosen.retain(|i| {
                let PatchPoint { mut point, normals, .. } = points[*i];
                // Also where cones have left no unit vector.
                let is_of_normal = *i == deepest || normals[0].dot(local_n1) >= plan.one_normal;
                if is_of_normal {
                    let part = part_of(&manifold);
                    if let Some(old) = place_of(&point, part, &old_points, plan.same_point) {
                        point.data = old_points.swap_remove(old).point.data;
                    }
                    manifold.points.push(point);
                }
                !is_of_normal
            });
            pool.keep_new(Some(manifold), manifolds);
        }
    }
    pool.retire(blank);
    // Those without points were taken.
    let gone = manifolds.drain(..).filter(|manifold| !manifold.points.is_empty());
    gone.for_each(|manifold| pool.retire(manifold));
    pool.end(manifolds);
    (pool.old_points, pool.patch_points) = (old_points, points);
    scratch.patches = patches;
}

/// The part in whose frame the points of a manifold are; 0 if they are in that of the whole.
fn part_of<M, C>(manifold: &ContactManifold<M, C>) -> u32 {
    let of1 = manifold.subshape_pos1().map(|_| manifold.subshape1);
    of1.or(manifold.subshape_pos2().map(|_| manifold.subshape2)).unwrap_or(0)
}

/// The place of the point of the step before that a point of a part is: of the same features, or else
/// the one nearest to it within some distance. (A corner of two triangles has two names.)
fn place_of<C>(
    point: &TrackedContact<C>,
    part: u32,
    old_points: &[OldPoint<C>],
    same_point: Real,
) -> Option<usize> {
    let is_same = |old: &OldPoint<C>| {
        old.part == part && old.point.fid1 == point.fid1 && old.point.fid2 == point.fid2
    };
    let distance = |old: &OldPoint<C>| old.point.local_p1.distance(point.local_p1);
    let nearest = || {
        let of_part = old_points.iter().enumerate().filter(|(_, old)| old.part == part);
        let distances = of_part.map(|(place, old)| (place, distance(old)));
        let distances = distances.filter(|_| same_point > 0.0);
        let (place, distance) = distances.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (distance <= same_point).then_some(place)
    };
    old_points.iter().position(is_same).or_else(nearest)
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
