//! Which contacts make a patch, by their outlines: before their points are made.

use std::cmp::Ordering;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::Real;
use parry3d::query::TrackedContact;

/// The points of a patch. Rapier's solver uses no more.
const MOST_POINTS: usize = 4;

/// The least cosine of normals of one patch. Higher: with that of Rapier's own clusters, 0.996, its
/// solver gets a quarter more points, and nested bowls are not calm in one run of three; with 0.99 a
/// step errs as little. Lower: gears of 20 teeth at 5 rad/s lose more of their speed.
const SAME_NORMAL: Real = 0.99;

/// The same for what is [far](PatchPlan::far).
const SAME_FAR_NORMAL: Real = 0.97;

/// The same for what is [over](PatchPlan::over) a contact. Higher: a pile of 200 heads at rest has more
/// points, 8 % with 0.97.
const SAME_NORMAL_OVER: Real = 0.9;

/// [`PatchPlan::over`] as a share of the prediction distance. Higher: that pile has 2035 points in place of
/// 1949 (0.25), or 2143 (0.4). Without: 2624, most of which carry nothing; in motion heads
/// are then 0.2 mm deep in others on the mean in place of 0.6, as with every contact. Lower: not tried.
const OVER: Real = 0.1;

/// How patches are made of contacts.
#[derive(Copy, Clone, Debug)]
pub(crate) struct PatchPlan {
    /// Contacts that are farther than this are of the direction of a nearer one, or of each other, if their
    /// normals are not far from its.
    far: Real,
    /// Contacts that are farther than this are of the direction of one that touches near them, if their
    /// normals are not too far from its: bodies that slide or roll from there meet others. (Where nothing need
    /// touch: of two gears at 5 rad/s teeth pass each other by 0.05 rad, as contacts of one direction are not
    /// there yet and those of the next are left out. Not of bodies as small as the prediction distance: on a tray
    /// they gain 0.013 of their energy.)
    over: Real,
    /// Contacts that are less than this farther than the deepest one of their direction carry as it
    /// does.
    level: Real,
    /// How near to a contact that is chosen others are spared.
    size: Real,
    /// The least cosine of normals of one manifold of a patch.
    pub(super) one_normal: Real,
    /// Points nearer to each other than this are one that has moved.
    pub(super) same_point: Real,
}

/// [`PatchPlan::level`] as a share of the prediction distance, or of a tenth of the radius if that is
/// less. Higher: points that hang over the other shape are chosen in place of those that carry, and
/// bodies rock from one to the next: of ten heads on a floor three rest after ten seconds, as with
/// Rapier's own choice from every contact, in place of eight to ten. Lower: thin plates that meet a
/// floor at 30 m/s turn through it.
const LEVEL: Real = 0.02;

/// [`PatchPlan::one_normal`]. Lower: threads of a screw, whose normals lean by a degree or two, lock.
const ONE_NORMAL: Real = 0.99999;

/// [`PatchPlan::size`] in radii of the smaller shape. Higher: legs of a table are left out, and of ten
/// boxes in a slab one stays (with 0.3). Lower: a flat side is many patches.
const PATCH_SIZE: Real = 0.2;

/// [`PatchPlan::same_point`] as a share of the size of a patch. Higher: a nut locks on its bolt (0.1).
/// Zero: a stack of ten cubes of 12 triangles creeps by 0.07 in place of 0.02, without recycling.
const SAME_POINT: Real = 0.02;

impl PatchPlan {
    /// All contacts are far: what is deepest may change before they touch, and of two manifolds alike
    /// to Rapier's solver with more than four points it leaves one point.
    pub(super) const FAR: Self = Self {
        far: Real::INFINITY,
        over: Real::INFINITY,
        level: Real::INFINITY,
        size: Real::INFINITY,
        one_normal: -1.0,
        same_point: 0.0,
    };

