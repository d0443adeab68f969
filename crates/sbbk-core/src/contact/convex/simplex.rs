//! The point of a simplex that is nearest to the origin.
//!
//! Signed volumes and areas tell on which side of a face or edge the origin lies, as in M.
//! Montanari, N. Petrinic, E. Barbieri, "Improving the GJK algorithm for faster and more reliable
//! distance queries between convex objects", 2017. If rounding may have chosen a sign, all faces or
//! edges are tried. The nearest one counts, so a flat simplex is no special case.

use super::support::Vertex;
use glamx::DVec3;

/// Least width of a face, as a share of its length, at which its normal and areas need no care.
const THIN: f64 = 1.0e-3;

/// Least width, as a share of the length, at which a face is more than its edges.
const COLLINEAR: f64 = 1.0e-14;

/// Least sine between the two shortest edges of a face that has a normal.
const NO_NORMAL: f64 = 1.0e-11;

/// Least volume of a tetrahedron with edges of length one whose faces' sides are not in doubt.
const FLAT: f64 = 1.0e-12;

/// The vertices of the smallest part of a simplex that holds its nearest point.
#[derive(Clone, Copy)]
pub(super) struct Simplex {
    vertices: [Vertex; 3],
    /// Weight of each vertex in the nearest point; 0 beyond `len`.
    weights: [f64; 3],
    len: usize,
    /// The nearest point.
    pub nearest: DVec3,
    /// The square of its distance.
    pub squared: f64,
}

/// The result of adding a vertex to a simplex.
pub(super) enum Step {
    /// A simplex beside the origin.
    Beside(Simplex),
    /// A tetrahedron around it.
    Around([Vertex; 4]),
}

impl Simplex {
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices[..self.len]
    }

    /// The point of the triangle that belongs to the nearest point.
    #[inline(always)]
    pub fn on_triangle(&self, corners: &[DVec3; 3]) -> DVec3 {
        let corner = |i: usize| corners[self.vertices[i].corner] * self.weights[i];
        corner(0) + corner(1) + corner(2)
    }

    #[inline(always)]
    pub fn add(&self, new: Vertex) -> Step {
        let [b, c, d] = self.vertices;
        match self.len {
            1 => Step::Beside(segment(new, b)),
            2 => Step::Beside(side(new, b, c)),
            _ => tetrahedron(new, b, c, d),
        }
    }

    #[inline(always)]
    fn new(vertices: [Vertex; 3], weights: [f64; 3], len: usize, nearest: DVec3) -> Self {
        Self { vertices, weights, len, nearest, squared: nearest.length_squared() }
    }

    #[inline(always)]
    pub fn nearer(self, other: Self) -> Self {
        if other.squared < self.squared { other } else { self }
    }
}

#[inline(always)]
pub(super) fn vertex(a: Vertex) -> Simplex {
    Simplex::new([a; 3], [1.0, 0.0, 0.0], 1, a.point)
}

#[inline(always)]
pub(super) fn segment(a: Vertex, b: Vertex) -> Simplex {
    let edge = b.point - a.point;
    let along = -a.point.dot(edge);
    let length_squared = edge.length_squared();
    // False for a segment without length.
    let is_beyond_a = along > 0.0;
    if !is_beyond_a {
        return vertex(a);
    }
    if along >= length_squared {
        return vertex(b);
    }
    let weight = along / length_squared;
    Simplex::new([a, b, b], [1.0 - weight, weight, 0.0], 2, a.point + edge * weight)
}

#[inline(always)]
pub(super) fn face(a: Vertex, b: Vertex, c: Vertex) -> Simplex {
    let (ab, ac) = (b.point - a.point, c.point - a.point);
    let normal = ab.cross(ac);
    let squared = normal.length_squared();
    let longest =
        ab.length_squared().max(ac.length_squared()).max((c.point - b.point).length_squared());
    if squared > THIN * THIN * longest * longest {
        over_or_beside(a, b, c, normal, squared)
    } else {
        thin_face(a, b, c)
    }
}

/// The nearest point of a face with a known normal: over the face, or on an edge that the origin is
/// beyond. If the origin is beyond two edges, one of them is nearest.
#[inline(always)]
fn over_or_beside(a: Vertex, b: Vertex, c: Vertex, normal: DVec3, squared: f64) -> Simplex {
    let [p, q, r] = [a.point, b.point, c.point];
    // Doubled areas beside the edges, times the doubled area of the face.
    let areas =
        [(q, r - q), (r, p - r), (p, q - p)].map(|(start, edge)| start.cross(edge).dot(normal));
    let [beyond_bc, beyond_ca, beyond_ab] = areas.map(|area| area <= 0.0);
    match (beyond_bc, beyond_ca, beyond_ab) {
        (false, false, false) => {
            let scale = 1.0 / (areas[0] + areas[1] + areas[2]);
            let weights = areas.map(|area| area * scale);
            Simplex::new([a, b, c], weights, 3, normal * (p.dot(normal) / squared))
        }
        (true, false, false) => segment(b, c),
        (false, true, false) => segment(a, c),
        (false, false, true) => segment(a, b),
        (true, true, false) => segment(b, c).nearer(segment(a, c)),
        (true, false, true) => segment(b, c).nearer(segment(a, b)),
        (false, true, true) => segment(a, c).nearer(segment(a, b)),
        (true, true, true) => edges(a, b, c),
    }
}

