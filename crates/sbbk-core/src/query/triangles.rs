//! A pair of triangles with all its digits.

use glamx::{DVec3, Vec3};

use crate::contact::TriangleContact;
use crate::traverse::Placement;
use crate::tree::LeafBatch;

/// Triangles this close touch, as a share of the lengths of their edges: what rounding can do to a distance of zero.
/// Higher: triangles that are apart count as touching. Lower: those that touch count as apart.
const TOUCHING: f64 = 1.0e-12;

/// Two triangles in frame 1, relative to a corner of the first one: all their digits are about each other.
pub(super) struct LocalPair {
    pub(super) origin: Vec3,
    pub(super) corners: [[DVec3; 3]; 2],
}

impl LocalPair {
    #[inline(always)]
    pub(super) fn new(
        placement: &Placement,
        (batch1, lane1): (&LeafBatch, usize),
        (batch2, lane2): (&LeafBatch, usize),
    ) -> Self {
        let [a, b, c] = batch1.corners(lane1);
        let [d, e, f] = batch2.corners(lane2);
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

/// What a search found: a pair of triangles and its contact.
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
    /// Whether the triangles touch or cross, up to 1e-12 of the lengths of their edges.
    pub is_touching: bool,
}

impl FoundPair {
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