    /// For two shapes, the smaller one of that radius.
    pub(super) fn new(prediction: Real, radius: Real) -> Self {
        let near = 0.1 * radius;
        let reach = if prediction > 0.0 { prediction.min(near) } else { near };
        let over = if prediction < near { OVER * prediction } else { Real::INFINITY };
        let size = PATCH_SIZE * radius;
        let same_point = SAME_POINT * size;
        Self { far: near, over, level: LEVEL * reach, size, one_normal: ONE_NORMAL, same_point }
    }
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

impl Outline {
    /// Where it is, and how far apart the shapes are there.
    pub(super) fn place(&self) -> (Vec3, Real) {
        (self.point, self.distance)
    }
}

/// Memory for the choice of patches.
#[derive(Default)]
pub(crate) struct Patches {
    pub(super) members: Vec<Member>,
    /// The first contact of each direction, then of each place.
    openers: Vec<Outline>,
    pub(super) points: Vec<(Vec3, Real)>,
}

pub(super) struct Member {
    pub(super) outline: Outline,
    /// Its place among the contacts.
    pub(super) contact: u32,
    pub(super) patch: u32,
}

/// A point of a patch, and the contact that it is of.
#[derive(Copy, Clone)]
pub(super) struct PatchPoint<C> {
    pub(super) point: TrackedContact<C>,
    pub(super) of: u32,
    pub(super) normals: [Vec3; 2],
}

/// A point that the patches of a pair had before, and the part that it is of.
#[derive(Copy, Clone)]
pub(super) struct OldPoint<C> {
    pub(super) point: TrackedContact<C>,
    pub(super) part: u32,
}

/// Of a contact that is left out.
const NO_PATCH: u32 = u32::MAX;

/// The deepest first; those of one depth in stock order.
fn by_depth(a: &Member, b: &Member) -> Ordering {
    let by_depth = a.outline.distance.total_cmp(&b.outline.distance);
    by_depth.then(a.contact.cmp(&b.contact))
}

impl Patches {
    pub(super) fn shrink_to(&mut self, limit: usize) {
        self.members.shrink_to(limit);
        self.openers.shrink_to(limit);
        self.points.shrink_to(limit);
    }

