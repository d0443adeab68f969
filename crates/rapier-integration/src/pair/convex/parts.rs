use std::sync::OnceLock;

use glamx::Vec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{CompositeShape, Shape};
use sbbk_core::contact::convex::HullPoints;
use sbbk_core::volumes::Sphere;

use super::shape::{ConvexShape, Extent, ball_around};

/// The convex shapes that a shape is made of.
#[derive(Copy, Clone)]
pub(crate) enum Parts<'a> {
    /// It is convex itself.
    One(ConvexShape<'a>),
    /// A compound or a polyline.
    Many(Composite<'a>),
}

/// A shape with parts in a hierarchy of its own.
#[derive(Copy, Clone)]
pub(crate) struct Composite<'a> {
    shape: &'a dyn CompositeShape,
    token: CompositeToken,
}

/// One of the parts.
pub(super) struct Part<'p> {
    /// Where it is in the frame of the whole, if elsewhere.
    pub(super) pose: Option<&'p Pose>,
    pub(super) shape: ConvexShape<'p>,
    /// The cone that contact normals of the part must be in.
    pub(super) cone: Option<&'p dyn NormalConstraints>,
}

/// What a composite was at the last query, in constant time. Parry has no call that edits the parts
/// of a compound; a host drops the workspace when it puts another shape in its place, or edits a
/// polyline, and this is for those that do not.
#[derive(Copy, Clone, Debug, PartialEq)]
struct CompositeToken {
    address: usize,
    part_count: usize,
    flags: u32,
    aabb: Aabb,
}

impl<'a> Parts<'a> {
    /// `None` if a part is of a kind that only Parry answers for.
    pub(crate) fn of(shape: &'a dyn Shape) -> Option<Self> {
        if let Some(compound) = shape.as_compound() {
            let parts = compound.shapes();
            let token = CompositeToken {
                address: parts.as_ptr().addr(),
                part_count: parts.len(),
                flags: u32::from(compound.flags().bits()),
                aabb: *compound.local_aabb(),
            };
            let is_known = parts.iter().all(|(_, part)| ConvexShape::of(&**part).is_some());
            return is_known.then_some(Self::Many(Composite { shape: compound, token }));
        }
        if let Some(polyline) = shape.as_polyline() {
            let token = CompositeToken {
                address: polyline.vertices().as_ptr().addr(),
                part_count: polyline.num_segments(),
                flags: u32::from(polyline.flags().bits()),
                aabb: polyline.bvh().root_aabb(),
            };
            let is_rigid = !polyline.is_deformable();
            return is_rigid.then_some(Self::Many(Composite { shape: polyline, token }));
        }
        ConvexShape::of(shape).map(Self::One)
    }

    /// Hands on a part.
    #[inline]
    pub(super) fn with<T>(&self, index: u32, then: impl FnOnce(Part<'_>) -> T) -> Option<T> {
        let composite = match self {
            Self::One(shape) => return Some(then(Part { pose: None, shape: *shape, cone: None })),
            Self::Many(composite) => composite,
        };
        let (mut then, mut result) = (Some(then), None);
        composite.shape.map_part_at(index, &mut |pose, shape, cone| {
            if let (Some(shape), Some(then)) = (ConvexShape::of(shape), then.take()) {
                result = Some(then(Part { pose, shape, cone }));
            }
        });
        result
    }

    /// Calls `found` with the parts whose boxes meet a box in the frame of the whole.
    pub(super) fn meeting(&self, aabb: &Aabb, found: impl FnMut(u32)) {
        match self {
            Self::One(_) => std::iter::once(0).for_each(found),
            Self::Many(composite) => composite.shape.bvh().intersect_aabb(aabb).for_each(found),
        }
    }
}

/// What is known of the parts from query to query.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnownParts {
    token: Option<Token>,
    /// The points of those parts that are hulls, once they have been needed; of one shape the first.
    hulls: Vec<OnceLock<HullPoints>>,
    /// How far each part extends, once that has been needed; of one shape the first. (All at the
    /// first query: a fifth of that of 24 parts.)
    extents: Vec<OnceLock<Extent>>,
    /// The greatest radius of a part.
    pub(super) radius: Real,
    /// At least the greatest size of a part, with its distance from the origin of the whole.
    pub(super) magnitude: Real,
    /// The same exactly, once it has been needed.
    size: OnceLock<Real>,
}

#[derive(Copy, Clone, Debug, PartialEq)]
enum Token {
    One(Extent),
    Many(CompositeToken),
}

