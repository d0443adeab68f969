//! A triangle and a cylinder or a cone.
//!
//! Apart: the distance of a point from the body is a convex function, so a golden section search
//! finds its least value over the triangle.
//!
//! Crossing: the least translation is perpendicular to the triangle, to one of its edges, or to the
//! surface of the body beside a corner. Edges leave a circle of directions, which is sampled and
//! then searched.

use super::polytope::ConvexTruth;
use glamx::DVec3;
use std::f64::consts::TAU;

/// A body closer than this share of the size of the pair crosses.
const TOUCHING: f64 = 1.0e-9;
/// Depths that differ by less than this share of the size are equal.
const TIE: f64 = 1.0e-7;
/// Rounds of a golden section search: they shrink an interval to 4e-10.
const ROUNDS: usize = 45;
/// Directions that a circle begins with.
const SAMPLES: usize = 240;

/// A body around the y axis; the tip of a cone is at `half_height`.
#[derive(Clone, Debug)]
pub(super) struct Curved {
    pub half_height: f64,
    pub radius: f64,
    pub is_cone: bool,
}

impl Curved {
    pub fn size(&self) -> f64 {
        self.half_height + self.radius
    }

    pub fn outside(&self, point: DVec3) -> f64 {
        (point - self.nearest(point)).length()
    }

    /// The point of the body nearest to a point; that itself if it is inside.
    fn nearest(&self, point: DVec3) -> DVec3 {
        let across = point.x.hypot(point.z);
        let [x, z] = if across > 0.0 { [point.x / across, point.z / across] } else { [1.0, 0.0] };
        let at = |out: f64, y: f64| DVec3::new(x * out, y, z * out);
        let Self { half_height: h, radius: r, is_cone } = *self;
        if !is_cone || point.y < -h {
            return at(across.min(r), point.y.clamp(-h, h));
        }
        // In a half plane, the cone is a right triangle: base, axis and slope.
        let (slope, from_tip) = ([r, -2.0 * h], [across, point.y - h]);
        if across * 2.0 * h + (point.y - h) * r <= 0.0 {
            return point;
        }
        let squared = r * r + 4.0 * h * h;
        let along = (from_tip[0] * slope[0] + from_tip[1] * slope[1]) / squared;
        let along = if along.is_nan() { 0.0 } else { along.clamp(0.0, 1.0) };
        at(along * slope[0], h + along * slope[1])
    }

    /// Height of the support point along a unit vector.
    fn reach(&self, u: DVec3) -> f64 {
        let (along, level) = (self.half_height * u.y, self.radius * u.x.hypot(u.z));
        if self.is_cone { along.max(level - along) } else { along.abs() + level }
    }

    /// The directions across the surface beside a point inside.
    fn surface_normals(&self, point: DVec3) -> [DVec3; 3] {
        let level = DVec3::new(point.x, 0.0, point.z).try_normalize().unwrap_or(DVec3::X);
        let slope = level * 2.0 * self.half_height + DVec3::Y * self.radius;
        let beside = if self.is_cone { slope.try_normalize().unwrap_or(level) } else { level };
        [beside, DVec3::Y, -DVec3::Y]
    }

    pub fn contact(&self, triangle: &[DVec3; 3]) -> ConvexTruth {
        let [a, b, c] = *triangle;
        let at = |s: f64, t: f64| a.lerp(b, s).lerp(a.lerp(c, s), t);
        let (s, distance) = least(0.0, 1.0, |s| least(0.0, 1.0, |t| self.outside(at(s, t))).1);
        let size = self.size() + (b - a).length().max((c - a).length());
        if distance > TOUCHING * size {
            let (t, _) = least(0.0, 1.0, |t| self.outside(at(s, t)));
            let way = self.nearest(at(s, t)) - at(s, t);
            return ConvexTruth { distance, normals: vec![way / way.length()] };
        }
        self.crossing(triangle, TIE * size)
    }

    fn crossing(&self, triangle: &[DVec3; 3], tie: f64) -> ConvexTruth {
        let [a, b, c] = *triangle;
        // Gap between body and triangle along a direction from the body.
        let gap = |u: DVec3| {
            triangle.iter().map(|x| x.dot(u)).fold(f64::INFINITY, f64::min) - self.reach(u)
        };
        let mut found = Vec::new();
        let mut take = |u: DVec3| found.push((gap(u), u));
        if let Some(face) = (b - a).cross(c - a).try_normalize() {
            take(face);
            take(-face);
        }
        triangle
            .iter()
            .for_each(|corner| self.surface_normals(*corner).into_iter().for_each(&mut take));
        for edge in [b - a, c - b, a - c] {
            let Some(along) = edge.try_normalize() else { continue };
            let one = along.any_orthonormal_vector();
            let other = along.cross(one);
            let at = |angle: f64| one * angle.cos() + other * angle.sin();
            let step = TAU / SAMPLES as f64;
            let gaps: Vec<f64> = (0..SAMPLES).map(|i| gap(at(step * i as f64))).collect();
            for i in 0..SAMPLES {
                let [before, after] = [i + SAMPLES - 1, i + 1].map(|j| gaps[j % SAMPLES]);
                if gaps[i] >= before && gaps[i] >= after {
                    let (low, high) = (step * (i as f64 - 1.0), step * (i as f64 + 1.0));
                    take(at(least(low, high, |angle| -gap(at(angle))).0));
                }
            }
        }
        let widest = found.iter().map(|(gap, _)| *gap).fold(f64::NEG_INFINITY, f64::max);
        let is_least = |&(gap, u): &(f64, DVec3)| (gap >= widest - tie).then_some(-u);
        ConvexTruth { distance: widest, normals: found.iter().filter_map(is_least).collect() }
    }
}

/// Minimum of a function with one minimum between two numbers, by golden section: place and value.
fn least(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> (f64, f64) {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let ends = [low, high].map(|at| (at, function(at)));
    let mut at = [high - RATIO * (high - low), low + RATIO * (high - low)];
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
    let all = [ends[0], ends[1], (at[0], values[0]), (at[1], values[1])];
    all.into_iter().min_by(|x, y| x.1.total_cmp(&y.1)).expect("there are four")
}