    /// Divides the contacts up, and leaves out those that no patch needs: of each direction the
    /// outermost make a patch, and others as deep that are far from these make one for each place.
    pub(super) fn divide(&mut self, plan: PatchPlan) {
        let Self { members, openers, points } = self;
        members.sort_unstable_by(by_depth);
        openers.clear();
        for Member { outline, patch, .. } in &mut *members {
            let is_far = outline.distance > plan.far;
            let same_normal = if is_far { SAME_FAR_NORMAL } else { SAME_NORMAL };
            let is_over = |opener: &Outline| {
                outline.distance > plan.over
                    && opener.distance <= 0.0
                    && opener.point.distance(outline.point) <= plan.size
            };
            let is_like = |opener: &Outline| {
                let cosine = opener.normal.dot(outline.normal);
                opener.part == outline.part
                    && (cosine >= same_normal || cosine >= SAME_NORMAL_OVER && is_over(opener))
            };
            *patch = first_or_new(openers, 0, is_like, outline);
        }
        members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
        openers.clear();
        let mut count = 0;
        for members in members.chunk_by_mut(|a, b| a.patch == b.patch) {
            points.clear();
            points.extend(members.iter().map(|Member { outline, .. }| outline.place()));
            let Outline { normal, distance: deepest, .. } = members[0].outline;
            let chosen = plan.outermost(points, normal);
            let is_near = |point: Vec3, other: Vec3| point.distance(other) <= plan.size;
            let places = openers.len();
            for (i, Member { outline, patch, .. }) in members.iter_mut().enumerate() {
                let is_spared = outline.distance - deepest > plan.level
                    || chosen.iter().any(|&i| is_near(points[i].0, outline.point));
                *patch = if chosen.contains(&i) {
                    count
                } else if is_spared {
                    NO_PATCH
                } else {
                    let is_there = |opener: &Outline| is_near(opener.point, outline.point);
                    count + 1 + first_or_new(openers, places, is_there, outline)
                };
            }
            count += 1 + (openers.len() - places) as u32;
        }
        members.retain(|member| member.patch != NO_PATCH);
        members.sort_unstable_by(|a, b| a.patch.cmp(&b.patch).then_with(|| by_depth(a, b)));
    }
}

/// The place, from `start` on, of the first of `openers` that fits, or of a new one.
fn first_or_new(
    openers: &mut Vec<Outline>,
    start: usize,
    fits: impl Fn(&Outline) -> bool,
    new: &Outline,
) -> u32 {
    let place = openers[start..].iter().position(fits).unwrap_or_else(|| {
        openers.push(*new);
        openers.len() - 1 - start
    });
    place as u32
}

impl PatchPlan {
    /// Up to four of `points`, each with its distance: the first and deepest one, the one farthest
    /// from it, and those farthest from the line between these on both sides, as seen along `normal`.
    /// A point that hangs over the other shape counts as if it were nearer to the first one: a body
    /// that leans over reaches it after others. Of a flat body that is aslant, whose points hang the
    /// higher the farther they are, the corners still come first, as lengths count by their squares.
    pub(super) fn outermost(
        self,
        points: &[(Vec3, Real)],
        normal: Vec3,
    ) -> ArrayVec<usize, MOST_POINTS> {
        if points.len() <= MOST_POINTS {
            return (0..points.len()).collect();
        }
        let (first, deepest) = points[0];
        let most = |squared: &dyn Fn(Vec3) -> Real| {
            let weighed = points.iter().map(|&(point, distance)| {
                squared(point) / (1.0 + (distance - deepest).max(0.0) / self.level)
            });
            let farthest = weighed.enumerate().skip(1);
            farthest.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most }).0
        };
        let second = most(&|point| (point - first).length_squared());
        let across = (points[second].0 - first).cross(normal);
        let side =
            |sign: Real| most(&|point| (sign * (point - first).dot(across)).max(0.0).powi(2));
        let sides = [side(1.0), side(-1.0)];
        let mut chosen = ArrayVec::new();
        for point in [0, second].into_iter().chain(sides) {
            if !chosen.contains(&point) {
                chosen.push(point);
            }
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts divided up: for each by its place the number of its patch, in order.
    fn patches(outlines: &[Outline], plan: PatchPlan) -> Vec<(u32, u32)> {
        let mut patches = Patches::default();
        patches.members.extend((0..).zip(outlines).map(|(contact, &outline)| Member {
            outline,
            contact,
            patch: 0,
        }));
        patches.divide(plan);
        patches.members.iter().map(|member| (member.contact, member.patch)).collect()
    }

    const PLAN: PatchPlan = PatchPlan {
        far: 1.0,
        over: 0.3,
        level: 0.01,
        size: 1.0,
        one_normal: ONE_NORMAL,
        same_point: 0.0,
    };

    fn outline(x: Real, distance: Real) -> Outline {
        let point = Vec3::new(x, 0.0, 0.0);
        Outline { part: 0, normal: Vec3::Y, point, distance, has_cones: false }
    }

    /// Would catch patches that mix parts, directions or places, that begin at another contact than
    /// their deepest, points that hang over in place of those that carry, and an order that sorting
    /// does not fix.
    #[test]
    fn contacts_join_the_patch_of_their_part_direction_and_place() {
        let row = [0.0, 2.0, 4.0, 4.5, 6.0, 8.0].map(|x| outline(x, -0.1));
        // The ends of the row, and what is far from both.
        assert_eq!(patches(&row, PLAN), [(0, 0), (5, 0), (1, 1), (2, 2), (3, 2), (4, 3)]);
        assert_eq!(patches(&row, PatchPlan { size: 4.0, ..PLAN }), [(0, 0), (5, 0)]);
        assert_eq!(patches(&row, PatchPlan::FAR), [(0, 0), (5, 0)]);
        // All but two hang over: in line with these they carry nothing.
        let mut hanging = row.map(|row| Outline { distance: 0.1, ..row });
        hanging[1].distance = -0.1;
        hanging[0].distance = -0.09;
        assert_eq!(patches(&hanging, PLAN), [(1, 0), (0, 0)]);
        // The deepest one opens the first.
        let deep = [outline(0.0, -0.1), outline(0.9, -0.2), outline(1.8, -0.1)];
        assert_eq!(patches(&deep, PLAN)[0], (1, 0));
        let other_part = Outline { part: 1, ..outline(0.0, -0.1) };
        assert_eq!(patches(&[outline(0.0, -0.1), other_part], PLAN), [(0, 0), (1, 1)]);
        // Those of one depth in their order, however many there are.
        let many: Vec<Outline> = (0..200).map(|i| outline((i % 100) as Real, 0.0)).collect();
        let expected = (1..99).flat_map(|i| [(i, i), (100 + i, i)]);
        let far_enough = PatchPlan { size: 0.5, ..PLAN };
        let ends = [(0, 0), (99, 0)].into_iter().chain(expected);
        assert_eq!(patches(&many, far_enough), ends.collect::<Vec<_>>());
        let turned = |degrees: Real| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Outline { normal: Vec3::new(sin, cos, 0.0), ..outline(0.0, -0.1) }
        };
        assert_eq!(patches(&[outline(0.0, -0.1), turned(8.0)], PLAN), [(0, 0), (1, 0)]);
        assert_eq!(patches(&[outline(0.0, -0.1), turned(8.2)], PLAN), [(0, 0), (1, 1)]);
        // What is over one that touches is of its direction up to 25 degrees off, if it is near.
        let over = |distance: Real, touching: Real, x: Real| {
            let over = Outline { point: Vec3::new(x, 0.0, 0.0), distance, ..turned(25.0) };
            patches(&[outline(0.0, touching), over], PLAN)[1].1 == 0
        };
        assert!(over(0.4, 0.0, 0.9));
        assert!(!over(0.2, 0.0, 0.9) && !over(0.4, 0.1, 0.9) && !over(0.4, 0.0, 1.1));
        // What is far is of a direction up to 14 degrees off, and spared there.
        let is_kept = |degrees: Real| {
            let four = [0.0, 1.0, 2.0, 3.0].map(|x| outline(x, -0.1));
            let point = Vec3::new(-2.0, 0.0, 0.0);
            let far = Outline { point, distance: 1.1, ..turned(degrees) };
            let kept = patches(&[&four[..], &[far]].concat(), PLAN);
            kept.iter().any(|(contact, _)| *contact == 4)
        };
        assert_eq!([13.9, 14.2].map(is_kept), [false, true]);
    }

