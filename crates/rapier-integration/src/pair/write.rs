//! From contacts to the manifolds of the host: one for each contact, or patches.
//!
//! Manifolds of subshapes that still touch stay in their place in the host's list and keep their
//! data. Others are recycled: a new manifold costs ten times as much as a used one.

use std::any::Any;
use std::cell::Cell;
use std::ops::Range;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

use super::query::{ContactPoints, HighWaterMark, PairQuery, QueryMemory};
use super::reduce::{MOST_POINTS, Member, PatchPlan, PatchPoint, Reduction};

/// Spare manifolds that a thread keeps, of some 500 bytes each. Higher: more memory; lower:
/// allocations where pairs lose and gain many contacts at once.
const MOST_SPARE: usize = 256;

/// Least cosine of the normals of patches and of points of successive queries that may be the same.
/// Higher: patches that turn lose their data; lower: patches take the data of others.
const LIKE_NORMAL: Real = 0.9;

thread_local! {
    /// Memory of a thread, for the data types of the last host. Empty during a query: a query
    /// inside another one makes its own.
    static POOL: Cell<Option<Box<dyn Any>>> = Cell::default();
}

/// Spare manifolds and lists of a thread.
#[derive(Default)]
struct Pool<M, C> {
    next: Vec<ContactManifold<M, C>>,
    spare: Vec<ContactManifold<M, C>>,
    previous_points: Vec<TrackedContact<C>>,
    /// In the order of parts.
    old_points: Vec<OldPoint<C>>,
    /// Parts of the host's manifolds and the indices of these, sorted.
    old_parts: Vec<(u32, u32)>,
    demand: HighWaterMark,
}

/// A point of the last query, and the part in whose frame it is.
struct OldPoint<C> {
    point: TrackedContact<C>,
    part: u32,
    /// Unit vector across the contact.
    normal: Vec3,
    /// True if a new point has its data.
    is_taken: bool,
}

/// Replaces the host's manifolds with the result of a query.
///
/// While no manifold comes or goes, all stay in place: moving one takes as long as updating its
/// distances.
pub(super) struct Writer<'m, M, C> {
    manifolds: &'m mut Vec<ContactManifold<M, C>>,
    pool: Box<Pool<M, C>>,
    /// Length of the prefix of the host's list that stays in place. Zero once `pool.next` is in
    /// use, which then holds all manifolds of this query.
    in_place: usize,
    /// True if the last query left patches; `None` if not known.
    had_patches: Option<bool>,
}

impl<'m, M: Default + 'static, C: Default + Copy + 'static> Writer<'m, M, C> {
    pub(super) fn begin(
        manifolds: &'m mut Vec<ContactManifold<M, C>>,
        had_patches: Option<bool>,
    ) -> Self {
        let pool = POOL.take().and_then(|pool| pool.downcast().ok()).unwrap_or_default();
        Self { manifolds, pool, in_place: 0, had_patches }
    }

    /// Ends the query: the host's list becomes the manifolds of this query.
    pub(super) fn end(mut self) {
        let Self { manifolds, pool, in_place, .. } = &mut self;
        manifolds.truncate(*in_place);
        manifolds.append(&mut pool.next);
        if let Some(limit) = pool.demand.update(manifolds.len()) {
            pool.next.shrink_to(limit);
            pool.old_points.shrink_to(limit);
            pool.old_parts.shrink_to(limit);
        }
        POOL.set(Some(self.pool));
    }

    /// Adds a new manifold.
    #[inline(always)]
    fn keep_new(&mut self, manifold: ContactManifold<M, C>) {
        self.leave_places();
        self.pool.next.push(manifold);
    }

    /// Adds the manifold at an index of the host's list.
    #[inline(always)]
    fn keep_old(&mut self, index: usize) {
        if self.pool.next.is_empty() && index == self.in_place {
            self.in_place += 1;
        } else {
            self.leave_places();
            self.pool.next.push(std::mem::take(&mut self.manifolds[index]));
        }
    }

    /// Moves the manifolds in place to `next`.
    fn leave_places(&mut self) {
        let stayed = &mut self.manifolds[..std::mem::take(&mut self.in_place)];
        self.pool.next.extend(stayed.iter_mut().map(std::mem::take));
    }

    /// Returns an empty manifold.
    fn take_spare(&mut self) -> ContactManifold<M, C> {
        self.pool.spare.pop().unwrap_or_default()
    }

