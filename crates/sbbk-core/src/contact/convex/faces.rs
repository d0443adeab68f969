//! A triangle that crosses the convex hull of some points, by the hull's faces and edges.
//!
//! The least translation that separates the bodies is along the normal of a face of the difference.
//! Such faces belong to the faces of the hull, to both sides of the triangle, and to pairs of edges
//! whose arcs of normals cross. The normals of an edge of the hull form an arc between the normals
//! of its faces. The normals of an edge of the triangle form half of a great circle. So arcs cross
//! if one face of the hull rises along the edge of the triangle and the other one falls.
//!
//! Few pairs of edges are tried. The plane of a pair is no nearer to a corner of the triangle than
//! the nearer one of both faces of the hull. So both ends of the edge of the triangle must be below
//! the nearer face by less than the least depth so far.

use super::hull_surface::{FACES, HullSurface, POINTS, ROUNDING};
use super::lanes::{PlaneLanes, PointLanes, first_lane, splat};
use super::simplex::{squared_distance, thin_normal};
use super::support::lowest as lowest_corner;
use super::{ConvexContact, DOUBTFUL};
use crate::contact::closest::closest_on_lines;
use crate::contact::triangle::NEXT;
use crate::simd::bits;
use arrayvec::ArrayVec;
use glamx::DVec3;
use wide::f64x4;

/// Least sine between an edge of the triangle and an edge of the hull that are tried. The face
/// between them is narrower than this share of the edge.
const PARALLEL: f64 = 1.0e-12;

/// Distance by which a point may be off a body and count as on it, as a share of the size.
const ON_BODY: f64 = 1.0e-12;

/// Depth by which a corner may be above the deepest one and count as equally deep, as a share of
/// the size. Contact points are off the shape by as much.
const TIE: f64 = 1.0e-11;

/// Planes and edges of a hull, for depths of crossing triangles.
#[derive(Clone, Debug)]
pub(super) struct HullFaces {
    points: PointLanes,
    planes: Vec<PlaneLanes>,
    /// The faces beside each edge.
    beside: Vec<[u8; 2]>,
    /// The start of each edge, and its vector, counterclockwise around the first face.
    edges: Vec<[DVec3; 2]>,
}

/// The origin of a direction that separates the bodies.
#[derive(Clone, Copy)]
enum HullFacet {
    /// Of the hull.
    Face,
    Triangle,
    /// An edge of the hull, a point of it and its vector, and one of the triangle.
    Edges([DVec3; 2], usize),
}

/// A plane of the difference.
#[derive(Clone, Copy)]
struct Separation {
    /// Unit vector: the direction in which the triangle moves out of the hull.
    outward: DVec3,
    depth: f64,
    facet: HullFacet,
}

impl HullFaces {
    /// Builds the hull of some points, given triangles that may be its faces. `None` for a hull
    /// that is flat or has too many points, or if rounding determines the faces.
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Option<Self> {
        if points.len() > POINTS {
            return None;
        }
        let lanes = PointLanes::new(points);
        let surface = HullSurface::from_triangles(points, triangles)
            .or_else(|| HullSurface::by_growth(&lanes))?;
        let HullSurface { planes, corners, neighbors } = surface;
        let planes = planes.chunks(4).map(PlaneLanes::new).collect();
        let (mut beside, mut edges) = (Vec::new(), Vec::new());
        for (face, (corners, neighbors)) in (0..).zip(corners.iter().zip(&neighbors)) {
            for (i, &neighbor) in neighbors.iter().enumerate() {
                if face < neighbor {
                    beside.push([face, neighbor]);
                    edges.push([corners[i], corners[NEXT[i]] - corners[i]]);
                }
            }
        }
        Some(Self { points: lanes, planes, beside, edges })
    }

    /// The contact of a triangle that crosses the hull, given the size of both. `None` if the
    /// bodies may not cross, or if rounding determines the contact.
    pub fn penetration(&self, triangle: &[DVec3; 3], size: f64) -> Option<ConvexContact> {
        let doubtful = DOUBTFUL * size;
        let (normal, squared) = thin_normal(*triangle)?;
        let mut depths = ArrayVec::new();
        let mut least = self.least_of_faces(triangle, &mut depths);
        if least.depth <= doubtful {
            return None;
        }
        for normal in [normal, -normal] {
            let outward = normal / squared.sqrt();
            let depth = self.points.farthest(outward).0 - lowest_height(triangle, outward);
            if depth < least.depth {
                least = Separation { outward, depth, facet: HullFacet::Triangle };
            }
        }
        let of_edges = self.least_of_edges(triangle, &depths, least.depth)?;
        if let Some(of_edges) = of_edges {
            // A move to the support plane separates the bodies in spite of rounding of the arcs.
            let depth = self.points.farthest(of_edges.outward).0
                - lowest_height(triangle, of_edges.outward);
            if (depth - of_edges.depth).abs() > ROUNDING * size + 1.0e-10 * depth {
                return None;
            }
            least = Separation { depth, ..of_edges };
        }
        if least.depth <= doubtful {
            return None;
        }
        let on_triangle = self.on_triangle(triangle, &least, size)?;
        Some(ConvexContact::new(on_triangle, -least.outward, -least.depth))
    }