#[inline(never)]
fn edges(a: Vertex, b: Vertex, c: Vertex) -> Simplex {
    segment(a, b).nearer(segment(a, c)).nearer(segment(b, c))
}

/// The nearest point of a face that is hardly wider than its longest edge. Coordinates along that
/// edge and across it keep the point in place for any rounding of its weights.
#[inline(never)]
fn thin_face(a: Vertex, b: Vertex, c: Vertex) -> Simplex {
    let border = edges(a, b, c);
    let [a, b, c] = longest_first([a, b, c]);
    let (edge, to_c) = (b.point - a.point, c.point - a.point);
    let length_squared = edge.length_squared();
    let along_c = to_c.dot(edge) / length_squared;
    let across = to_c - edge * along_c;
    let across = across - edge * (across.dot(edge) / length_squared);
    let width_squared = across.length_squared();
    let has_width = width_squared > COLLINEAR * COLLINEAR * length_squared;
    if !has_width {
        return border;
    }
    let weight_c = -a.point.dot(across) / width_squared;
    let weight_b = -a.point.dot(edge) / length_squared - weight_c * along_c;
    let weight_a = 1.0 - weight_b - weight_c;
    if !(weight_a > 0.0 && weight_b > 0.0 && weight_c > 0.0) {
        return border;
    }
    let normal = edge.cross(across);
    let nearest = normal * (a.point.dot(normal) / normal.length_squared());
    border.nearer(Simplex::new([a, b, c], [weight_a, weight_b, weight_c], 3, nearest))
}

/// The vertices turned so that the longest edge runs from the first to the second.
fn longest_first([a, b, c]: [Vertex; 3]) -> [Vertex; 3] {
    let length = |a: Vertex, b: Vertex| (b.point - a.point).length_squared();
    let (ab, bc, ca) = (length(a, b), length(b, c), length(c, a));
    if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// The normal of a face by its two shortest edges, and its squared length. `None` if rounding would
/// determine it.
#[inline(always)]
pub(super) fn thin_normal([a, b, c]: [DVec3; 3]) -> Option<(DVec3, f64)> {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let (of_ab, of_bc, of_ca) = (ab.length_squared(), bc.length_squared(), ca.length_squared());
    // Written out: an array, and an index in it, is written and read again.
    let (normal, shorter) = if of_ca > of_ab.max(of_bc) {
        (ab.cross(bc), of_ab * of_bc)
    } else if of_bc > of_ab {
        (ca.cross(ab), of_ca * of_ab)
    } else {
        (bc.cross(ca), of_bc * of_ca)
    };
    let squared = normal.length_squared();
    let is_wide = squared > NO_NORMAL * NO_NORMAL * shorter;
    is_wide.then_some((normal, squared))
}

/// Squared distance of a point from a triangle.
#[inline(always)]
pub(super) fn squared_distance(triangle: &[DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = triangle.map(|corner| Vertex { point: point - corner, corner: 0 });
    face(a, b, c).squared
}

/// [`face`], not inlined: a search has thirty of them.
#[inline(never)]
pub(super) fn side(a: Vertex, b: Vertex, c: Vertex) -> Simplex {
    face(a, b, c)
}

/// `a` is the newest vertex; the others are a face.
#[inline(always)]
fn tetrahedron(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> Step {
    let [ab, ac, ad] = [b, c, d].map(|v| v.point - a.point);
    let (abc, acd, adb) = (ab.cross(ac), ac.cross(ad), ad.cross(ab));
    let volume = abc.dot(ad);
    let lengths = ab.length_squared() * ac.length_squared() * ad.length_squared();
    let has_volume = volume * volume > FLAT * FLAT * lengths;
    if !has_volume {
        return flat_tetrahedron(a, b, c, d);
    }
    // Depth of the origin inside each face, where the opposite vertex counts 1.
    let scale = -1.0 / volume;
    let inside = [abc, acd, adb].map(|normal| a.point.dot(normal) * scale);
    let old = 1.0 - (inside[0] + inside[1] + inside[2]);
    match inside.map(|side| side > 0.0) {
        [true, true, true] if old > 0.0 => Step::Around([a, b, c, d]),
        [true, true, true] => Step::Beside(side(b, c, d)),
        [false, true, true] => Step::Beside(side(a, b, c)),
        [true, false, true] => Step::Beside(side(a, c, d)),
        [true, true, false] => Step::Beside(side(a, d, b)),
        [in_abc, in_acd, in_adb] => {
            let mut nearest = if in_abc { side(a, c, d) } else { side(a, b, c) };
            if !in_abc && !in_acd {
                nearest = nearest.nearer(side(a, c, d));
            }
            if !in_adb {
                nearest = nearest.nearer(side(a, d, b));
            }
            Step::Beside(nearest)
        }
    }
}

#[cold]
fn flat_tetrahedron(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> Step {
    let sides = side(a, b, c).nearer(side(a, c, d)).nearer(side(a, d, b));
    Step::Beside(sides.nearer(side(b, c, d)))
}
