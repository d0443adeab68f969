//! The parts of a shape, what stays the same from query to query, and parts at the pose of a query.

use std::sync::OnceLock;

use glamx::{DQuat, DVec3, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{CompositeShape, Shape, ShapeType, TypedShape};
use sbbk_core::traverse::{Placement, TestedBox};
use sbbk_core::volumes::Sphere;

use super::shape::{ConvexShape, Extent, KeptHull, ShapeToken, ball_around};
use crate::mesh::box_of;
use crate::pair::pose::MeshPlace;

/// The convex shapes that a shape is made of.
#[derive(Copy, Clone)]
pub(crate) enum Parts<'a> {
    One(ConvexShape<'a>),
    /// A compound or a polyline.
    Many(&'a dyn CompositeShape, ShapeToken),
}

/// A part of a shape.
pub(super) struct Part<'p> {
    /// Pose in the frame of the whole; `None` for the identity.
    pub(super) pose: Option<&'p Pose>,
    pub(super) shape: ConvexShape<'p>,
    /// Normal cone of the part.
    pub(super) cone: Option<&'p dyn NormalConstraints>,
}

impl<'a> Parts<'a> {
    /// Returns `None` for shapes that only Parry supports. Does not look at the
    /// [parts](Self::are_supported) of compounds.
    pub(crate) fn of(shape: &'a dyn Shape) -> Option<Self> {
        match shape.as_typed_shape() {
            TypedShape::Compound(compound) => {
                let (parts, flags) = (compound.shapes(), compound.flags().bits().into());
                let aabb = compound.local_aabb();
                let token = ShapeToken::of_parts(ShapeType::Compound, parts, flags, aabb);
                Some(Self::Many(compound, token))
            }
            TypedShape::Polyline(polyline) if !polyline.is_deformable() => {
                let (parts, flags) = (polyline.indices(), polyline.flags().bits().into());
                let aabb = polyline.bvh().root_aabb();
                let token = ShapeToken::of_parts(ShapeType::Polyline, parts, flags, &aabb);
                Some(Self::Many(polyline, token))
            }
            _ => ConvexShape::of(shape).map(Self::One),
        }
    }

    /// Returns false for a compound with a part that only Parry supports. Looks at all parts.
    pub(crate) fn are_supported(&self, shape: &dyn Shape) -> bool {
        let Self::Many(..) = self else { return true };
        let TypedShape::Compound(compound) = shape.as_typed_shape() else { return true };
        compound.shapes().iter().all(|(_, part)| ConvexShape::of(&**part).is_some())
    }

    /// Calls `then` with a part.
    #[inline]
    pub(super) fn with<T>(&self, index: u32, then: impl FnOnce(Part<'_>) -> T) -> Option<T> {
        let composite = match self {
            Self::One(shape) => return Some(then(Part { pose: None, shape: *shape, cone: None })),
            Self::Many(composite, _) => composite,
        };
        let (mut then, mut result) = (Some(then), None);
        composite.map_part_at(index, &mut |pose, shape, cone| {
            if let (Some(shape), Some(then)) = (ConvexShape::of(shape), then.take()) {
                result = Some(then(Part { pose, shape, cone }));
            }
        });
        result
    }

    /// Calls `found` with the parts whose boxes intersect a box in the frame of the whole. Boxes
    /// around several parts must also be near.
    pub(super) fn intersecting(
        &self,
        aabb: &Aabb,
        is_near: impl Fn(TestedBox) -> bool,
        found: impl FnMut(u32),
    ) {
        match self {
            Self::One(_) => std::iter::once(0).for_each(found),
            Self::Many(composite, _) => {
                let may_have = |node: &BvhNode| {
                    node.aabb().intersects(aabb) && (node.is_leaf() || is_near(box_of(node)))
                };
                composite.bvh().leaves(may_have).for_each(found);
            }
        }
    }
}

/// Data of the parts, kept from query to query. A single shape has index 0.
#[derive(Clone, Debug, Default)]
pub(crate) struct PartData {
    token: Option<ShapeToken>,
    /// Points of polyhedra, computed at first use.
    hulls: Vec<KeptHull>,
    /// Computed at first use: all at once take a fifth of the first query of 24 parts.
    extents: Vec<OnceLock<Extent>>,
    /// A ball around the whole.
    pub(super) ball: Sphere,
    /// Upper bound of coordinates in the frame of any part, for rounding.
    pub(super) magnitude: Real,
    /// Size of the largest part, with its distance from the origin of the whole.
    size: OnceLock<Real>,
}

impl PartData {
    /// Updates the data to the current parts. Returns true if they replace others.
    pub(super) fn update(&mut self, parts: &Parts<'_>) -> bool {
        let token = match parts {
            Parts::One(shape) => shape.token(),
            Parts::Many(_, token) => *token,
        };
        if self.token == Some(token) {
            return false;
        }
        let is_replaced = self.token.is_some();
        *self = Self { token: Some(token), ..Self::default() };
        match *parts {
            Parts::One(shape) => {
                let extent = Extent::of(shape);
                (self.ball, self.magnitude) = (extent.ball(), extent.size());
                self.hulls = vec![KeptHull::with_faces()];
                self.extents = vec![OnceLock::from(extent)];
            }
            Parts::Many(_, ShapeToken { list: (_, count), numbers: [min, max, _], .. }) => {
                self.ball = ball_around(min, max);
                self.hulls = vec![KeptHull::with_faces(); count];
                self.extents = vec![OnceLock::new(); count];
                let offsets = (0..count as u32).filter_map(|part| {
                    parts.with(part, |part| part.pose.map_or(0.0, |pose| pose.translation.length()))
                });
                let offset = offsets.fold(0.0, Real::max);
                // Bounds coordinates in a part's frame by the way over the origin of the whole.
                let bound = self.ball.centre.length() + self.ball.radius + 2.0 * offset;
                // Boxes do not contain half-spaces.
                self.magnitude = if bound.is_finite() { bound } else { self.size(parts) };
            }
        }
        is_replaced
    }

    /// Returns the points of a polyhedron.
    pub(super) fn hull(&self, part: u32) -> &KeptHull {
        &self.hulls[part as usize]
    }

    pub(super) fn extent(&self, index: u32, part: &Part<'_>) -> Extent {
        *self.extents[index as usize].get_or_init(|| Extent::of(part.shape))
    }

    /// Returns the radius for contact reduction; infinite for half-spaces.
    pub(super) fn patch_radius(&self, parts: &Parts<'_>) -> Real {
        if self.ball.radius.is_finite() { 1.75 * self.size(parts) } else { Real::INFINITY }
    }

    /// Returns the size of the largest part, with its distance from the origin of the whole.
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

/// A part at the pose of a query, with all that its triangles share.
#[derive(Copy, Clone)]
pub(crate) struct PlacedPart {
    pub(super) index: u32,
    pub(super) extent: Extent,
    /// Pose of the mesh in the frame of the part.
    pub(super) placement: Placement,
    /// Origin of the part in the frame of the mesh.
    pub(super) origin_in_mesh: DVec3,
    /// True for balls: the part's frame has the axes of the mesh, and no triangle needs a rotation.
    pub(super) has_mesh_axes: bool,
}

impl PlacedPart {
    /// `placements`: the mesh in the frame of the whole, and the whole in the frame of the mesh.
    #[inline(always)]
    pub(super) fn new(
        index: u32,
        part: &Part<'_>,
        placements: [&Placement; 2],
        extent: Extent,
    ) -> Self {
        let [placement, inverse] = placements;
        // In f64: a product of poses in f32 is off by 1e-7 of the distance.
        let posed = part.pose.map(|part| Placement::new(part).inverted().of(placement));
        let origin_in_mesh = posed.map_or(inverse.translation, |it| it.inverted().translation);
        let placement = posed.unwrap_or(*placement);
        Self { index, extent, placement, origin_in_mesh, has_mesh_axes: false }
    }

    /// Returns this part, a whole shape, at another pose of shape 2 in the frame of shape 1.
    pub(super) fn moved(&self, mesh_place: MeshPlace, placement: &Placement) -> Self {
        let [inverse, placement] = mesh_place.swap([*placement, placement.inverted()]);
        Self { placement, origin_in_mesh: inverse.translation, has_mesh_axes: false, ..*self }
    }

    /// Returns the placement of the part in the frame of the mesh.
    pub(super) fn inverse(&self) -> Placement {
        Placement { translation: self.origin_in_mesh, ..self.placement.inverted() }
    }

    /// Returns the pose of the part in the frame of the mesh, in f32 and with a unit quaternion.
    pub(super) fn pose_in_mesh(&self) -> Pose {
        let rotation = DQuat::from_mat3(&self.placement.inverse).normalize();
        Pose::from_parts(self.origin_in_mesh.as_vec3(), rotation.as_quat())
    }

    /// Returns points of the mesh in the frame of the part.
    #[inline(always)]
    pub(super) fn in_part(&self, [a, b, c]: [Vec3; 3]) -> [DVec3; 3] {
        if self.has_mesh_axes {
            return [a, b, c].map(|point| point.as_dvec3() - self.origin_in_mesh);
        }
        let at = |point: Vec3| self.placement.to_frame1(point, Vec3::ZERO);
        [at(a), at(b), at(c)]
    }

    /// Returns a point of the part in the frame of the mesh.
    #[inline(always)]
    pub(crate) fn in_mesh(&self, point: DVec3) -> Vec3 {
        if self.has_mesh_axes {
            return (self.origin_in_mesh + point).as_vec3();
        }
        (self.placement.inverse * (point - self.placement.translation)).as_vec3()
    }

    /// Returns a unit vector of the part's frame in the axes of the mesh and of the part.
    #[inline(always)]
    pub(crate) fn directions(&self, normal: DVec3) -> [DVec3; 2] {
        if self.has_mesh_axes {
            [normal, (self.placement.rotation * normal).normalize()]
        } else {
            [(self.placement.inverse * normal).normalize(), normal]
        }
    }

    /// Returns true only if a triangle is farther than `reach` from the part without its radius:
    /// their boxes are, along the axes of the part.
    #[inline(always)]
    pub(super) fn is_beyond(&self, [a, b, c]: &[DVec3; 3], reach: f64) -> bool {
        let (min, max, reach) = self.extent.widest(reach);
        let gap = (a.min(*b).min(*c) - max).max(min - a.max(*b).max(*c)).max(DVec3::ZERO);
        gap.length_squared() > reach * reach
    }
}

#[cfg(test)]
mod tests {
    use parry3d::shape::SharedShape;

    use super::*;

    /// Catches parts that stick out of the ball or the bound of coordinates: slack would be too
    /// large.
    #[test]
    fn parts_are_within_the_bounds() {
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
            let mut data = PartData::default();
            data.update(&parts);
            let ball = data.ball;
            for index in 0..data.extents.len() as u32 {
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
            assert!(data.magnitude >= data.size(&parts));
        }
    }

    /// Catches a compound whose box leaves out a half-space.
    #[test]
    fn a_half_space_has_an_infinite_ball() {
        let shapes = [SharedShape::halfspace(Vec3::Y), SharedShape::ball(1.0)];
        let compound =
            SharedShape::compound(shapes.iter().map(|s| (Pose::IDENTITY, s.clone())).collect());
        for whole in [&shapes[0], &compound] {
            let parts = Parts::of(&**whole).unwrap();
            let mut data = PartData::default();
            data.update(&parts);
            assert_eq!(data.ball.radius, Real::INFINITY);
            assert!(data.magnitude.is_finite());
        }
    }
}
