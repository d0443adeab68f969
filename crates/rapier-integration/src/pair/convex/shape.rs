//! Parry's convex shapes, as far as a descent has to know them.

use glamx::{DVec3, Vec3};
use parry3d::math::{Real, Vector};
use parry3d::shape::{Ball, Cuboid, HalfSpace, PolygonalFeatureMap, Shape, ShapeType};
use sbbk_core::traverse::{Convex, Outline};
use sbbk_core::volumes::rounding::gamma;

/// A convex shape that Parry has contacts with triangles for. Not `ShapeType::Custom`: nobody knows what its support map
/// does.
#[derive(Copy, Clone)]
pub(crate) struct ConvexShape<'a> {
    pub(super) shape: &'a dyn Shape,
    pub(super) kind: Kind<'a>,
    fingerprint: Fingerprint,
}

/// How Parry makes its contacts.
#[derive(Copy, Clone)]
pub(super) enum Kind<'a> {
    /// From the projection of the centre.
    Ball(&'a Ball),
    /// From the support feature of the triangle.
    HalfSpace(&'a HalfSpace),
    /// From separating axes.
    Cuboid(&'a Cuboid),
    /// From GJK and two support features, with a radius around the shape.
    Features(&'a dyn PolygonalFeatureMap, Real),
}

/// What a shape was at the last query, as far as a few numbers tell: its kind, its box, and its support point in a skew
/// direction.
///
/// A host drops the workspace of a pair when it edits a shape, see [`crate::mesh`]; this is for those that do not.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(in crate::pair) struct Fingerprint {
    shape_type: ShapeType,
    radius: Real,
    min: Vec3,
    max: Vec3,
    skew: Vec3,
}

/// Points in no direction that a shape is likely to have a face or an axis in.
const SKEW: Vec3 = Vec3::new(0.267, 0.535, 0.802);

impl<'a> ConvexShape<'a> {
    /// Whether shapes of this type are among them.
    pub(crate) fn is_known(shape_type: ShapeType) -> bool {
        matches!(
            shape_type,
            ShapeType::Ball
                | ShapeType::HalfSpace
                | ShapeType::Cuboid
                | ShapeType::Capsule
                | ShapeType::Segment
                | ShapeType::Triangle
                | ShapeType::ConvexPolyhedron
                | ShapeType::Cylinder
                | ShapeType::Cone
                | ShapeType::RoundCuboid
                | ShapeType::RoundTriangle
                | ShapeType::RoundCylinder
                | ShapeType::RoundCone
                | ShapeType::RoundConvexPolyhedron
        )
    }

    /// `None` if the shape is of another kind.
    pub(crate) fn of(shape: &'a dyn Shape) -> Option<Self> {
        let kind = match shape.shape_type() {
            ShapeType::Ball => Kind::Ball(shape.as_ball()?),
            ShapeType::HalfSpace => Kind::HalfSpace(shape.as_halfspace()?),
            ShapeType::Cuboid => Kind::Cuboid(shape.as_cuboid()?),
            other if Self::is_known(other) => {
                let (map, radius) = shape.as_polygonal_feature_map()?;
                Kind::Features(map, radius)
            }
            _ => return None,
        };
        Some(Self { shape, kind, fingerprint: Fingerprint::of(shape.shape_type(), kind) })
    }

    pub(in crate::pair) fn fingerprint(&self) -> Fingerprint {
        self.fingerprint
    }

    /// The radius around the core that Parry's routine knows.
    pub(super) fn radius(&self) -> Real {
        self.fingerprint.radius
    }

    /// The largest absolute coordinate of the core: what its rounding is relative to.
    fn magnitude(&self) -> Real {
        let Fingerprint { min, max, .. } = self.fingerprint;
        min.abs().max(max.abs()).max_element()
    }
}

impl Fingerprint {
    fn of(shape_type: ShapeType, kind: Kind<'_>) -> Self {
        let none =
            Self { shape_type, radius: 0.0, min: Vec3::ZERO, max: Vec3::ZERO, skew: Vec3::ZERO };
        match kind {
            Kind::Ball(ball) => Self { radius: ball.radius, ..none },
            Kind::HalfSpace(half_space) => Self { skew: half_space.normal, ..none },
            Kind::Cuboid(cuboid) => {
                let corner = cuboid.half_extents;
                Self { min: -corner, max: corner, ..none }
            }
            Kind::Features(map, radius) => {
                let end = |axis: Vector| map.local_support_point(axis);
                Self {
                    shape_type,
                    radius,
                    min: Vec3::new(end(-Vec3::X).x, end(-Vec3::Y).y, end(-Vec3::Z).z),
                    max: Vec3::new(end(Vec3::X).x, end(Vec3::Y).y, end(Vec3::Z).z),
                    skew: map.local_support_point(SKEW),
                }
            }
        }
    }
}

impl Convex for ConvexShape<'_> {
    /// Parry's support points are found in f32, from the direction rounded to f32: the best point is missed, or off, by
    /// a few roundings of the largest coordinate.
    fn reach(&self, direction: DVec3) -> f64 {
        match self.kind {
            Kind::Ball(ball) => f64::from(ball.radius) * direction.length(),
            // The descent asks along the normal. Any other direction leaves the half-space somewhere.
            Kind::HalfSpace(half_space) => {
                let is_normal = direction == half_space.normal.as_dvec3();
                if is_normal { 0.0 } else { f64::INFINITY }
            }
            Kind::Cuboid(cuboid) => direction.abs().dot(cuboid.half_extents.as_dvec3()),
            Kind::Features(map, radius) => {
                let point = map.local_support_point(direction.as_vec3()).as_dvec3();
                let rounding = gamma(16) * self.magnitude();
                direction.dot(point)
                    + f64::from(rounding) * direction.abs().element_sum()
                    + f64::from(radius) * direction.length()
            }
        }
    }

    fn outline(&self) -> Outline {
        if let Kind::HalfSpace(half_space) = self.kind {
            return Outline::HalfSpace { normal: half_space.normal.as_dvec3() };
        }
        let Fingerprint { shape_type, radius, min, max, .. } = self.fingerprint;
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        let half_lengths = 0.5 * (max - min);
        let is_box = matches!(shape_type, ShapeType::Cuboid | ShapeType::RoundCuboid);
        // A segment along an axis, or a point.
        let is_line = half_lengths.to_array().iter().filter(|&&half| half > 0.0).count() <= 1;
        Outline::RoundBox {
            centre: 0.5 * (min + max),
            half_lengths,
            radius: f64::from(radius),
            is_exact: is_box || is_line,
        }
    }
}