    /// Takes the host's manifold of a part with the most similar normal; an empty one if none is
    /// similar.
    fn take_like(&mut self, part: u32, normal: Vec3) -> ContactManifold<M, C> {
        // Manifolds that were taken are empty and have a normal of zero.
        let olds = of_part(&self.pool.old_parts, part, |(part, _)| *part);
        let likes = olds.map(|i| self.pool.old_parts[i].1 as usize);
        let likes = likes.map(|old| (old, self.manifolds[old].local_n1.dot(normal)));
        let likes = likes.filter(|(_, like)| *like >= LIKE_NORMAL);
        match likes.max_by(|(_, a), (_, b)| a.total_cmp(b)) {
            Some((old, _)) => std::mem::take(&mut self.manifolds[old]),
            None => self.take_spare(),
        }
    }

    /// Recycles the manifold at an index of the host's list.
    fn retire(&mut self, index: usize) {
        let mut manifold = std::mem::take(&mut self.manifolds[index]);
        if self.pool.spare.len() < MOST_SPARE && manifold.points.capacity() > 0 {
            manifold.points.clear();
            manifold.data = M::default();
            self.pool.spare.push(manifold);
        }
    }

    /// Lists the points and the parts of the host's manifolds.
    fn list_old_points(&mut self) {
        let names_are_raw = self.had_patches == Some(false);
        let Pool { old_points, old_parts, .. } = &mut *self.pool;
        old_parts.clear();
        old_parts.extend(self.manifolds.iter().map(part_of).zip(0..));
        old_parts.sort_unstable();
        old_points.clear();
        old_points.extend(old_parts.iter().flat_map(|&(part, index)| {
            let manifold = &self.manifolds[index as usize];
            let (subshapes, normal) = (subshapes_of(manifold), manifold.local_n1);
            manifold.points.iter().map(move |&point| {
                let point = if names_are_raw { named(point, subshapes) } else { point };
                OldPoint { point, part, normal, is_taken: false }
            })
        }));
    }

    /// Writes a manifold for each contact, in the order of subshapes.
    pub(super) fn write_every<Q: PairQuery>(
        &mut self,
        query: &mut Q,
        memory: &mut QueryMemory<Q::Scratch, Q::Contact>,
    ) {
        let QueryMemory { scratch, contacts, points, .. } = memory;
        let were_patches = self.had_patches == Some(true);
        if were_patches {
            self.list_old_points();
        }
        // Patches and hosts may have another order.
        if !self.manifolds.is_sorted_by_key(subshapes_of) {
            self.manifolds.sort_by_key(subshapes_of);
        }
        let mut old = 0;
        for contact in &*contacts {
            query.points(contact, scratch, points);
            if points.points.is_empty() {
                continue;
            }
            while self.manifolds.get(old).is_some_and(|next| subshapes_of(next) < contact.0) {
                self.retire(old);
                old += 1;
            }
            if self.manifolds.get(old).is_some_and(|next| subshapes_of(next) == contact.0) {
                write_contact(points, were_patches, &mut self.pool, &mut self.manifolds[old]);
                self.keep_old(old);
                old += 1;
            } else {
                let mut manifold = self.take_spare();
                [manifold.subshape1, manifold.subshape2] = contact.0;
                write_contact(points, were_patches, &mut self.pool, &mut manifold);
                self.keep_new(manifold);
            }
        }
        for rest in old..self.manifolds.len() {
            self.retire(rest);
        }
    }

    /// Writes patches: few manifolds of up to four points for all contacts.
    ///
    /// Contacts are chosen before their points are made, then points are chosen. Patches and points
    /// keep the data of similar ones of the last query.
    pub(super) fn write_patches<Q: PairQuery>(
        &mut self,
        query: &mut Q,
        memory: &mut QueryMemory<Q::Scratch, Q::Contact>,
        plan: PatchPlan,
    ) {
        let QueryMemory { scratch, contacts, reduction, points, .. } = memory;
        let summary = |contact| query.summary(contact, scratch, points);
        reduction.reduce(plan, contacts.iter().map(summary));
        self.list_old_points();
        let Reduction { members, places, points: patch_points, outermost, .. } = reduction;
        for members in members.chunk_by(|a, b| a.patch == b.patch) {
            patch_points.clear();
            for &Member { contact, .. } in members {
                let of = &contacts[contact as usize];
                query.points(of, scratch, points);
                patch_points.extend(patch_points_of(points, of.0, contact));
            }
            let distance = |point: &PatchPoint| point.point.dist;
            let depths = patch_points.iter().map(distance).enumerate();
            let Some((deepest, _)) = depths.min_by(|(_, a), (_, b)| a.total_cmp(b)) else {
                continue;
            };
            patch_points.swap(0, deepest);
            places.clear();
            places.extend(patch_points.iter().map(|point| (point.point.local_p1, distance(point))));
            let chosen = outermost.choose(plan, places, |i| patch_points[i].normals[0]);
            for chosen in chosen.chunks(MOST_POINTS) {
                let mut chosen: ArrayVec<_, MOST_POINTS> = chosen.iter().copied().collect();
                while !chosen.is_empty() {
                    self.write_patch(plan, patch_points, &mut chosen, |contact| {
                        contacts[contact].0
                    });
                }
            }
        }
        for rest in 0..self.manifolds.len() {
            self.retire(rest);
        }
    }

