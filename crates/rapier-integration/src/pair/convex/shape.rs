//! Parry's convex shapes: kinds, extents, bounds.

use std::sync::OnceLock;

use glamx::{DVec3, Vec3, Vec3Swizzles};
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::shape::{
    Ball, ConvexPolyhedron, Cuboid, HalfSpace, PolygonalFeatureMap, Shape, ShapeType, TypedShape,
};
use sbbk_core::contact::convex::HullPoints;
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

/// A convex shape, by how its contact points are found. `ShapeType::Custom` is not supported: its
/// support map may do anything.
#[derive(Copy, Clone)]
pub(crate) enum ConvexShape<'a> {
    Ball(&'a Ball),
    HalfSpace(&'a HalfSpace),
    Cuboid(&'a Cuboid),
    /// A shape with polygonal features and a rounding radius.
    Features {
        /// The shape without its radius.
        core: TypedShape<'a>,
        map: &'a dyn PolygonalFeatureMap,
        radius: Real,
    },
}

impl<'a> ConvexShape<'a> {
    /// Returns `None` for all other kinds of shapes.
    pub(crate) fn of(shape: &'a dyn Shape) -> Option<Self> {
        let core = match shape.as_typed_shape() {
            TypedShape::Ball(ball) => return Some(Self::Ball(ball)),
            TypedShape::HalfSpace(half_space) => return Some(Self::HalfSpace(half_space)),
            TypedShape::Cuboid(cuboid) => return Some(Self::Cuboid(cuboid)),
            TypedShape::Capsule(it) => TypedShape::Segment(&it.segment),
            TypedShape::RoundTriangle(it) => TypedShape::Triangle(&it.inner_shape),
            TypedShape::RoundCuboid(it) => TypedShape::Cuboid(&it.inner_shape),
            TypedShape::RoundCylinder(it) => TypedShape::Cylinder(&it.inner_shape),
            TypedShape::RoundCone(it) => TypedShape::Cone(&it.inner_shape),
            TypedShape::RoundConvexPolyhedron(it) => TypedShape::ConvexPolyhedron(&it.inner_shape),
            core @ (TypedShape::Segment(_)
            | TypedShape::Triangle(_)
            | TypedShape::Cylinder(_)
            | TypedShape::Cone(_)
            | TypedShape::ConvexPolyhedron(_)) => core,
            _ => return None,
        };
        let (map, radius) = shape.as_polygonal_feature_map()?;
        Some(Self::Features { core, map, radius })
    }
}

impl ConvexShape<'_> {
    /// Returns the rounding radius, 0 for shapes without one. A ball is a rounded point.
    pub(super) fn radius(&self) -> Real {
        match *self {
            Self::Ball(ball) => ball.radius,
            Self::Features { radius, .. } => radius,
            Self::HalfSpace(_) | Self::Cuboid(_) => 0.0,
        }
    }

    /// Returns the polyhedron of a shape, with or without a rounding radius.
    pub(super) fn polyhedron(&self) -> Option<&ConvexPolyhedron> {
        match self {
            Self::Features { core: TypedShape::ConvexPolyhedron(hull), .. } => Some(hull),
            _ => None,
        }
    }

    pub(super) fn token(&self) -> ShapeToken {
        let one = |vector| [vector, Vec3::ZERO, Vec3::ZERO];
        let round = |half_height, radius| one(Vec3::new(half_height, radius, 0.0));
        let mut list = (0, 0);
        let (kind, numbers) = match *self {
            Self::Ball(_) => (ShapeType::Ball, one(Vec3::ZERO)),
            Self::HalfSpace(half_space) => (ShapeType::HalfSpace, one(half_space.normal)),
            Self::Cuboid(cuboid) => (ShapeType::Cuboid, one(cuboid.half_extents)),
            Self::Features { core, .. } => match core {
                TypedShape::Segment(it) => (ShapeType::Segment, [it.a, it.b, Vec3::ZERO]),
                TypedShape::Triangle(it) => (ShapeType::Triangle, [it.a, it.b, it.c]),
                TypedShape::Cuboid(it) => (ShapeType::RoundCuboid, one(it.half_extents)),
                TypedShape::Cylinder(it) => (ShapeType::Cylinder, round(it.half_height, it.radius)),
                TypedShape::Cone(it) => (ShapeType::Cone, round(it.half_height, it.radius)),
                TypedShape::ConvexPolyhedron(hull) => {
                    let points = hull.points();
                    list = (points.as_ptr().addr(), points.len());
                    let [a, b] =
                        [points.first(), points.last()].map(|end| end.copied().unwrap_or_default());
                    (ShapeType::ConvexPolyhedron, [a, b, Vec3::ZERO])
                }
                _ => (ShapeType::Custom, one(Vec3::ZERO)),
            },
        };
        ShapeToken { kind, list, flags: 0, numbers, radius: self.radius() }
    }

    /// Returns a point within the shape; `None` for a half-space.
    pub(super) fn middle(&self) -> Option<DVec3> {
        match self {
            Self::Ball(_) | Self::Cuboid(_) => Some(DVec3::ZERO),
            Self::HalfSpace(_) => None,
            Self::Features { map, .. } => {
                // Along an axis of the shape both support points can be one corner.
                let ends = [SKEW, SKEW.yzx(), SKEW.zxy()].map(|axis| {
                    let [one, other] = [axis, -axis].map(|axis| map.local_support_point(axis));
                    (one + other).as_dvec3()
                });
                Some(ends.into_iter().sum::<DVec3>() / 6.0)
            }
        }
    }
}

/// Identifies a shape in constant time. Hosts drop the workspace when they replace or edit a shape;
/// the token notices the shapes of hosts that do not.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct ShapeToken {
    kind: ShapeType,
    /// Address and length of a list of points or parts.
    pub(super) list: (usize, usize),
    flags: u32,
    /// Numbers that define the shape, corners of the box around the parts, or first and last point.
    pub(super) numbers: [Vec3; 3],
    radius: Real,
}

