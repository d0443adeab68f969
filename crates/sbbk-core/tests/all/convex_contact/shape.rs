//! Shapes of all kinds, random numbers, and triangles near shapes.

use crate::support::Random;
use glamx::{DQuat, DVec3, Vec3};
use sbbk_core::contact::convex::{
    ConeSupport, ConvexContact, CuboidSupport, CylinderSupport, HullPoints, PointSupport,
    SegmentSupport, SupportMap, TriangleSupport, convex_contact,
};
use sbbk_truth::ConvexBody;

#[derive(Clone, Debug)]
pub enum Core {
    Point(DVec3),
    Segment([DVec3; 2]),
    Triangle([DVec3; 3]),
    Cuboid(DVec3),
    Hull(Vec<DVec3>),
    Cylinder(CylinderSupport),
    Cone(ConeSupport),
}

#[derive(Clone, Debug)]
pub struct Shape {
    pub core: Core,
    pub radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Ball,
    Segment,
    Capsule,
    Triangle,
    Cuboid,
    RoundCuboid,
    Hull,
    FlatHull,
    Cylinder,
    RoundCylinder,
    Cone,
}

impl Kind {
    pub const POLYTOPES: [Self; 8] = [
        Self::Ball,
        Self::Segment,
        Self::Capsule,
        Self::Triangle,
        Self::Cuboid,
        Self::RoundCuboid,
        Self::Hull,
        Self::FlatHull,
    ];
    pub const CURVED: [Self; 3] = [Self::Cylinder, Self::RoundCylinder, Self::Cone];
}

impl Shape {
    pub fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
        // The core may be a rounding farther than the sum.
        let reach = (margin + self.radius) * (1.0 + 1.0e-15);
        let ConvexContact { distance, normal, on_triangle, .. } = match &self.core {
            Core::Point(p) => convex_contact(triangle, &PointSupport(*p), reach),
            Core::Segment(ends) => convex_contact(triangle, &SegmentSupport(*ends), reach),
            Core::Triangle(t) => convex_contact(triangle, &TriangleSupport(*t), reach),
            Core::Cuboid(half) => convex_contact(triangle, &CuboidSupport(*half), reach),
            Core::Hull(points) => match in_f32(points) {
                Some(points) => convex_contact(triangle, &HullPoints::new(points), reach),
                None => convex_contact(triangle, &|d| first_farthest(points, d), reach),
            },
            Core::Cylinder(cylinder) => convex_contact(triangle, cylinder, reach),
            Core::Cone(cone) => convex_contact(triangle, cone, reach),
        }?;
        let distance = distance - self.radius;
        let on_shape = on_triangle + normal * distance;
        (distance <= margin).then_some(ConvexContact { distance, normal, on_triangle, on_shape })
    }

    /// Farthest point of the core along a direction.
    pub fn support(&self, direction: DVec3) -> DVec3 {
        match &self.core {
            Core::Cylinder(cylinder) => cylinder.support(direction),
            Core::Cone(cone) => cone.support(direction),
            _ => {
                let along = |a: &DVec3, b: &DVec3| a.dot(direction).total_cmp(&b.dot(direction));
                self.vertices().into_iter().max_by(along).unwrap()
            }
        }
    }

    /// Vertices of the core of a polytope.
    pub fn vertices(&self) -> Vec<DVec3> {
        match &self.core {
            Core::Point(p) => vec![*p],
            Core::Segment(ends) => ends.to_vec(),
            Core::Triangle(t) => t.to_vec(),
            Core::Cuboid(half) => (0..8)
                .map(|i| {
                    let sign = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
                    *half * DVec3::new(sign(0), sign(1), sign(2))
                })
                .collect(),
            Core::Hull(points) => points.clone(),
            Core::Cylinder(_) | Core::Cone(_) => unreachable!("no polytope"),
        }
    }

    /// The shape for brute force.
    pub fn truth(&self) -> ConvexBody {
        let core = match &self.core {
            Core::Cylinder(c) => ConvexBody::cylinder(c.half_height, c.radius),
            Core::Cone(c) => ConvexBody::cone(c.half_height, c.radius),
            _ => ConvexBody::hull(self.vertices()),
        };
        core.rounded(self.radius)
    }

    pub fn scaled(&self, factor: f64) -> Self {
        let core = match &self.core {
            Core::Point(p) => Core::Point(*p * factor),
            Core::Segment(ends) => Core::Segment(ends.map(|p| p * factor)),
            Core::Triangle(t) => Core::Triangle(t.map(|p| p * factor)),
            Core::Cuboid(half) => Core::Cuboid(*half * factor),
            Core::Hull(points) => Core::Hull(points.iter().map(|&p| p * factor).collect()),
            Core::Cylinder(c) => Core::Cylinder(CylinderSupport {
                half_height: c.half_height * factor,
                radius: c.radius * factor,
            }),
            Core::Cone(c) => Core::Cone(ConeSupport {
                half_height: c.half_height * factor,
                radius: c.radius * factor,
            }),
        };
        Self { core, radius: self.radius * factor }
    }
}

