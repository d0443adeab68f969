//! A triangle and the hull of a few points, by enumeration.
//!
//! Apart: the least distance of all pairs of features. Crossing: the least overlap over all
//! directions that can be a face normal of the Minkowski difference.

use glamx::DVec3;
use std::collections::BTreeSet;

/// The hull of points, its edges and faces, and some that are in its faces or have no extent.
#[derive(Clone, Debug)]
pub struct Polytope {
    points: Vec<DVec3>,
    edges: Vec<[DVec3; 2]>,
    faces: Vec<[DVec3; 3]>,
}

impl Polytope {
    pub fn new(points: Vec<DVec3>) -> Self {
        let size = points.iter().map(|p| (*p - points[0]).length()).fold(0.0, f64::max);
        let mut faces = Vec::new();
        let mut pairs = BTreeSet::new();
        for (i, &p) in points.iter().enumerate() {
            for (j, &q) in points.iter().enumerate().skip(i + 1) {
                for (k, &r) in points.iter().enumerate().skip(j + 1) {
                    let normal = (q - p).cross(r - p);
                    let rounding = size * (1.0e-9 * normal.length() + 1.0e-15 * size * size);
                    let rises = |x: &DVec3| (*x - p).dot(normal);
                    let is_inside = points.iter().any(|x| rises(x) > rounding)
                        && points.iter().any(|x| rises(x) < -rounding);
                    if !is_inside {
                        faces.push([p, q, r]);
                        pairs.extend([[i, j], [i, k], [j, k]]);
                    }
                }
                if points.len() == 2 {
                    pairs.insert([i, j]);
                }
            }
        }
        let edges = pairs.into_iter().map(|pair| pair.map(|i| points[i])).collect();
        Self { points, edges, faces }
    }

    pub fn distance(&self, triangle: &[DVec3; 3]) -> f64 {
        let separation = self.separation(triangle);
        if separation <= 0.0 { separation } else { self.apart(triangle).max(separation) }
    }

    fn apart(&self, triangle: &[DVec3; 3]) -> f64 {
        let edges = edges(triangle);
        let of_points = self.points.iter().map(|&p| to_triangle(triangle, p));
        let of_edges =
            self.edges.iter().flat_map(|&own| edges.map(|edge| between_segments(own, edge)));
        let of_faces = self.faces.iter().flat_map(|face| triangle.map(|c| to_triangle(face, c)));
        of_points.chain(of_edges).chain(of_faces).fold(f64::INFINITY, f64::min)
    }

    /// The widest gap of all axes that can be that of a face of the Minkowski difference, flat ones
    /// included.
    fn separation(&self, triangle: &[DVec3; 3]) -> f64 {
        let points = &self.points;
        let corner = triangle[0];
        let sides = edges(triangle).map(|[a, b]| b - a);
        let face = sides[0].cross(sides[1]);
        let scale = sides.iter().chain(points).map(|v| v.abs().max_element()).fold(0.0, f64::max);
        let mut widest: Option<f64> = None;
        let mut test = |axis: DVec3, lengths: f64| {
            // What is nearly no cross product is no axis.
            if axis.length() <= 1.0e-9 * lengths {
                return;
            }
            let axis = axis.normalize();
            let shadow = |all: &[DVec3]| {
                let heights = all.iter().map(|p| (*p - corner).dot(axis));
                heights.fold([f64::INFINITY, -f64::INFINITY], |[l, h], x| [l.min(x), h.max(x)])
            };
            let ([low1, high1], [low2, high2]) = (shadow(triangle), shadow(points));
            let gap = (low1 - high2).max(low2 - high1);
            widest = Some(widest.map_or(gap, |widest| widest.max(gap)));
        };
        let mut cross = |u: DVec3, v: DVec3| test(u.cross(v), u.length() * v.length());
        cross(sides[0], sides[1]);
        for &[p, q] in &self.edges {
            sides.iter().for_each(|&side| cross(side, q - p));
            cross(q - p, face);
        }
        for own in &self.faces {
            let edges = edges(own).map(|[a, b]| b - a);
            let normal = edges[0].cross(edges[1]);
            cross(edges[0], edges[1]);
            sides.iter().chain(&edges).for_each(|&edge| cross(edge, normal));
        }
        sides.iter().for_each(|&side| cross(side, face));
        // Segments and points: along and across them, and between them.
        let between = points[0] - corner;
        for along in sides.into_iter().chain([points[points.len() - 1] - points[0]]) {
            cross(along, DVec3::ZERO);
            let normal = along.cross(between);
            if normal.length() > 1.0e-12 * scale * scale {
                cross(along, normal);
                cross(along.cross(normal), normal);
            }
        }
        test(between, scale.max(f64::MIN_POSITIVE));
        widest.unwrap_or(0.0)
    }
}

fn edges([a, b, c]: &[DVec3; 3]) -> [[DVec3; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

fn to_segment([a, b]: [DVec3; 2], point: DVec3) -> f64 {
    let edge = b - a;
    let along = (point - a).dot(edge) / edge.length_squared();
    let nearest = if along.is_nan() { a } else { a + edge * along.clamp(0.0, 1.0) };
    (nearest - point).length()
}

/// Distance of a point, in coordinates along the longest edge and across.
fn to_triangle(triangle: &[DVec3; 3], point: DVec3) -> f64 {
    let length = |i: usize| (triangle[(i + 1) % 3] - triangle[i]).length_squared();
    let longest = if length(0) >= length(1).max(length(2)) {
        0
    } else {
        1 + usize::from(length(2) > length(1))
    };
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(longest + i) % 3]);
    let (u, v, p) = (b - a, c - a, point - a);
    let across = v - u * (v.dot(u) / u.dot(u));
    let t = p.dot(across) / across.dot(across);
    let s = (p - v * t).dot(u) / u.dot(u);
    let border = edges(triangle).map(|edge| to_segment(edge, point));
    let is_over = across.length() > 1.0e-9 * u.length() && s >= 0.0 && t >= 0.0 && s + t <= 1.0;
    let face = if is_over { (a + u * s + v * t - point).length() } else { f64::INFINITY };
    border.into_iter().fold(face, f64::min)
}

fn between_segments([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, c - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    let s = (vv * w.dot(u) - uv * w.dot(v)) / det;
    let ends = [a, b].map(|p| to_segment([c, d], p)).into_iter();
    let ends = ends.chain([c, d].map(|p| to_segment([a, b], p))).fold(f64::INFINITY, f64::min);
    // The second point by projection: near parallel lines, rounding moves both along them.
    if det > 0.0 { ends.min(to_segment([c, d], a + u * s.clamp(0.0, 1.0))) } else { ends }
}
