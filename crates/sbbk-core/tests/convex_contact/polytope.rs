//! Signed distance of the hull of a few points and a triangle: all pairs of features, all axes.

use glamx::DVec3;

/// The point of a segment nearest to a point.
fn nearest_of_segment([a, b]: [DVec3; 2], point: DVec3) -> DVec3 {
    let edge = b - a;
    let along = (point - a).dot(edge) / edge.length_squared();
    if along.is_nan() { a } else { a + edge * along.clamp(0.0, 1.0) }
}

/// The point of a triangle nearest to a point, in coordinates along its longest edge and across.
pub fn nearest_of_triangle(triangle: &[DVec3; 3], point: DVec3) -> DVec3 {
    let edge = |i: usize| triangle[(i + 1) % 3] - triangle[i];
    let longer = |&i: &usize, &j: &usize| edge(i).length().total_cmp(&edge(j).length());
    let longest = (0..3).max_by(longer).unwrap();
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(longest + i) % 3]);
    let (u, v, p) = (b - a, c - a, point - a);
    let across = v - u * (v.dot(u) / u.dot(u));
    let t = p.dot(across) / across.dot(across);
    let s = (p - v * t).dot(u) / u.dot(u);
    let mut all = [[a, b], [b, c], [c, a]].map(|edge| nearest_of_segment(edge, point)).to_vec();
    if across.length() > 1.0e-9 * u.length() && s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
        all.push(a + u * s + v * t);
    }
    let far = |q: &DVec3| (*q - point).length_squared();
    all.into_iter().min_by(|p, q| far(p).total_cmp(&far(q))).unwrap()
}

fn segments([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, c - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    let s = (vv * w.dot(u) - uv * w.dot(v)) / det;
    let mut least = [a, b]
        .map(|p| (nearest_of_segment([c, d], p) - p).length())
        .into_iter()
        .chain([c, d].map(|p| (nearest_of_segment([a, b], p) - p).length()))
        .fold(f64::INFINITY, f64::min);
    // The second point by projection: near parallel lines, rounding moves both along them.
    if det > 0.0 {
        let p = a + u * s.clamp(0.0, 1.0);
        least = least.min((nearest_of_segment([c, d], p) - p).length());
    }
    least
}

/// Distance of the hull of some points and a triangle; if they cross, minus the least translation.
pub fn distance(points: &[DVec3], triangle: &[DVec3; 3]) -> f64 {
    let separation = separation(points, triangle);
    if separation <= 0.0 { separation } else { apart(points, triangle).max(separation) }
}

fn apart(points: &[DVec3], triangle: &[DVec3; 3]) -> f64 {
    let edges = [0, 1, 2].map(|i| [triangle[i], triangle[(i + 1) % 3]]);
    let mut least = f64::INFINITY;
    for (i, &p) in points.iter().enumerate() {
        least = least.min((nearest_of_triangle(triangle, p) - p).length());
        for (j, &q) in points.iter().enumerate().skip(i + 1) {
            least = edges.iter().map(|&edge| segments([p, q], edge)).fold(least, f64::min);
            for &r in &points[j + 1..] {
                let below = |c: &DVec3| (nearest_of_triangle(&[p, q, r], *c) - *c).length();
                least = triangle.iter().map(below).fold(least, f64::min);
            }
        }
    }
    least
}

/// The widest gap of all axes that can be that of a face of the Minkowski difference, flat ones
/// included.
fn separation(points: &[DVec3], triangle: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *triangle;
    let edges = [b - a, c - b, a - c];
    let face = edges[0].cross(edges[1]);
    let scale = edges.iter().chain(points).map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let mut widest = f64::NEG_INFINITY;
    let mut count = 0;
    let mut test = |axis: DVec3, lengths: f64| {
        // What is nearly no cross product is no axis.
        if lengths == 0.0 || axis.length() <= 1.0e-9 * lengths {
            return;
        }
        let axis = axis.normalize();
        count += 1;
        let shadow = |all: &[DVec3]| {
            let heights = all.iter().map(|p| (*p - a).dot(axis));
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
        };
        let ([low1, high1], [low2, high2]) = (shadow(triangle), shadow(points));
        widest = widest.max(low1 - high2).max(low2 - high1);
    };
    let mut cross = |u: DVec3, v: DVec3| test(u.cross(v), u.length() * v.length());
    cross(edges[0], edges[1]);
    for (i, &p) in points.iter().enumerate() {
        for (j, &q) in points.iter().enumerate().skip(i + 1) {
            edges.iter().for_each(|&edge| cross(edge, q - p));
            cross(q - p, face);
            points[j + 1..].iter().for_each(|&r| cross(q - p, r - p));
            for &r in &points[j + 1..] {
                let normal = (q - p).cross(r - p);
                edges.iter().for_each(|&edge| cross(edge, normal));
                [q - p, r - q, p - r].into_iter().for_each(|edge| cross(edge, normal));
            }
        }
    }
    edges.iter().for_each(|&edge| cross(edge, face));
    // Segments and points: along and across them, and between them.
    let between = points[0] - a;
    for along in edges.into_iter().chain([points[points.len() - 1] - points[0]]) {
        cross(along, DVec3::ZERO);
        let normal = along.cross(between);
        if normal.length() > 1.0e-12 * scale * scale {
            cross(along, normal);
            cross(along.cross(normal), normal);
        }
    }
    test(between, scale.max(f64::MIN_POSITIVE));
    if count == 0 { 0.0 } else { widest }
}
