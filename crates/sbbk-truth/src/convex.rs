//! A triangle and a convex body: polytopes by enumeration, cylinders and cones by search.

use super::curved::Curved;
use super::polytope::{ConvexTruth, Polytope};
use glamx::DVec3;

/// Cores closer than this share of the size of the pair have no normals: rounding moves them.
const NEAR: f64 = 1.0e-6;

/// A convex body in its own frame: all points within a radius of its core.
#[derive(Clone, Debug)]
pub struct ConvexBody {
    core: Core,
    radius: f64,
}

#[derive(Clone, Debug)]
enum Core {
    Polytope(Polytope),
    Curved(Curved),
    HalfSpace { normal: DVec3 },
}

impl ConvexBody {
    /// The convex hull of points, at least one; they may be in one plane or on one line. Looks at
    /// all triples of points, once.
    pub fn hull(points: impl Into<Vec<DVec3>>) -> Self {
        Core::Polytope(Polytope::new(points.into())).sharp()
    }

    /// A cylinder around the y axis.
    pub fn cylinder(half_height: f64, radius: f64) -> Self {
        Core::Curved(Curved { half_height, radius, is_cone: false }).sharp()
    }

    /// A cone around the y axis, its tip at `half_height`.
    pub fn cone(half_height: f64, radius: f64) -> Self {
        Core::Curved(Curved { half_height, radius, is_cone: true }).sharp()
    }

    /// All below the plane through the origin with this unit normal.
    pub fn half_space(normal: DVec3) -> Self {
        Core::HalfSpace { normal }.sharp()
    }

    /// Replaces the rounding radius.
    pub fn rounded(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// Returns the distance of a triangle, which may be a segment or a point, from the body.
    pub fn contact(&self, triangle: &[DVec3; 3]) -> ConvexTruth {
        let (mut truth, size) = match &self.core {
            Core::Polytope(polytope) => (polytope.contact(triangle), polytope.size()),
            Core::Curved(curved) => (curved.contact(triangle), curved.size()),
            Core::HalfSpace { normal } => {
                let heights = triangle.map(|corner| corner.dot(*normal));
                let distance = heights.into_iter().fold(f64::INFINITY, f64::min);
                (ConvexTruth { distance, normals: vec![-*normal] }, 0.0)
            }
        };
        let [a, b, c] = *triangle;
        let size = size + (b - a).length().max((c - a).length());
        if truth.distance.abs() <= NEAR * size && !matches!(self.core, Core::HalfSpace { .. }) {
            truth.normals.clear();
        }
        truth.distance -= self.radius;
        truth
    }

    /// The distance of a triangle, see [`contact`](Self::contact).
    pub fn distance(&self, triangle: &[DVec3; 3]) -> f64 {
        self.contact(triangle).distance
    }

    /// Distance of a point outside; 0 inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        let core = match &self.core {
            Core::Polytope(polytope) => polytope.contact(&[point; 3]).distance,
            Core::HalfSpace { normal } => point.dot(*normal),
            Core::Curved(curved) => curved.outside(point),
        };
        (core.max(0.0) - self.radius).max(0.0)
    }
}

impl Core {
    fn sharp(self) -> ConvexBody {
        ConvexBody { core: self, radius: 0.0 }
    }
}
