//! Two shapes made of triangles, as the contact query sees them.

use glamx::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::query::Ray;
use parry3d::query::details::NormalConstraints;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact};
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::{Around, Facets};
use sbbk_core::traverse::{DescentCounts, DescentScratch, NodePair};

use super::chunks::ChunkResult;
use super::field::Field;
use super::pose::PairPose;
use super::query::Moving;
use super::state::Candidate;
use crate::mesh::{BEHIND, LazySurface, MeshView, ends_within, exit, is_covered, nearest_triangle};

/// Normal cones of both triangles.
pub(super) type Cones<'a> = [Option<&'a dyn NormalConstraints>; 2];

/// Features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// A shape made of triangles.
pub(crate) enum TriangleShape<'s> {
    /// A mesh and, for contacts of surfaces, its surface.
    Mesh(&'s MeshView<'s>, Option<&'s LazySurface<'s>>),
    Field(Field<'s>),
}

/// Two shapes made of triangles, and their surfaces.
pub(crate) trait TriangleShapes: Sync {
    /// The triangles of either shape.
    type Facets<'f>: Facets
    where
        Self: 'f;

    fn moving(&self) -> Moving<'_>;

    /// Adds all pairs of triangles within `margin`, and few others.
    fn descend(
        &self,
        margin: Real,
        counts: &mut DescentCounts,
        memory: &mut DescentMemory,
        found: &mut Vec<Candidate<Hint>>,
    );

    /// Returns the corners of two triangles; `None` if one does not exist.
    fn corners(&self, triangles: [u32; 2]) -> Option<[[Vector; 3]; 2]>;

    /// Returns two triangles in frame 1, relative to a corner: with all digits.
    #[inline(always)]
    fn local(&self, pose: &PairPose, triangles: [u32; 2]) -> Option<TrianglePair> {
        let [triangle1, triangle2] = self.corners(triangles)?;
        Some(TrianglePair::new(&pose.placement12, triangle1, triangle2))
    }