    /// Writes a manifold of the deepest of the chosen points and those that have its normal, and
    /// removes them from the list.
    fn write_patch(
        &mut self,
        plan: PatchPlan,
        points: &[PatchPoint],
        chosen: &mut ArrayVec<usize, MOST_POINTS>,
        subshapes: impl Fn(usize) -> [u32; 2],
    ) {
        let distance = |i: &usize| points[*i].point.dist;
        let Some(&deepest) = chosen.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        else {
            return;
        };
        let PatchPoint { contact, normals: [normal1, normal2], poses: [pose1, pose2], .. } =
            points[deepest];
        let subshapes = subshapes(contact as usize);
        let part = part_at([&pose1, &pose2].map(Option::is_some), subshapes);
        let mut manifold = self.take_like(part, normal1);
        [manifold.subshape1, manifold.subshape2] = subshapes;
        manifold.set_subshape_pos1(pose1);
        manifold.set_subshape_pos2(pose2);
        [manifold.local_n1, manifold.local_n2] = [normal1, normal2].map(without_noise);
        manifold.points.clear();
        // Far points carry nothing.
        let within = if plan.far.is_finite() { plan.size } else { 0.0 };
        let one_normal = if distance(&deepest) > plan.far { -1.0 } else { plan.one_normal };
        chosen.retain(|i| {
            let PatchPoint { point, normals, .. } = &points[*i];
            // The deepest one also where cones have left no unit vector.
            let is_of_normal = *i == deepest || normals[0].dot(normal1) >= one_normal;
            if is_of_normal {
                let data = take_nearest(point, normal1, part, &mut self.pool.old_points, within);
                manifold.points.push(with_data(point, data));
            }
            !is_of_normal
        });
        self.keep_new(manifold);
    }
}

fn subshapes_of<M, C>(manifold: &ContactManifold<M, C>) -> [u32; 2] {
    [manifold.subshape1, manifold.subshape2]
}

/// Replaces the points and the poses of a manifold.
#[inline(always)]
fn write_contact<M, C: Default + Copy>(
    points: &ContactPoints,
    were_patches: bool,
    pool: &mut Pool<M, C>,
    manifold: &mut ContactManifold<M, C>,
) {
    write_points(points, &mut pool.previous_points, manifold);
    let [pose1, pose2] = points.poses;
    manifold.set_subshape_pos1(pose1);
    manifold.set_subshape_pos2(pose2);
    if were_patches {
        take_data(manifold, &pool.old_points);
    }
}

/// Replaces the points of a manifold. Points with the features of points before keep their data.
#[inline(always)]
pub(super) fn write_points<M, C: Default + Copy>(
    ContactPoints { normals, points, .. }: &ContactPoints,
    previous: &mut Vec<TrackedContact<C>>,
    manifold: &mut ContactManifold<M, C>,
) {
    let are_same = |(old, new): (&_, &_)| have_same_features(old, new);
    let tracked = &mut manifold.points;
    if tracked.len() == points.len() && tracked.iter().zip(points).all(are_same) {
        for (tracked, point) in tracked.iter_mut().zip(points) {
            (tracked.local_p1, tracked.local_p2, tracked.dist) =
                (point.local_p1, point.local_p2, point.dist);
        }
    } else {
        std::mem::swap(tracked, previous);
        tracked.clear();
        tracked.extend(points.iter().map(|point| {
            let old = previous.iter().find(|old| have_same_features(old, point));
            with_data(point, old.map_or_else(C::default, |old| old.data))
        }));
    }
    [manifold.local_n1, manifold.local_n2] = normals.map(without_noise);
}

/// Returns a unit vector without components that are noise beside 1. Products of such components
/// are subnormal numbers, which slow Rapier's solver down by a fifth.
fn without_noise(normal: Vec3) -> Vec3 {
    Vec3::select(normal.abs().cmplt(Vec3::splat(Real::EPSILON)), Vec3::ZERO, normal)
}

