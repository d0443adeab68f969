//! Which contacts make a patch, by their outlines: before their points are made.

use std::cmp::Ordering;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::Real;

/// The points of a patch. Rapier's solver uses no more.
const MOST_POINTS: usize = 4;

/// The least cosine of normals of one patch: that of Rapier's own clusters, so that its solver gets
/// as many directions as of all contacts.
const SAME_NORMAL: Real = 0.996;

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
    pub(super) members: Vec<Member>,
    /// The deepest contact of each patch.
    deepest: Vec<Outline>,
    pub(super) points: Vec<Vec3>,
}

pub(super) struct Member {
    pub(super) outline: Outline,
    /// Its place among the contacts.
    pub(super) contact: u32,
    pub(super) patch: u32,
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
    pub(super) fn divide(&mut self, size: Real) {
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

/// Up to four of `points`: the first one, the one farthest from it, and those farthest from the line
/// between these on both sides, as seen along `normal`.
pub(super) fn outermost(points: &[Vec3], normal: Vec3) -> ArrayVec<usize, MOST_POINTS> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts divided up: for each by its place the number of its patch, in order.
    fn patches(outlines: &[Outline], size: Real) -> Vec<(u32, u32)> {
        let mut patches = Patches::default();
        patches.members.extend((0..).zip(outlines).map(|(contact, &outline)| Member {
            outline,
            contact,
            patch: 0,
        }));
        patches.divide(size);
        patches.members.iter().map(|member| (member.contact, member.patch)).collect()
    }

    fn outline(x: Real, distance: Real) -> Outline {
        let point = Vec3::new(x, 0.0, 0.0);
        Outline { part: 0, normal: Vec3::Y, point, distance, has_cones: false }
    }

    /// Would catch patches that mix parts, directions or places, that begin at another contact than
    /// their deepest, and an order that sorting does not fix.
    #[test]
    fn contacts_join_the_first_patch_of_their_part_direction_and_place() {
        let row = [0.0, 0.9, 1.1, 2.5].map(|x| outline(x, -0.1));
        assert_eq!(patches(&row, 1.0), [(0, 0), (1, 0), (2, 1), (3, 2)]);
        assert_eq!(patches(&row, 3.0), [(0, 0), (1, 0), (2, 0), (3, 0)]);
        // The deepest one opens the first.
        let deep = [outline(0.0, -0.1), outline(0.9, -0.2), outline(1.8, -0.1)];
        assert_eq!(patches(&deep, 1.0), [(1, 0), (0, 0), (2, 0)]);
        let other_part = Outline { part: 1, ..outline(0.0, -0.1) };
        assert_eq!(patches(&[outline(0.0, -0.1), other_part], 1.0), [(0, 0), (1, 1)]);
        // Those of one depth in their order, however many there are.
        let layers: Vec<Outline> = (0..200).map(|i| outline(0.0, 0.1 * (i % 3) as Real)).collect();
        let expected = (0..3).flat_map(|layer| (layer..200).step_by(3).map(|contact| (contact, 0)));
        assert_eq!(patches(&layers, 1.0), expected.collect::<Vec<_>>());
        let turned = |degrees: Real| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Outline { normal: Vec3::new(sin, cos, 0.0), ..outline(0.0, -0.1) }
        };
        assert_eq!(patches(&[outline(0.0, -0.1), turned(5.0)], 1.0), [(0, 0), (1, 0)]);
        assert_eq!(patches(&[outline(0.0, -0.1), turned(6.0)], 1.0), [(0, 0), (1, 1)]);
    }

    /// Would catch points of one side only, a second one that is not the farthest, and points that
    /// come twice.
    #[test]
    fn the_outermost_points_are_chosen_once() {
        let at = |places: &[[Real; 2]]| -> Vec<Vec3> {
            places.iter().map(|&[x, z]| Vec3::new(x, 0.0, z)).collect()
        };
        let points =
            at(&[[0.0, 0.0], [1.0, 0.3], [3.0, 0.0], [1.0, -0.5], [2.0, 0.9], [2.0, -0.4]]);
        let mut chosen = outermost(&points, Vec3::Y);
        chosen.sort_unstable();
        assert_eq!(chosen[..], [0, 2, 3, 4]);
        let line = at(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [2.5, 0.0]]);
        assert_eq!(outermost(&line, Vec3::Y)[..], [0, 3]);
        assert_eq!(outermost(&points[..4], Vec3::Y)[..], [0, 1, 2, 3]);
    }
}
