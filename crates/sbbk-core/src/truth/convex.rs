//! A triangle and a convex body: polytopes by enumeration, cylinders and cones by search.
//!
//! The distance of a point from a cylinder or a cone is a closed form. It is a convex function, so
//! a golden section search finds its minimum over the triangle.

use super::polytope::Polytope;
use glamx::DVec3;

/// A core closer than this share of the size of the pair crosses.
const TOUCHING: f64 = 1.0e-9;
/// Rounds of a golden section search: they shrink an interval to 4e-10.
const ROUNDS: usize = 45;

/// A convex body in its own frame: all that is within a radius of its core.
#[derive(Clone, Debug)]
pub struct ConvexBody {
    core: Core,
    radius: f64,
}

#[derive(Clone, Debug)]
enum Core {
    Polytope(Polytope),
    Cylinder { half_height: f64, radius: f64 },
    Cone { half_height: f64, radius: f64 },
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
        Core::Cylinder { half_height, radius }.sharp()
    }

    /// A cone around the y axis, its tip at `half_height`.
    pub fn cone(half_height: f64, radius: f64) -> Self {
        Core::Cone { half_height, radius }.sharp()
    }

    /// All below the plane through the origin with this unit normal.
    pub fn half_space(normal: DVec3) -> Self {
        Core::HalfSpace { normal }.sharp()
    }

    /// With a border of this radius in place of the one it has.
    pub fn rounded(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// The distance of a triangle, which may be a segment or a point, to 1e-9 of the size of the
    /// pair; minus the least translation that parts them when they cross. None when a cylinder or
    /// cone, without its border, crosses the triangle: how deep is not known here.
    pub fn distance(&self, triangle: &[DVec3; 3]) -> Option<f64> {
        let [a, b, c] = *triangle;
        let core = match &self.core {
            Core::Polytope(polytope) => polytope.distance(triangle),
            Core::HalfSpace { normal } => {
                triangle.map(|corner| corner.dot(*normal)).into_iter().fold(f64::INFINITY, f64::min)
            }
            Core::Cylinder { half_height, radius } | Core::Cone { half_height, radius } => {
                let apart = least(|s| {
                    let (from, to) = (a.lerp(b, s), a.lerp(c, s));
                    least(|t| self.core.outside(from.lerp(to, t)))
                });
                let size = half_height + radius + (b - a).length().max((c - a).length());
                if apart <= TOUCHING * size {
                    return None;
                }
                apart
            }
        };
        Some(core - self.radius)
    }

    /// How far a point is outside; 0 inside.
    pub fn outside(&self, point: DVec3) -> f64 {
        (self.core.outside(point) - self.radius).max(0.0)
    }
}

impl Core {
    fn sharp(self) -> ConvexBody {
        ConvexBody { core: self, radius: 0.0 }
    }

    fn outside(&self, point: DVec3) -> f64 {
        let (across, y) = (point.x.hypot(point.z), point.y);
        match *self {
            Self::Polytope(ref polytope) => polytope.distance(&[point; 3]).max(0.0),
            Self::HalfSpace { normal } => point.dot(normal).max(0.0),
            Self::Cylinder { half_height, radius } => {
                (across - radius).max(0.0).hypot((y.abs() - half_height).max(0.0))
            }
            // In a half plane, the cone is a right triangle: base, axis and slope.
            Self::Cone { half_height: h, radius: r } if y < -h => {
                (across - r).max(0.0).hypot(y + h)
            }
            Self::Cone { half_height: h, radius: r } => {
                let slope = DVec3::new(r, -2.0 * h, 0.0);
                let from_tip = DVec3::new(across, y - h, 0.0);
                if across * 2.0 * h + (y - h) * r <= 0.0 {
                    return 0.0;
                }
                let along = (from_tip.dot(slope) / slope.length()).clamp(0.0, slope.length());
                (from_tip - slope.normalize() * along).length()
            }
        }
    }
}

/// Least value of a convex function on 0 to 1, by golden section.
fn least(function: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (0.0, 1.0);
    let mut at = [1.0 - RATIO, RATIO];
    let mut values = at.map(&function);
    for _ in 0..ROUNDS {
        if values[0] < values[1] {
            high = at[1];
            at = [high - RATIO * (high - low), at[0]];
            values = [function(at[0]), values[0]];
        } else {
            low = at[0];
            at = [at[1], low + RATIO * (high - low)];
            values = [values[1], function(at[1])];
        }
    }
    values[0].min(values[1]).min(function(0.0)).min(function(1.0))
}