    /// The least depth along the normal of a face; and how deep each corner is below each face.
    #[inline(always)]
    fn least_of_faces(&self, triangle: &[DVec3; 3], depths: &mut Depths) -> Separation {
        let [a, b, c] = triangle.map(splat);
        let (mut least, mut at) = (f64x4::splat(f64::INFINITY), f64x4::ZERO);
        for (i, planes) in self.planes.iter().enumerate() {
            let below = [planes.depth(&a), planes.depth(&b), planes.depth(&c)];
            let deepest = below[0].fast_max(below[1]).fast_max(below[2]);
            let is_less = deepest.simd_lt(least);
            least = deepest.fast_min(least);
            at = is_less.bitselect(f64x4::splat(i as f64), at);
            depths.push(below);
        }
        let (least, at) = (least.to_array(), at.to_array());
        let lane = first_lane(|one, other| least[other] < least[one]);
        let outward = self.planes[at[lane] as usize].normal(lane);
        Separation { outward, depth: least[lane], facet: HullFacet::Face }
    }

    /// The least depth along a product of edges, if less than `most`; outer `None` for bodies
    /// apart.
    #[inline(always)]
    fn least_of_edges(
        &self,
        triangle: &[DVec3; 3],
        depths: &Depths,
        most: f64,
    ) -> Option<Option<Separation>> {
        let [a, b, c] = *triangle;
        let sides = [b - a, c - b, a - c];
        let marks = marks(depths, most);
        let mut least: Option<Separation> = None;
        // The least depth, and its square.
        let (mut most, mut squared) = (most, most * most);
        for (&[p, q], edge) in self.beside.iter().zip(&self.edges) {
            let [of_p, of_q] = [p, q].map(|face| marks[usize::from(face)]);
            let crossed = (of_p ^ of_q) & (of_p | of_q) >> 3;
            for j in bits(crossed.into()) {
                let nearer = |i: usize| {
                    let [p, q] = [p, q]
                        .map(|f| depths[usize::from(f / 4)][i].to_array()[usize::from(f % 4)]);
                    p.min(q)
                };
                let can_be_less = nearer(j) < most && nearer(NEXT[j]) < most;
                if !can_be_less {
                    continue;
                }
                let Some(outward) = face_of_edges(&sides, j, edge[1], of_p >> j & 1 == 1) else {
                    continue;
                };
                let length_squared = outward.length_squared();
                let depth = (edge[0] - triangle[j]).dot(outward);
                if depth <= 0.0 {
                    return None;
                }
                if depth * depth < squared * length_squared {
                    let scale = 1.0 / length_squared.sqrt();
                    most = depth * scale;
                    squared = most * most;
                    let facet = HullFacet::Edges(*edge, j);
                    least = Some(Separation { outward: outward * scale, depth: most, facet });
                }
            }
        }
        Some(least)
    }

    /// The point of the triangle that comes to lie on the hull when it moves out.
    #[inline(always)]
    fn on_triangle(&self, triangle: &[DVec3; 3], least: &Separation, size: f64) -> Option<DVec3> {
        let Separation { outward, depth, facet } = *least;
        let guess = match facet {
            HullFacet::Face => {
                let corner = triangle[lowest_corner(triangle, outward)];
                self.holds(corner + outward * depth, ON_BODY * size).then_some(corner)
            }
            HullFacet::Triangle => {
                let (_, vertex) = self.points.farthest(outward);
                let point = vertex - outward * depth;
                is_near(triangle, point, ON_BODY * size).then_some(point)
            }
            HullFacet::Edges([start, along], j) => {
                let (corner, side) = (triangle[j], triangle[(j + 1) % 3] - triangle[j]);
                let [s, t] = closest_on_lines(start - corner, side, along);
                let is_within = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
                is_within.then(|| corner + side * s)
            }
        };
        guess.or_else(|| self.where_flat(triangle, outward, depth, size))
    }