    /// Would catch points of one side only, a second one that is not the farthest, points that come
    /// twice, and those that hang over.
    #[test]
    fn the_outermost_points_that_carry_are_chosen_once() {
        let at = |places: &[[Real; 3]]| -> Vec<(Vec3, Real)> {
            places.iter().map(|&[x, z, distance]| (Vec3::new(x, 0.0, z), distance)).collect()
        };
        let chosen = |points: &[(Vec3, Real)]| {
            let mut chosen = PLAN.outermost(points, Vec3::Y);
            chosen.sort_unstable();
            chosen.to_vec()
        };
        let mut points = at(&[
            [0.0, 0.0, -0.2],
            [1.0, 0.3, -0.2],
            [3.0, 0.0, -0.2],
            [1.0, -0.5, -0.2],
            [2.0, 0.9, -0.2],
            [2.0, -0.4, -0.2],
        ]);
        assert_eq!(chosen(&points), [0, 2, 3, 4]);
        points[4].1 = -0.1;
        assert_eq!(chosen(&points), [0, 1, 2, 3]);
        let line = [0.0, 1.0, 2.0, 3.0, 2.5].map(|x| [x, 0.0, -0.2]);
        assert_eq!(chosen(&at(&line)), [0, 3]);
        // A plate that is aslant still has its corners.
        let aslant = [0.0, 0.1, 0.2, 0.5, 0.9, 1.0].map(|x| [x, 0.0, 0.3 * x]);
        assert_eq!(chosen(&at(&aslant)), [0, 5]);
        assert_eq!(chosen(&points[..4]), [0, 1, 2, 3]);
    }
}