impl ShapeToken {
    pub(super) fn of_parts<T>(kind: ShapeType, parts: &[T], flags: u32, aabb: &Aabb) -> Self {
        let list = (parts.as_ptr().addr(), parts.len());
        Self { kind, list, flags, numbers: [aabb.mins, aabb.maxs, Vec3::ZERO], radius: 0.0 }
    }
}

/// The extent of a shape: its rounding radius and the box around the rest.
#[derive(Copy, Clone, Debug)]
pub(super) struct Extent {
    pub(super) radius: Real,
    pub(super) min: Vec3,
    pub(super) max: Vec3,
    is_infinite: bool,
}

/// Returns the ball around a box, grown by the rounding of ten operations on the coordinates.
pub(super) fn ball_around(min: Vec3, max: Vec3) -> Sphere {
    let (centre, half) = (0.5 * (min + max), 0.5 * (max - min).length());
    Sphere { centre, radius: half + gamma(32) * (centre.length() + half) }
}

/// A direction unlikely to be normal to a face or along an axis of a shape.
const SKEW: Vec3 = Vec3::new(0.267, 0.535, 0.802);

impl Extent {
    pub(super) fn of(shape: ConvexShape<'_>) -> Self {
        let (radius, min, max) = (shape.radius(), Vec3::ZERO, Vec3::ZERO);
        let point = Self { radius, min, max, is_infinite: false };
        if let Some(hull) = shape.polyhedron() {
            let points = || hull.points().iter().copied();
            let min = points().fold(Vec3::INFINITY, Vec3::min);
            return Self { min, max: points().fold(Vec3::NEG_INFINITY, Vec3::max), ..point };
        }
        match shape {
            ConvexShape::Ball(_) => point,
            ConvexShape::HalfSpace(_) => Self { is_infinite: true, ..point },
            ConvexShape::Cuboid(cuboid) => {
                let max = cuboid.half_extents;
                Self { min: -max, max, ..point }
            }
            ConvexShape::Features { map, .. } => {
                let end = |axis: Vector| map.local_support_point(axis);
                Self {
                    min: Vec3::new(end(-Vec3::X).x, end(-Vec3::Y).y, end(-Vec3::Z).z),
                    max: Vec3::new(end(Vec3::X).x, end(Vec3::Y).y, end(Vec3::Z).z),
                    ..point
                }
            }
        }
    }

    /// Returns the largest absolute coordinate, with the radius; 0 for a half-space. Rounding is
    /// relative to it.
    pub(super) fn size(&self) -> Real {
        self.core_size() + self.radius
    }

    /// Returns the largest absolute coordinate without the radius.
    fn core_size(&self) -> Real {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Returns a ball around the shape; an infinite one for a half-space.
    pub(super) fn ball(&self) -> Sphere {
        let Sphere { centre, radius } = ball_around(self.min, self.max);
        let radius = (radius + self.radius) * (1.0 + gamma(8));
        Sphere { centre, radius: if self.is_infinite { Real::INFINITY } else { radius } }
    }

    /// Returns the box around the shape without its radius, and `reach`, grown by the rounding of
    /// Parry's support points. The reach of a half-space is infinite.
    #[inline(always)]
    pub(super) fn widest(&self, reach: f64) -> (DVec3, DVec3, f64) {
        let missed = if self.is_infinite { f64::INFINITY } else { gamma(16).into() };
        let reach = reach + missed * f64::from(self.core_size().max(f32::MIN_POSITIVE));
        (self.min.as_dvec3(), self.max.as_dvec3(), reach)
    }

    /// Returns an upper bound of the shape's largest coordinate along a direction of any length.
    ///
    /// Parry's support points are found in f32: they are off, or not the best, by a few roundings
    /// of the largest coordinate.
    pub(super) fn height_along(&self, shape: ConvexShape<'_>, direction: DVec3) -> f64 {
        match shape {
            ConvexShape::Ball(ball) => f64::from(ball.radius) * direction.length(),
            ConvexShape::HalfSpace(half_space) => {
                let is_normal = direction == half_space.normal.as_dvec3();
                if is_normal { 0.0 } else { f64::INFINITY }
            }
            ConvexShape::Cuboid(cuboid) => direction.abs().dot(cuboid.half_extents.as_dvec3()),
            ConvexShape::Features { map, radius, .. } => {
                let point = map.local_support_point(direction.as_vec3()).as_dvec3();
                let rounding = gamma(16) * self.core_size();
                direction.dot(point)
                    + f64::from(rounding) * direction.abs().element_sum()
                    + f64::from(radius) * direction.length()
            }
        }
    }
}

/// Points of a convex polyhedron, read when first used.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptHull {
    points: OnceLock<HullPoints>,
    /// True if depths are found by faces. Faces take as long as the depths of some fifty triangles.
    has_faces: bool,
}

impl KeptHull {
    /// Keeps a hull for many queries.
    pub(super) fn with_faces() -> Self {
        Self { has_faces: true, ..Self::default() }
    }

    pub(super) fn of(&self, shape: &ConvexPolyhedron) -> &HullPoints {
        self.points.get_or_init(|| {
            if self.has_faces {
                let (points, triangles) = shape.to_trimesh();
                HullPoints::with_faces(points, triangles)
            } else {
                HullPoints::without_faces(shape.points().iter().copied())
            }
        })
    }
}