    /// The point of the triangle if features are parallel, or nearly so.
    #[inline(never)]
    fn where_flat(
        &self,
        triangle: &[DVec3; 3],
        outward: DVec3,
        depth: f64,
        size: f64,
    ) -> Option<DVec3> {
        let (tie, slack) = (TIE * size, ON_BODY * size);
        let low = lowest_height(triangle, outward) + tie;
        let is_low = triangle.map(|corner| corner.dot(outward) <= low);
        let out = outward * depth;
        for i in 0..3 {
            if is_low[i] && self.holds(triangle[i] + out, slack) {
                return Some(triangle[i]);
            }
        }
        for i in 0..3 {
            let next = (i + 1) % 3;
            if is_low[i] && is_low[next] {
                let ends = [triangle[i], triangle[next]];
                if let Some(share) = self.middle(ends.map(|end| end + out), slack) {
                    return Some(ends[0].lerp(ends[1], share));
                }
            }
        }
        let high = self.points.farthest(outward).0 - tie;
        let below = |point: DVec3| point - outward * depth;
        let mut points = self.points.iter().filter(|p| p.dot(outward) >= high).map(below);
        points.find(|point| is_near(triangle, *point, slack))
    }

    /// True if a point is in the hull, or off it by at most `slack`.
    fn holds(&self, point: DVec3, slack: f64) -> bool {
        let point = splat(point);
        let mut least = f64x4::splat(f64::INFINITY);
        for planes in &self.planes {
            least = least.fast_min(planes.depth(&point));
        }
        least.to_array().iter().all(|depth| *depth >= -slack)
    }

    /// The middle of the part of a segment that is in the hull, as a share of the segment.
    fn middle(&self, ends: [DVec3; 2], slack: f64) -> Option<f64> {
        let ends = ends.map(splat);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for planes in &self.planes {
            let [from, to] = [planes.depth(&ends[0]), planes.depth(&ends[1])];
            let (from, to) = (from.to_array(), to.to_array());
            for lane in 0..4 {
                let (from, to) = (from[lane] + slack, to[lane] + slack);
                if from < 0.0 && to < 0.0 {
                    return None;
                } else if from < 0.0 {
                    low = low.max(from / (from - to));
                } else if to < 0.0 {
                    high = high.min(from / (from - to));
                }
            }
        }
        (low <= high).then_some(0.5 * (low + high))
    }
}

/// Returns the outward product of a side of a triangle and an edge. `None` if they are nearly
/// parallel, or if the rest of the triangle is on the inner side. `falls_first`: the side falls
/// below the first face of the edge, not the second.
#[inline(always)]
fn face_of_edges(sides: &[DVec3; 3], j: usize, along: DVec3, falls_first: bool) -> Option<DVec3> {
    let side = sides[j];
    let product = side.cross(along);
    let outward = if falls_first { product } else { -product };
    let shortest = PARALLEL * PARALLEL * side.length_squared() * along.length_squared();
    let is_outside = outward.dot(sides[NEXT[NEXT[j]]]) <= 0.0;
    (outward.length_squared() > shortest && is_outside).then_some(outward)
}

/// Depth of each corner of a triangle below each face.
type Depths = ArrayVec<[f64x4; 3], { FACES / 4 }>;

/// Marks of each face, as bits. The low three tell along which sides of the triangle the face
/// rises. The next three are set if a corner is less than `most` below the face.
#[inline(always)]
fn marks(depths: &Depths, most: f64) -> [u8; FACES] {
    let mut marks = [0; FACES];
    let bound = f64x4::splat(most);
    for (mark, [a, b, c]) in marks.chunks_exact_mut(4).zip(depths) {
        let near = a.fast_min(*b).fast_min(*c).simd_lt(bound).to_bitmask();
        let [ab, bc, ca] = [a.simd_lt(*b), b.simd_lt(*c), c.simd_lt(*a)];
        let bits = SPREAD[ab.to_bitmask() as usize & 15]
            | SPREAD[bc.to_bitmask() as usize & 15] << 1
            | SPREAD[ca.to_bitmask() as usize & 15] << 2
            | (SPREAD[near as usize & 15] * (0b111 << 3));
        mark.copy_from_slice(&bits.to_le_bytes());
    }
    marks
}

/// Bit `i` of the index as the lowest bit of byte `i`.
const SPREAD: [u32; 16] = {
    let mut spread = [0; 16];
    let mut bits = 0;
    while bits < 16 {
        spread[bits as usize] = bits & 1 | (bits & 2) << 7 | (bits & 4) << 14 | (bits & 8) << 21;
        bits += 1;
    }
    spread
};

/// Height of the lowest corner of a triangle along a direction.
#[inline(always)]
fn lowest_height([a, b, c]: &[DVec3; 3], direction: DVec3) -> f64 {
    a.dot(direction).min(b.dot(direction)).min(c.dot(direction))
}

/// True if a point is at most `slack` off a triangle.
#[inline(always)]
fn is_near(triangle: &[DVec3; 3], point: DVec3, slack: f64) -> bool {
    squared_distance(triangle, point) <= slack * slack
}
