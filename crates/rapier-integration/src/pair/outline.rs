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
