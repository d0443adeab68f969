//! Pairs of triangles with all their digits.

use glamx::{DVec3, Vec3};

use crate::contact::{TriangleContact, contact};
use crate::traverse::Placement;

/// Triangles this close touch, as a share of the lengths of their edges: what rounding can do to a
/// distance of zero. Higher: triangles that are apart count as touching. Lower: those that touch
/// count as apart.
const TOUCHING: f64 = 1.0e-12;

/// Two triangles in frame 1, relative to a corner of the first one, as
/// [`contact`](mod@crate::contact) needs them.
///
/// Coordinates are widened to f64 before any subtraction, so no digit of the relative position is
/// lost at any distance from the origin.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TrianglePair {
    /// A corner of triangle 1, in frame 1.
    pub origin: Vec3,
    /// Corners of triangle 1 and of triangle 2, in frame 1, relative to `origin`.
    pub corners: [[DVec3; 3]; 2],
}

impl TrianglePair {
    /// Triangle 1 in its own frame, and triangle 2 in its own, which is placed at `placement` in
    /// the frame of triangle 1.
    #[inline(always)]
    pub fn new(placement: &Placement, triangle1: [Vec3; 3], triangle2: [Vec3; 3]) -> Self {
        // Written out, as `array::map` is not always inlined.
        let ([a, b, c], [d, e, f]) = (triangle1, triangle2);
        let relative = |x: Vec3| x.as_dvec3() - a.as_dvec3();
        let placed = |x: Vec3| placement.to_frame1(x, a);
        Self {
            origin: a,
            corners: [[DVec3::ZERO, relative(b), relative(c)], [placed(d), placed(e), placed(f)]],
        }
    }

    /// The distance up to which these triangles touch.
    #[inline(always)]
    pub(super) fn touching_distance(&self) -> f64 {
        TOUCHING * self.corners.iter().map(edge_lengths).sum::<f64>()
    }
}

fn edge_lengths([a, b, c]: &[DVec3; 3]) -> f64 {
    ((*b - *a).abs() + (*c - *a).abs()).element_sum()
}

/// A pair of triangles of two meshes and its contact.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FoundPair {
    /// Index of the triangle in mesh 1.
    pub triangle1: u32,
    /// Index of the triangle in mesh 2.
    pub triangle2: u32,
    /// In frame 1; both points are relative to `origin`.
    pub contact: TriangleContact,
    /// A corner of triangle 1, in frame 1.
    pub origin: Vec3,
    /// True if the triangles touch or cross, up to 1e-12 of the lengths of their edges.
    pub is_touching: bool,
}

impl FoundPair {
    /// Two triangles by their indices and corners, mesh 2 placed at `placement` in the frame of
    /// mesh 1, if they touch or are at most `margin` apart.
    #[inline]
    pub fn of(
        placement: &Placement,
        (triangle1, corners1): (u32, [Vec3; 3]),
        (triangle2, corners2): (u32, [Vec3; 3]),
        margin: f64,
    ) -> Option<Self> {
        let pair = TrianglePair::new(placement, corners1, corners2);
        let [t1, t2] = &pair.corners;
        let contact = contact(t1, t2, margin.max(pair.touching_distance()))?;
        Some(Self::new([triangle1, triangle2], &pair, contact))
    }

    #[inline(always)]
    pub(super) fn new(
        [triangle1, triangle2]: [u32; 2],
        pair: &TrianglePair,
        contact: TriangleContact,
    ) -> Self {
        let is_touching = contact.distance <= pair.touching_distance();
        Self { triangle1, triangle2, contact, origin: pair.origin, is_touching }
    }

    /// The point on mesh 1, in frame 1.
    pub fn point1(&self) -> Vec3 {
        (self.origin.as_dvec3() + self.contact.point1).as_vec3()
    }

    /// The point on mesh 2, in frame 2.
    pub fn point2(&self, placement: &Placement) -> Vec3 {
        placement.to_frame2(self.contact.point2, self.origin).as_vec3()
    }

    /// The unit normal from mesh 1 to mesh 2, in frame 1.
    pub fn normal1(&self) -> Vec3 {
        self.contact.normal.as_vec3()
    }

    /// The opposite of [`normal1`](Self::normal1), in frame 2.
    pub fn normal2(&self, placement: &Placement) -> Vec3 {
        (placement.inverse * -self.contact.normal).normalize_or_zero().as_vec3()
    }
}
