//! A triangle and the hull of a few points, by enumeration.
//!
//! Apart: the least distance of all pairs of features. Crossing: the least overlap over all
//! directions that can be a face normal of the Minkowski difference.

use glamx::DVec3;
use std::collections::BTreeSet;

/// Depths that differ by less than this share of the size are equal.
const TIE: f64 = 1.0e-9;

/// The contact of a triangle and a convex body.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexTruth {
    /// The distance, to 1e-9 of the size of the pair; minus the least translation that separates
    /// them if they cross.
    pub distance: f64,
    /// Directions from the triangle to the body: several if moves along several are least, empty if
    /// the cores touch.
    pub normals: Vec<DVec3>,
}

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

    /// The greatest distance from the first point.
    pub fn size(&self) -> f64 {
        self.points.iter().map(|p| (*p - self.points[0]).length()).fold(0.0, f64::max)
    }

    pub fn contact(&self, triangle: &[DVec3; 3]) -> ConvexTruth {
        let separation = self.separation(triangle, TIE);
        if separation.distance <= 0.0 {
            return separation;
        }
        let way = self.apart(triangle);
        let distance = way.length().max(separation.distance);
        ConvexTruth { distance, normals: way.try_normalize().into_iter().collect() }
    }

    /// The shortest way from the triangle to the hull.
    pub fn apart(&self, triangle: &[DVec3; 3]) -> DVec3 {
        let edges = edges(triangle);
        let of_points = self.points.iter().map(|&p| p - on_triangle(triangle, p));
        let of_edges =
            self.edges.iter().flat_map(|&own| edges.map(|edge| between_segments(edge, own)));
        let of_faces =
            self.faces.iter().flat_map(|face| triangle.map(|c| on_triangle(face, c) - c));
        shortest(of_points.chain(of_edges).chain(of_faces))
    }

    /// The widest gap among all axes of possible faces of the Minkowski difference, flat ones
    /// included. A badly computed axis only underestimates it. Normals of gaps
    /// within a share of the size of the widest follow the widest.
    pub fn separation(&self, triangle: &[DVec3; 3], tie: f64) -> ConvexTruth {
        let (points, corner) = (&self.points, triangle[0]);
        let sides = edges(triangle).map(|[a, b]| b - a);
        let scale = sides.iter().chain(points).map(|v| v.abs().max_element()).fold(0.0, f64::max);
        let tie = tie * scale;
        let mut widest = f64::NEG_INFINITY;
        let mut found: Vec<(f64, DVec3)> = Vec::new();
        self.for_each_axis(corner, &sides, scale, |axis: DVec3| {
            let shadow = |all: &[DVec3]| {
                let heights = all.iter().map(|p| (*p - corner).dot(axis));
                heights.fold([f64::INFINITY, -f64::INFINITY], |[l, h], x| [l.min(x), h.max(x)])
            };
            let ([low1, high1], [low2, high2]) = (shadow(triangle), shadow(points));
            for (gap, normal) in [(low2 - high1, axis), (low1 - high2, -axis)] {
                if gap >= widest - tie {
                    widest = widest.max(gap);
                    found.push((gap, normal));
                }
            }
        });
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let is_least = |&(gap, normal): &(f64, DVec3)| (gap >= widest - tie).then_some(normal);
        let normals = found.iter().filter_map(is_least).collect();
        ConvexTruth { distance: if found.is_empty() { 0.0 } else { widest }, normals }
    }

    /// Calls `test` with the normals of all possible faces of the Minkowski difference of the hull
    /// and a triangle.
    fn for_each_axis(
        &self,
        corner: DVec3,
        sides: &[DVec3; 3],
        scale: f64,
        mut test: impl FnMut(DVec3),
    ) {
        let points = &self.points;
        let face = sides[0].cross(sides[1]);
        let mut cross = |u: DVec3, v: DVec3| perpendicular(u, v).into_iter().for_each(&mut test);
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
        // Segments and points: across them, and between them.
        let between = points[0] - corner;
        let own =
            self.edges.iter().map(|[p, q]| q - p).chain([points[points.len() - 1] - points[0]]);
        for along in sides.iter().copied().chain(own) {
            let normal = along.cross(between);
            if normal.length() > 1.0e-12 * scale * scale {
                cross(along, normal);
                cross(along.cross(normal), normal);
            }
            cross(along, DVec3::new(0.3, -0.7, 0.2));
            cross(along, DVec3::new(0.6, 0.1, -0.5));
        }
        between.try_normalize().into_iter().for_each(test);
    }
}

/// The unit vector perpendicular to two directions, exactly so to the first. `None` if parallel.
fn perpendicular(u: DVec3, v: DVec3) -> Option<DVec3> {
    let (u, v) = (u.try_normalize()?, v.try_normalize()?);
    let mut normal = u.cross(v).try_normalize()?;
    for _ in 0..2 {
        normal = (normal - u * u.dot(normal)).try_normalize()?;
    }
    Some(normal)
}

fn edges([a, b, c]: &[DVec3; 3]) -> [[DVec3; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

fn shortest(ways: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let shorter = |x: DVec3, y: DVec3| if y.length() < x.length() { y } else { x };
    ways.into_iter().reduce(shorter).unwrap_or(DVec3::INFINITY)
}

/// The point of a segment nearest to a point.
fn on_segment([a, b]: [DVec3; 2], point: DVec3) -> DVec3 {
    let edge = b - a;
    let along = (point - a).dot(edge) / edge.length_squared();
    if along.is_nan() { a } else { a + edge * along.clamp(0.0, 1.0) }
}

/// The point of a triangle nearest to a point, in coordinates along the longest edge and across.
fn on_triangle(triangle: &[DVec3; 3], point: DVec3) -> DVec3 {
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
    let is_over = across.length() > 1.0e-9 * u.length() && s >= 0.0 && t >= 0.0 && s + t <= 1.0;
    let face = is_over.then(|| a + u * s + v * t - point);
    let border = edges(triangle).map(|edge| on_segment(edge, point) - point);
    point + shortest(border.into_iter().chain(face))
}

/// The shortest way from one segment to another.
fn between_segments([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> DVec3 {
    let (u, v, w) = (b - a, d - c, c - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    let s = (vv * w.dot(u) - uv * w.dot(v)) / det;
    let to_other = |p: DVec3| on_segment([c, d], p) - p;
    let ends = [c, d].map(|p| p - on_segment([a, b], p));
    let ends = shortest([a, b].map(to_other).into_iter().chain(ends));
    // The second point by projection: near parallel lines, rounding moves both along them.
    if det > 0.0 { shortest([ends, to_other(a + u * s.clamp(0.0, 1.0))]) } else { ends }
}
