//! Parry's convex shapes, as far as a walk over a mesh has to know them.

use glamx::{DVec3, Vec3, Vec3Swizzles};
use parry3d::math::{Real, Vector};
use parry3d::shape::{Ball, Cuboid, HalfSpace, PolygonalFeatureMap, Shape, ShapeType};
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

/// A convex shape that Parry has contacts with triangles for, by how Parry makes them.
/// `ShapeType::Custom` is none: what its support map does is not known.
#[derive(Copy, Clone)]
pub(crate) enum ConvexShape<'a> {
    /// From the projection of the centre.
    Ball(&'a Ball),
    /// From the support feature of the triangle.
    HalfSpace(&'a HalfSpace),
    /// From separating axes.
    Cuboid(&'a Cuboid),
    /// From the closest points and two support features, with a radius around the shape.
    Features { shape: &'a dyn Shape, map: &'a dyn PolygonalFeatureMap, radius: Real },
}

impl<'a> ConvexShape<'a> {
    /// `None` if the shape is of another kind.
    pub(super) fn of(shape: &'a dyn Shape) -> Option<Self> {
        Some(match shape.shape_type() {
            ShapeType::Ball => Self::Ball(shape.as_ball()?),
            ShapeType::HalfSpace => Self::HalfSpace(shape.as_halfspace()?),
            ShapeType::Cuboid => Self::Cuboid(shape.as_cuboid()?),
            ShapeType::Capsule
            | ShapeType::Segment
            | ShapeType::Triangle
            | ShapeType::ConvexPolyhedron
            | ShapeType::Cylinder
            | ShapeType::Cone
            | ShapeType::RoundCuboid
            | ShapeType::RoundTriangle
            | ShapeType::RoundCylinder
            | ShapeType::RoundCone
            | ShapeType::RoundConvexPolyhedron => {
                let (map, radius) = shape.as_polygonal_feature_map()?;
                Self::Features { shape, map, radius }
            }
            _ => return None,
        })
    }
}

impl ConvexShape<'_> {
    /// That of the border around what [`core_contact`](super::features::core_contact) knows.
    pub(super) fn radius(&self) -> Real {
        match *self {
            Self::Ball(ball) => ball.radius,
            Self::Features { radius, .. } => radius,
            Self::HalfSpace(_) | Self::Cuboid(_) => 0.0,
        }
    }
}

impl ConvexShape<'_> {
    /// A point within the shape; none of a half-space.
    pub(super) fn middle(&self) -> Option<DVec3> {
        match self {
            Self::Ball(_) | Self::Cuboid(_) => Some(DVec3::ZERO),
            Self::HalfSpace(_) => None,
            Self::Features { map, .. } => {
                // Along an axis of the shape both ends of it can be one corner.
                let ends = [SKEW, SKEW.yzx(), SKEW.zxy()].map(|axis| {
                    let [one, other] = [axis, -axis].map(|axis| map.local_support_point(axis));
                    (one + other).as_dvec3()
                });
                Some(ends.into_iter().sum::<DVec3>() / 6.0)
            }
        }
    }
}

/// How far a shape extends: its radius and the box around the rest of it.
///
/// Also tells, as far as a few numbers do, that a shape is the one that it was at the last query. A
/// host drops the workspace of a pair when it edits a shape (see `mesh/identity.rs`); this is for
/// those that do not.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Extent {
    shape_type: ShapeType,
    /// The border of round shapes, capsules and balls; 0 of others.
    pub(super) radius: Real,
    min: Vec3,
    max: Vec3,
    /// The support point in a skew direction; the normal of a half-space.
    skew: Vec3,
}

/// The ball around a box, wider by what some ten operations on its coordinates lose.
pub(super) fn ball_around(min: Vec3, max: Vec3) -> Sphere {
    let (centre, half) = (0.5 * (min + max), 0.5 * (max - min).length());
    Sphere { centre, radius: half + gamma(32) * (centre.length() + half) }
}