fn with_data<C>(point: &TrackedContact<()>, data: C) -> TrackedContact<C> {
    let TrackedContact { local_p1, local_p2, fid1, fid2, dist, .. } = *point;
    TrackedContact { local_p1, local_p2, fid1, fid2, dist, data }
}

/// Gives the points of a manifold the data that they had in patches.
fn take_data<M, C: Default + Copy>(manifold: &mut ContactManifold<M, C>, old: &[OldPoint<C>]) {
    let (part, subshapes) = (part_of(manifold), subshapes_of(manifold));
    let old = &old[of_part(old, part, |old| old.part)];
    for point in &mut manifold.points {
        let names = named(*point, subshapes);
        let same = old.iter().find(|old| have_same_features(&old.point, &names));
        point.data = same.map_or_else(C::default, |old| old.point.data);
    }
}

/// Returns the part whose frame a manifold's points are in; 0 for the frame of the shape.
fn part_of<M, C>(manifold: &ContactManifold<M, C>) -> u32 {
    let poses = [manifold.subshape_pos1(), manifold.subshape_pos2()];
    part_at(poses.map(|pose| pose.is_some()), subshapes_of(manifold))
}

/// Like [`part_of`]. `has_pose`: which subshapes have poses of their own.
fn part_at(has_pose: [bool; 2], [subshape1, subshape2]: [u32; 2]) -> u32 {
    match has_pose {
        [true, _] => subshape1,
        [_, true] => subshape2,
        _ => 0,
    }
}

/// Returns the range of a part in a list in the order of parts.
fn of_part<T>(list: &[T], part: u32, part_of: impl Fn(&T) -> u32) -> Range<usize> {
    let first = list.partition_point(|one| part_of(one) < part);
    first..first + list[first..].partition_point(|one| part_of(one) == part)
}

/// Takes the data of the old point with the features of `point`, or else of the nearest one with
/// its direction, `within` a distance. Returns empty data without such a point. Moving points pass
/// from triangle to triangle.
fn take_nearest<C: Copy + Default>(
    point: &TrackedContact<()>,
    normal: Vec3,
    part: u32,
    old_points: &mut [OldPoint<C>],
    within: Real,
) -> C {
    let of_part = of_part(old_points, part, |old| old.part);
    let free = of_part.filter(|&index| !old_points[index].is_taken);
    let nearest = || {
        let likes =
            free.clone().filter(|&index| old_points[index].normal.dot(normal) >= LIKE_NORMAL);
        let distance = |index: usize| old_points[index].point.local_p1.distance(point.local_p1);
        let distances = likes.map(|index| (index, distance(index)));
        let (index, distance) = distances.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (distance <= within).then_some(index)
    };
    let same = free.clone().find(|&index| have_same_features(&old_points[index].point, point));
    let Some(old) = same.or_else(nearest) else { return C::default() };
    old_points[old].is_taken = true;
    old_points[old].point.data
}

/// Returns true if two points are of the same features.
fn have_same_features<A, B>(old: &TrackedContact<A>, new: &TrackedContact<B>) -> bool {
    (old.fid1, old.fid2) == (new.fid1, new.fid2)
}

/// Returns a point whose features have names of their own among all features of both shapes.
fn named<C>(mut point: TrackedContact<C>, [subshape1, subshape2]: [u32; 2]) -> TrackedContact<C> {
    point.fid1 = name(point.fid1, subshape1);
    point.fid2 = name(point.fid2, subshape2);
    point
}

/// Returns the name of a feature of a subshape: its kind and a number. Names are unique for up to
/// 256 features of a subshape and four million subshapes.
fn name(feature: PackedFeatureId, subshape: u32) -> PackedFeatureId {
    const NUMBER: u32 = (1 << 30) - 1;
    let number = (feature.0 & NUMBER).wrapping_add(subshape.wrapping_shl(8)) & NUMBER;
    PackedFeatureId(feature.0 & !NUMBER | number)
}

/// Returns the points of a contact, with the names that the manifold has.
fn patch_points_of(
    points: &ContactPoints,
    subshapes: [u32; 2],
    contact: u32,
) -> impl Iterator<Item = PatchPoint> {
    let ContactPoints { normals, poses, .. } = *points;
    let of = move |&point| PatchPoint { point: named(point, subshapes), contact, normals, poses };
    points.points.iter().map(of)
}

#[cfg(test)]
mod tests;