/// The first of the points that are farthest along a direction.
pub fn first_farthest(points: &[DVec3], direction: DVec3) -> DVec3 {
    let farther = |a: DVec3, b: DVec3| if b.dot(direction) > a.dot(direction) { b } else { a };
    points.iter().copied().reduce(farther).unwrap_or_default()
}

/// To the nearest numbers in f32.
pub fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

/// Points in f32, if they are in f32 exactly.
fn in_f32(points: &[DVec3]) -> Option<Vec<Vec3>> {
    let is_exact = points.iter().all(|&point| rounded(point) == point);
    is_exact.then(|| points.iter().map(|point| point.as_vec3()).collect())
}

impl Random {
    /// A shape of size about 1.
    pub fn shape(&mut self, kind: Kind) -> Shape {
        let radius = self.scale(0.01, 1.0);
        let sharp = |core| Shape { core, radius: 0.0 };
        let round = |core| Shape { core, radius };
        let half = DVec3::from_array([0; 3].map(|_| self.scale(0.05, 1.0)));
        let (half_height, half_width) = (half.x, half.y);
        let turn = DQuat::from_scaled_axis(self.point() * 3.0);
        match kind {
            Kind::Ball => round(Core::Point(DVec3::ZERO)),
            Kind::Segment => sharp(Core::Segment([self.point(), self.point()])),
            Kind::Capsule => round(Core::Segment([DVec3::Y * half.x, DVec3::Y * -half.x])),
            Kind::Triangle => sharp(Core::Triangle([0; 3].map(|_| self.point()))),
            Kind::Cuboid => sharp(Core::Cuboid(half)),
            Kind::RoundCuboid => round(Core::Cuboid(half)),
            Kind::Hull => {
                let count = 4 + self.below(6);
                sharp(Core::Hull((0..count).map(|_| rounded(half * self.direction())).collect()))
            }
            Kind::FlatHull => {
                let count = 4 + self.below(4);
                let flat = |p: DVec3| turn * DVec3::new(p.x, p.y, 0.0);
                sharp(Core::Hull((0..count).map(|_| flat(self.point())).collect()))
            }
            Kind::Cylinder => {
                sharp(Core::Cylinder(CylinderSupport { half_height, radius: half_width }))
            }
            Kind::RoundCylinder => {
                round(Core::Cylinder(CylinderSupport { half_height, radius: half_width }))
            }
            Kind::Cone => sharp(Core::Cone(ConeSupport { half_height, radius: half_width })),
        }
    }

    /// A shape, a triangle beside it and a margin: near, within the margin, touching or deep.
    pub fn case(&mut self, kind: Kind, i: u32) -> (Shape, [DVec3; 3], f64) {
        let shape = self.shape(kind);
        let margin = self.scale(1.0e-4, 0.1);
        let gap = match i % 4 {
            0 => self.within(0.0, 2.0 * margin),
            1 => self.within(-margin, margin),
            2 => 0.0,
            _ => self.within(-1.0, 0.0),
        };
        let triangle = self.triangle_beside(&shape, gap);
        (shape, triangle, margin)
    }

    /// A triangle of any proportions beside a shape: `gap` is how far it is along some direction,
    /// and more than the least translation if negative.
    pub fn triangle_beside(&mut self, shape: &Shape, gap: f64) -> [DVec3; 3] {
        let size = self.scale(0.02, 20.0);
        let mut corners = [0; 3].map(|_| self.point() * size);
        let outward = match self.below(4) {
            0 => [DVec3::X, DVec3::Y, DVec3::Z][self.below(3) as usize],
            1 => -DVec3::Y,
            _ => self.direction(),
        };
        match self.below(4) {
            // Face on.
            0 => corners = corners.map(|c| c - outward * c.dot(outward)),
            // Edge on.
            1 => corners[1] = corners[0] + (corners[1] - corners[0]).reject_from(outward),
            // A needle.
            2 => corners[2] = corners[0].lerp(corners[1], 0.4) + 1.0e-4 * size * self.point(),
            _ => {}
        }
        // The lowest corner, or a point between the lowest ones, meets the shape.
        let [u, v] = [self.within(0.0, 1.0), self.within(0.0, 1.0)];
        let middle = corners[0]
            + (corners[1] - corners[0]) * u.min(v)
            + (corners[2] - corners[0]) * (1.0 - u.max(v));
        let lowest =
            corners.into_iter().min_by(|a, b| a.dot(outward).total_cmp(&b.dot(outward))).unwrap();
        let low = middle - outward * (middle - lowest).dot(outward);
        let to = shape.support(outward) + outward * (shape.radius + gap);
        corners.map(|c| c + (to - low))
    }
}