/// A direction in which a shape is not likely to have a face or an axis.
const SKEW: Vec3 = Vec3::new(0.267, 0.535, 0.802);

impl Extent {
    pub(super) fn of(shape: ConvexShape<'_>) -> Self {
        let point = |shape_type| Self {
            shape_type,
            radius: 0.0,
            min: Vec3::ZERO,
            max: Vec3::ZERO,
            skew: Vec3::ZERO,
        };
        match shape {
            ConvexShape::Ball(ball) => Self { radius: ball.radius, ..point(ShapeType::Ball) },
            ConvexShape::HalfSpace(half_space) => {
                Self { skew: half_space.normal, ..point(ShapeType::HalfSpace) }
            }
            ConvexShape::Cuboid(cuboid) => {
                let corner = cuboid.half_extents;
                Self { min: -corner, max: corner, ..point(ShapeType::Cuboid) }
            }
            ConvexShape::Features { shape, map, radius } => {
                let end = |axis: Vector| map.local_support_point(axis);
                Self {
                    shape_type: shape.shape_type(),
                    radius,
                    min: Vec3::new(end(-Vec3::X).x, end(-Vec3::Y).y, end(-Vec3::Z).z),
                    max: Vec3::new(end(Vec3::X).x, end(Vec3::Y).y, end(Vec3::Z).z),
                    skew: map.local_support_point(SKEW),
                }
            }
        }
    }

    /// The largest absolute coordinate, radius included: what rounding is relative to. That of a
    /// half-space does not count.
    pub(super) fn size(&self) -> Real {
        self.magnitude() + self.radius
    }

    /// That of the core.
    fn magnitude(&self) -> Real {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Whether it goes on without end.
    pub(super) fn is_endless(&self) -> bool {
        self.shape_type == ShapeType::HalfSpace
    }

    /// A ball around it.
    pub(super) fn ball(&self) -> Sphere {
        let Sphere { centre, radius } = ball_around(self.min, self.max);
        let radius = (radius + self.radius) * (1.0 + gamma(8));
        Sphere { centre, radius: if self.is_endless() { Real::INFINITY } else { radius } }
    }

    /// The box around the shape without its radius, and the radius.
    pub(super) fn bounds(&self) -> (Vec3, Vec3, Real) {
        (self.min, self.max, self.radius)
    }

    /// The box around the shape without its radius, and `reach`, longer by what Parry's support points
    /// may miss. A half-space is near everything.
    #[inline(always)]
    pub(super) fn widest(&self, reach: f64) -> (DVec3, DVec3, f64) {
        let missed = if self.is_endless() { f64::INFINITY } else { gamma(16).into() };
        let reach = reach + missed * f64::from(self.magnitude().max(f32::MIN_POSITIVE));
        (self.min.as_dvec3(), self.max.as_dvec3(), reach)
    }

    /// At least how far the shape reaches along a direction of any length; infinite where it has no
    /// end.
    ///
    /// Parry's support points are found in f32, from the direction rounded to f32: the best point
    /// is missed, or off, by a few roundings of the largest coordinate.
    pub(super) fn reach(&self, shape: ConvexShape<'_>, direction: DVec3) -> f64 {
        match shape {
            ConvexShape::Ball(ball) => f64::from(ball.radius) * direction.length(),
            ConvexShape::HalfSpace(half_space) => {
                let is_normal = direction == half_space.normal.as_dvec3();
                if is_normal { 0.0 } else { f64::INFINITY }
            }
            ConvexShape::Cuboid(cuboid) => direction.abs().dot(cuboid.half_extents.as_dvec3()),
            ConvexShape::Features { map, radius, .. } => {
                let point = map.local_support_point(direction.as_vec3()).as_dvec3();
                let rounding = gamma(16) * self.magnitude();
                direction.dot(point)
                    + f64::from(rounding) * direction.abs().element_sum()
                    + f64::from(radius) * direction.length()
            }
        }
    }
}