    /// Calls `then` with the normal cones of two triangles.
    fn with_cones(&self, triangles: [u32; 2], then: impl FnOnce(Cones<'_>));

    /// Returns the surface around a triangle of shape 1 (0) or 2 (1), for contacts of surfaces.
    fn surface(&self, i: usize, triangle: u32) -> Option<Around<Self::Facets<'_>>>;

    /// Returns shape 1 (0) or 2 (1).
    fn shape(&self, i: usize) -> TriangleShape<'_>;

    /// Returns true if a shape has an inside.
    fn is_solid(&self, i: usize) -> bool;

    /// Returns the distance up to which contacts must be local minima; infinite for contacts of
    /// each two triangles. Farther contacts, of soft CCD, are all kept: bodies may turn before they
    /// meet.
    fn filter_distance(&self) -> f64;

    /// Returns the distance up to which all pairs of triangles are candidates. Farther contacts are
    /// [far](super::far).
    fn reach(&self) -> Real;

    /// Returns the box around a shape, in its frame.
    fn bounds(&self, i: usize) -> Aabb {
        match self.shape(i) {
            TriangleShape::Mesh(mesh, _) => *mesh.root(),
            TriangleShape::Field(field) => *field.0.root_aabb(),
        }
    }

    /// Returns the least coordinate of a shape along a direction, in its frame; `None` if not known.
    fn lowest(&self, i: usize, direction: Vector) -> Option<Real> {
        let TriangleShape::Mesh(mesh, _) = self.shape(i) else { return None };
        Some(mesh.lowest(direction))
    }

    /// Returns true if a point in the frame of a shape may be inside it.
    fn is_covered(&self, i: usize, point: Vector) -> bool {
        match self.shape(i) {
            TriangleShape::Mesh(mesh, _) => is_covered(mesh.mesh, point),
            TriangleShape::Field(_) => true,
        }
    }

    /// Returns the nearest point of a surface, and the cosine between the direction to the point
    /// and the inward normal.
    fn nearest(&self, i: usize, point: Vector) -> Option<(Vector, Real)> {
        match self.shape(i) {
            TriangleShape::Mesh(_, surface) => {
                let (_, nearest, behind) = surface?.nearest(point)?;
                Some((nearest, behind))
            }
            TriangleShape::Field(field) => field.nearest(point),
        }
    }

    /// Returns the distance in which a ray from a point inside a shape leaves it, and the outward normal there. `None`
    /// if the ray meets nothing, or first meets the front of a solid's triangle.
    fn exit(&self, i: usize, ray: &Ray, is_sheet: bool) -> Option<(Real, Vector)> {
        match self.shape(i) {
            TriangleShape::Mesh(mesh, _) => exit(mesh.mesh, ray, is_sheet),
            TriangleShape::Field(field) => exit(field.0, ray, is_sheet),
        }
    }

    /// Returns true if a solid ends within a length along a ray that starts in it. The ground below a height field
    /// has no end.
    fn ends_within(&self, i: usize, ray: &Ray, length: Real) -> bool {
        match self.shape(i) {
            TriangleShape::Mesh(mesh, _) => ends_within(mesh.mesh, ray, length),
            TriangleShape::Field(_) => false,
        }
    }

    /// Returns the nearest triangle of a shape to a point in its frame, if that is within a distance. The triangle
    /// of a height field may be another that is near.
    fn nearest_triangle(&self, i: usize, point: Vector, within: Real) -> Option<u32> {
        match self.shape(i) {
            TriangleShape::Mesh(mesh, _) => nearest_triangle(mesh.mesh, point, within),
            TriangleShape::Field(field) => field.nearest_triangle(point, within),
        }
    }

    /// Returns the tips of a shape and half-edges that start there, for [far](super::far) contacts.
    fn tips(&self, i: usize) -> impl Iterator<Item = (u32, Vector)> {
        let surface = match self.shape(i) {
            TriangleShape::Mesh(_, surface) => surface,
            TriangleShape::Field(_) => None,
        };
        surface.into_iter().flat_map(LazySurface::tips)
    }

    /// Returns the direction in which shape 2 separates from shape 1, if one is deep in the other.
    fn separation(&self) -> Option<DVec3>;

    /// Returns the push-out of one shape wholly inside the other, where no contact was found. `is_in_both`: the shapes
    /// cross, and the middle of the smaller one is known to be in both.
    fn push_out(&mut self, _is_in_both: bool) -> Option<TriangleHit> {
        None
    }

    /// Returns true for contacts of surfaces.
    fn has_surface(&self) -> bool {
        self.filter_distance() < f64::INFINITY
    }

    /// Calls `then` with the normal cones that contacts obey: none for contacts of surfaces.
    #[inline(always)]
    fn with_constraints(&self, triangles: [u32; 2], then: impl FnOnce(Cones<'_>)) {
        if self.has_surface() { then([None; 2]) } else { self.with_cones(triangles, then) }
    }

    /// Returns the translation that separates shape 2 from shape 1 by the shortest way from a point.
    /// `middle` is in the frame of shape `inner` and must be in both shapes; both must be solids.
    fn way_out(&self, pose: &PairPose, inner: usize, middle: Vector) -> Option<DVec3> {
        if !(0..2).all(|i| self.is_solid(i)) {
            return None;
        }
        let placed = pose.in_other(inner, middle);
        let exit = |i: usize, point: Vector| {
            let (exit, behind) = self.is_covered(i, point).then(|| self.nearest(i, point))??;
            (behind >= BEHIND).then_some(exit)
        };
        let out = exit(1 - inner, placed)? - placed;
        exit(inner, middle)?;
        let out = if inner == 0 { -(pose.pos12.rotation * out) } else { out };
        Some(out.as_dvec3())
    }
}

/// A contact and its subshapes.
pub(super) type TriangleHit = ([u32; 2], TriangleSurfaceContact);

/// A contact of two triangles, or of the surfaces around them.
#[derive(Copy, Clone)]
pub(crate) struct TriangleSurfaceContact {
    pub(super) contact: TriangleContact,
    pub(super) source: ContactSource,
}

impl TriangleSurfaceContact {
    /// Returns a contact that pushes shapes apart along a normal, at points that belong to no feature.
    pub(super) fn push_out(normal: DVec3, distance: f64, [point1, point2]: [DVec3; 2]) -> Self {
        let features = FeaturePair::new(Feature::Face, Feature::Face);
        let contact = TriangleContact { normal, distance, point1, point2, features };
        Self { contact, source: ContactSource::PushOut }
    }
}

/// Origin of a contact.
#[derive(Copy, Clone, PartialEq)]
pub(super) enum ContactSource {
    /// Two triangles; their closest points are points of the contact.
    Triangles,
    /// Two crossing triangles, along an axis that leads out of solids.
    OutwardAxis,
    /// Two shapes, one inside the other, or deep in each other.
    PushOut,
}

impl ContactSource {
    /// Returns the normal cones that a contact obeys.
    pub(super) fn cones(self, of_triangles: Cones<'_>) -> Cones<'_> {
        if self == Self::PushOut { [None; 2] } else { of_triangles }
    }
}

/// Memory for descents.
#[derive(Default)]
pub(crate) struct DescentMemory {
    /// Triangles at which a descent starts.
    pub(super) near: Vec<u32>,
    /// Nodes at which a descent starts.
    pub(super) start: Vec<NodePair>,
    pub(super) descent: DescentChunk,
}

/// Result of a chunk of a descent, and memory for it.
#[derive(Default)]
pub(super) struct DescentChunk {
    pub(super) found: Vec<Candidate<Hint>>,
    pub(super) counts: DescentCounts,
    pub(super) stack: DescentScratch,
}

impl ChunkResult for DescentChunk {
    fn append(&mut self, next: Self) {
        self.found.extend(next.found);
        self.counts += next.counts;
    }
}