impl KnownParts {
    /// Takes note of the parts as they are now. Whether others were known before.
    pub(super) fn update(&mut self, parts: &Parts<'_>) -> bool {
        let token = match parts {
            Parts::One(shape) => Token::One(Extent::of(*shape)),
            Parts::Many(composite) => Token::Many(composite.token),
        };
        if self.token == Some(token) {
            return false;
        }
        let was_known = self.token.is_some();
        *self = Self { token: Some(token), ..Self::default() };
        match token {
            Token::One(shape) => {
                (self.radius, self.magnitude) = (shape.radius, shape.size());
                self.hulls = vec![OnceLock::new()];
                self.extents = vec![OnceLock::from(shape)];
            }
            Token::Many(CompositeToken { part_count, aabb, .. }) => {
                self.hulls = vec![OnceLock::new(); part_count];
                self.extents = vec![OnceLock::new(); part_count];
                let mut offset: Real = 0.0;
                for part in 0..part_count as u32 {
                    parts.with(part, |part| {
                        self.radius = self.radius.max(part.shape.radius());
                        offset =
                            offset.max(part.pose.map_or(0.0, |pose| pose.translation.length()));
                    });
                }
                // From the origin of a part to its points it is no farther than by way of that of all.
                let Sphere { centre, radius } = ball_around(aabb.mins, aabb.maxs);
                let magnitude = centre.length() + radius + 2.0 * offset;
                // Half-spaces are in no box.
                let is_known = magnitude.is_finite();
                self.magnitude = if is_known { magnitude } else { self.size(parts) };
            }
        }
        was_known
    }

    /// The points of a part that is a hull.
    pub(super) fn hull(&self, part: u32) -> &OnceLock<HullPoints> {
        &self.hulls[part as usize]
    }

    /// That of a part.
    pub(super) fn extent(&self, index: u32, part: &Part<'_>) -> Extent {
        *self.extents[index as usize].get_or_init(|| Extent::of(part.shape))
    }

    /// A ball around all of them.
    pub(super) fn ball(&self) -> Sphere {
        match self.token {
            Some(Token::One(extent)) => extent.ball(),
            Some(Token::Many(CompositeToken { aabb, .. })) => ball_around(aabb.mins, aabb.maxs),
            None => Sphere { centre: Vec3::ZERO, radius: Real::INFINITY },
        }
    }

    /// The radius that patches are measured by.
    pub(super) fn patch_radius(&self, parts: &Parts<'_>) -> Real {
        let is_endless = matches!(self.token, Some(Token::One(extent)) if extent.is_endless());
        if is_endless { Real::INFINITY } else { 1.75 * self.size(parts) }
    }

    /// The greatest size of a part, with its distance from the origin of the whole.
    fn size(&self, parts: &Parts<'_>) -> Real {
        *self.size.get_or_init(|| {
            let size = |index: u32| {
                parts.with(index, |part| {
                    let offset = part.pose.map_or(0.0, |pose| pose.translation.abs().max_element());
                    self.extent(index, &part).size() + offset
                })
            };
            (0..self.extents.len() as u32).filter_map(size).fold(0.0, Real::max)
        })
    }
}

#[cfg(test)]
mod tests {
    use parry3d::shape::SharedShape;

    use super::*;

    /// Would catch a ball that parts stick out of, so that a pair counts as having moved less than it
    /// has, and a bound of coordinates that some are beyond.
    #[test]
    fn what_is_known_of_parts_holds_them() {
        let [a, b, c] =
            [Vec3::new(3.0, 0.1, 0.0), Vec3::new(2.0, 0.5, 0.3), Vec3::new(2.5, 1.0, -1.0)];
        let shapes = [
            SharedShape::cuboid(0.5, 0.3, 2.0),
            SharedShape::capsule(a, b, 0.4),
            SharedShape::round_triangle(a, b, c, 0.2),
            SharedShape::round_cone(0.7, 0.3, 0.1),
            SharedShape::convex_hull(&[a, b, c, Vec3::ZERO, Vec3::ONE]).unwrap(),
        ];
        let at =
            |x: Real| Pose::from_parts(Vec3::new(x, -2.0, 1.0), glamx::Quat::from_rotation_z(x));
        let posed = shapes.iter().zip([0.0, 5.0, -3.0, 9.0, 2.0]).map(|(s, x)| (at(x), s.clone()));
        let compound = SharedShape::compound(posed.collect());
        for whole in shapes.iter().chain([&compound]) {
            let parts = Parts::of(&**whole).unwrap();
            let mut known = KnownParts::default();
            known.update(&parts);
            let ball = known.ball();
            for index in 0..known.extents.len() as u32 {
                parts.with(index, |part| {
                    let ConvexShape::Features { map, radius, .. } = part.shape else { return };
                    for direction in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, Vec3::NEG_ONE]
                    {
                        let direction = direction.normalize();
                        let point = map.local_support_point(direction) + direction * radius;
                        let point = part.pose.map_or(point, |pose| *pose * point);
                        assert!(point.distance(ball.centre) <= ball.radius);
                    }
                });
            }
            assert!(known.magnitude >= known.size(&parts));
        }
    }

    /// Would catch a half-space in a compound that counts as being in a box.
    #[test]
    fn a_half_space_is_in_no_ball() {
        let shapes = [SharedShape::halfspace(Vec3::Y), SharedShape::ball(1.0)];
        let compound =
            SharedShape::compound(shapes.iter().map(|s| (Pose::IDENTITY, s.clone())).collect());
        for whole in [&shapes[0], &compound] {
            let parts = Parts::of(&**whole).unwrap();
            let mut known = KnownParts::default();
            known.update(&parts);
            assert_eq!(known.ball().radius, Real::INFINITY);
            assert!(known.magnitude.is_finite());
        }
    }
}
