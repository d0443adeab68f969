use glamx::Vec3;

use super::rounding::gamma;

/// A sphere, filled.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub centre: Vec3,
    /// The radius; negative if the sphere is empty.
    pub radius: f32,
}

/// Number of steps towards the farthest point, each a pass over the points. Higher: a slightly
/// smaller radius; lower: a faster build.
const REFINEMENTS: usize = 4;

/// Bound on the error of a distance whose squares underflow: the root of a few times 2⁻¹⁴⁹.
const UNDERFLOW: f32 = 1e-22;

impl Sphere {
    /// A near-minimal sphere around `points`; an empty one if there are no points. Linear in
    /// the number of points.
    ///
    /// Starts from the widest of 7 diameters (Larsson, *Fast and Tight Fitting Bounding Spheres*,
    /// 2008). Then moves the centre towards the farthest point by a shrinking step (Bădoiu and
    /// Clarkson, *Smaller Core-Sets for Balls*, 2003) and keeps the best sphere.
    pub fn fit(points: &[Vec3]) -> Self {
        let Some(&first) = points.first() else {
            return Self { centre: Vec3::ZERO, radius: -1.0 };
        };
        let mut ends = [(first, first); 7];
        let (mut low, mut high) = ([f32::INFINITY; 7], [f32::NEG_INFINITY; 7]);
        for &point in points {
            let projections = diameters(point);
            for (axis, &projection) in projections.iter().enumerate() {
                if projection < low[axis] {
                    (low[axis], ends[axis].0) = (projection, point);
                }
                if projection > high[axis] {
                    (high[axis], ends[axis].1) = (projection, point);
                }
            }
        }
        let length = |ends: &(Vec3, Vec3)| ends.0.distance_squared(ends.1);
        let widest = ends.iter().copied().max_by(|a, b| length(a).total_cmp(&length(b)));
        let (p, q) = widest.unwrap_or((first, first));

        let mut sphere = Self { centre: 0.5 * p + 0.5 * q, radius: 0.5 * p.distance(q) };
        for (p, q) in ends {
            for point in [p, q] {
                sphere = sphere.grown_to(point, sphere.centre.distance(point));
            }
        }
        let mut best = Self { radius: f32::INFINITY, ..sphere };
        for step in 0..=REFINEMENTS {
            let (point, distance) = sphere.farthest(points);
            if distance < best.radius {
                best = Self { radius: distance, ..sphere };
            }
            sphere.radius = 0.99 * best.radius * (1.0 - 0.1 / (step + 1) as f32);
            sphere = sphere.grown_to(point, distance);
        }
        Self { radius: best.radius * (1.0 + gamma(6)) + UNDERFLOW, ..best }
    }

    /// Returns true if `point` is in the sphere, computed in f64. Fitted points are.
    pub fn contains(&self, point: Vec3) -> bool {
        self.centre.as_dvec3().distance(point.as_dvec3()) <= f64::from(self.radius)
    }

    /// The farthest of `points` from the centre, and its distance.
    fn farthest(&self, points: &[Vec3]) -> (Vec3, f32) {
        let mut farthest = (self.centre, 0.0);
        for &point in points {
            let distance_squared = self.centre.distance_squared(point);
            if distance_squared > farthest.1 {
                farthest = (point, distance_squared);
            }
        }
        (farthest.0, farthest.1.sqrt())
    }

    /// The sphere grown just enough to touch `point`, which is `distance` away from its centre.
    fn grown_to(&self, point: Vec3, distance: f32) -> Self {
        if distance <= self.radius {
            return *self;
        }
        let radius = 0.5 * (self.radius + distance);
        let centre = self.centre + (point - self.centre) * ((distance - radius) / distance);
        Self { centre, radius }
    }
}

/// Projections on the faces and corners of a cube.
fn diameters(Vec3 { x, y, z }: Vec3) -> [f32; 7] {
    let [a, b] = [x + y, x - y];
    [x, y, z, a + z, a - z, b + z, b - z]
}
