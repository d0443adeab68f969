//! Triangles with small whole coordinates, whose distance and depth are known exactly: squares of
//! both are fractions of whole numbers. On so coarse a grid most triangles touch, share vertices,
//! lie in one plane or have no area.

use super::check::check;
use crate::prelude::*;
use proptest::prelude::*;
use std::cmp::Ordering;

type Vector = [i64; 3];
type Triangle = [Vector; 3];

/// A non-negative fraction: numerator and positive denominator.
#[derive(Clone, Copy, Debug)]
struct Fraction(i64, i64);

impl Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.0 * other.1).cmp(&(other.0 * self.1))
    }

    fn sqrt(self) -> f64 {
        (self.0 as f64 / self.1 as f64).sqrt()
    }
}

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn edge(t: &Triangle, i: usize) -> Vector {
    sub(t[(i + 1) % 3], t[i])
}

fn normal(t: &Triangle) -> Vector {
    cross(edge(t, 0), edge(t, 1))
}

/// True if a point lies inside the prism over a triangle; `scaled` is `scale` times the point.
fn is_over(scaled: Vector, scale: i64, t: &Triangle) -> bool {
    let n = normal(t);
    (0..3).all(|i| {
        let from_vertex = sub(scaled, t[i].map(|x| x * scale));
        dot(cross(edge(t, i), from_vertex), n) * scale.signum() >= 0
    })
}

fn vertex_face(p: Vector, t: &Triangle) -> Option<Fraction> {
    let n = normal(t);
    let height = dot(n, sub(p, t[0]));
    (n != [0; 3] && is_over(p, 1, t)).then(|| Fraction(height * height, dot(n, n)))
}

fn vertex_edge(p: Vector, t: &Triangle, i: usize) -> Fraction {
    let (w, e) = (sub(p, t[i]), edge(t, i));
    let (along, length) = (dot(w, e), dot(e, e));
    if along <= 0 {
        Fraction(dot(w, w), 1)
    } else if along >= length {
        let end = sub(p, t[(i + 1) % 3]);
        Fraction(dot(end, end), 1)
    } else {
        Fraction(dot(w, w) * length - along * along, length)
    }
}

fn edge_edge(t1: &Triangle, i: usize, t2: &Triangle, j: usize) -> Option<Fraction> {
    let (e1, e2, w) = (edge(t1, i), edge(t2, j), sub(t2[j], t1[i]));
    let n = cross(e1, e2);
    let area = dot(n, n);
    let within = |along: i64| (0..=area).contains(&along);
    let meets = area > 0 && within(dot(cross(w, e2), n)) && within(dot(cross(w, e1), n));
    meets.then(|| Fraction(dot(w, n) * dot(w, n), area))
}

/// True if an edge of `t1` passes through `t2`, from one side to the other.
fn pierces(t1: &Triangle, t2: &Triangle) -> bool {
    let n = normal(t2);
    (0..3).any(|i| {
        let (a, b) = (t1[i], t1[(i + 1) % 3]);
        let [height_a, height_b] = [a, b].map(|p| dot(n, sub(p, t2[0])));
        let through: Vector = std::array::from_fn(|k| a[k] * height_b - b[k] * height_a);
        height_a * height_b < 0 && is_over(through, height_b - height_a, t2)
    })
}

fn distance_squared(t1: &Triangle, t2: &Triangle) -> Fraction {
    if pierces(t1, t2) || pierces(t2, t1) {
        return Fraction(0, 1);
    }
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let faces = (0..3).flat_map(|i| [vertex_face(t1[i], t2), vertex_face(t2[i], t1)]).flatten();
    let edges = pairs().filter_map(|(i, j)| edge_edge(t1, i, t2, j));
    let vertices =
        pairs().flat_map(|(i, j)| [vertex_edge(t1[i], t2, j), vertex_edge(t2[i], t1, j)]);
    faces.chain(edges).chain(vertices).min_by(Fraction::cmp).expect("18 at least")
}

fn depth_squared(t1: &Triangle, t2: &Triangle) -> Fraction {
    let products = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let products = products.map(|(i, j)| cross(edge(t1, i), edge(t2, j)));
    let overlap = |n: Vector| {
        let [s1, s2] = [t1, t2].map(|t| t.map(|v| dot(n, v)));
        let max = |s: [i64; 3]| s.into_iter().max().unwrap();
        let min = |s: [i64; 3]| s.into_iter().min().unwrap();
        let least = (max(s1) - min(s2)).min(max(s2) - min(s1));
        Fraction(least * least, dot(n, n))
    };
    let axes = products.chain([normal(t1), normal(t2)]).filter(|&n| n != [0; 3]);
    axes.map(overlap).min_by(Fraction::cmp).unwrap_or(Fraction(0, 1))
}

fn triangle() -> impl Strategy<Value = Triangle> {
    prop::array::uniform3(prop::array::uniform3(-3_i64..=3))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn contacts_of_whole_coordinates_are_exact(t1 in triangle(), t2 in triangle()) {
        let [f1, f2] = [t1, t2].map(|t| t.map(|v| DVec3::from_array(v.map(|x| x as f64))));
        let found = check(&f1, &f2);
        let apart = distance_squared(&t1, &t2);
        let exact = if apart.0 > 0 { apart.sqrt() } else { -depth_squared(&t1, &t2).sqrt() };
        prop_assert!((found.distance - exact).abs() < 1.0e-12, "{found:?}, exactly {exact}");
    }
}
