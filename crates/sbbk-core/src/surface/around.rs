use std::ops::ControlFlow;

use glamx::{DVec3, Vec3};

use super::Surface;
use crate::contact::Feature;
use crate::simd::each;

/// Which triangles of a mesh share edges. Half-edge `3 t + i` runs from vertex `i` of triangle `t`
/// to the next one.
pub trait Twins {
    /// The half-edge that runs back in the neighbour, if there is exactly one.
    fn twin(&self, half_edge: u32) -> Option<u32>;
}

/// The triangles of a surface, and where they are: of a mesh, or of what has no list of them.
pub trait Facets: Twins {
    /// A corner of the triangle of a half-edge, counted from its start.
    fn corner(&self, half_edge: u32, i: usize) -> DVec3;
}

impl Twins for Surface {
    #[inline]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        self.twins.get(half_edge)
    }
}

/// The triangles of a mesh, and how they hang together.
#[derive(Clone, Copy)]
pub struct MeshFacets<'a> {
    /// The neighbours of the triangles of this mesh.
    pub twins: &'a dyn Twins,
    /// The vertices of the mesh.
    pub vertices: &'a [Vec3],
    /// The triangles of the mesh.
    pub triangles: &'a [[u32; 3]],
}

impl Twins for MeshFacets<'_> {
    #[inline(always)]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        self.twins.twin(half_edge)
    }
}

impl Facets for MeshFacets<'_> {
    #[inline(always)]
    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        let triangle = self.triangles[half_edge as usize / 3];
        self.vertices[triangle[(half_edge as usize + i) % 3] as usize].as_dvec3()
    }
}

/// A surface, seen from its triangles.
#[derive(Clone, Copy)]
pub struct Around<F> {
    /// The triangles.
    pub facets: F,
    /// Whether the surface bounds a solid.
    pub is_solid: bool,
}

/// How far a neighbour may rise towards a direction before it is nearer, as a sine. Higher: bodies
/// feel the edges between facets. Lower: a face that lies on another, not quite flat, loses part
/// of its contacts.
const RISE: f64 = 0.05;

/// The same where the other surface is a face. Higher: edges within a floor stop what slides over it.
/// Lower: of a body that rocks from point to point, the next one comes as a surprise.
const RISE_TO_FACE: f64 = 0.3;

/// Sine of the angle to a flat side, of triangles of it and of directions along it. Higher: a nut
/// locks on its bolt. With [`RISE`] at edges within flat sides, of two gears at 5 rad/s one runs ahead of
/// the other by 0.024 in place of 0.015 rad, and by 0.06 with a manifold for every contact.
const FLAT: f64 = 1.0e-3;

impl<F: Facets> Around<F> {
    /// Whether a unit direction leads from a feature out in front of all triangles around it: what
    /// it leads to is nowhere nearer, and of a solid it leads out. It should be that from a point of
    /// the feature to the nearest point of something else: across the face, from an edge, or from a
    /// vertex into its Voronoi cell. `to` is the feature that is there, if it is known. A face may be
    /// held up by the feature though a neighbour is a little nearer; an edge by no edge within a flat
    /// side.
    pub fn is_front(
        &self,
        triangle: u32,
        feature: Feature,
        direction: DVec3,
        to: Option<Feature>,
    ) -> bool {
        if feature == Feature::Face {
            let (height, is_upright) = self.over_face(triangle, direction);
            let leads_in = self.is_solid && height < 0.0;
            return is_upright && !leads_in;
        }
        let rise = match (feature, to) {
            (_, Some(Feature::Face)) => RISE_TO_FACE,
            (Feature::Edge(_), Some(Feature::Edge(_))) if self.is_flat(triangle, feature) => FLAT,
            _ => RISE,
        };
        let rises = |edge: DVec3| {
            let height = edge.dot(direction);
            height > 0.0 && height * height > rise * rise * edge.length_squared()
        };
        let (mut height, mut has_risen) = (0.0, false);
        self.around(triangle, feature, |Fan { edges: [u, v], are_new, .. }| {
            has_risen = are_new[0] && rises(u) || are_new[1] && rises(v);
            if has_risen {
                return ControlFlow::Break(());
            }
            if self.is_solid {
                height += u.cross(v).dot(direction);
            }
            ControlFlow::Continue(())
        });
        let leads_in = height < 0.0;
        !has_risen && !leads_in
    }

    /// Whether the triangles at an edge are in one plane.
    fn is_flat(&self, triangle: u32, edge: Feature) -> bool {
        let Some(twin) = self.facets.twin(half_edge(triangle, edge)) else { return false };
        let across = self.corner(twin, 2) - self.corner(twin, 0);
        let normal = self.normal(triangle);
        across.dot(normal).abs() <= FLAT * across.length() * normal.length()
    }

    /// Whether such a direction leads into the solid.
    pub fn is_behind(&self, triangle: u32, feature: Feature, direction: DVec3) -> bool {
        if !self.is_solid {
            return false;
        }
        if feature == Feature::Face {
            let (height, is_upright) = self.over_face(triangle, direction);
            return is_upright && height < 0.0;
        }
        let mut height = 0.0;
        self.around(triangle, feature, |Fan { edges: [u, v], .. }| {
            height += u.cross(v).dot(direction);
            ControlFlow::Continue(())
        });
        height < 0.0
    }

    /// How far a flat side goes on beyond a triangle of it in a unit direction, from vertex to vertex,
    /// up to `most`; 0 if the direction does not lie in the side.
    pub fn side_beyond(&self, triangle: u32, direction: DVec3, most: f64) -> f64 {
        let normal = self.normal(triangle);
        if normal.dot(direction).abs() > FLAT * normal.length() {
            return 0.0;
        }
        let height = |half_edge: &u32| self.corner(*half_edge, 0).dot(direction);
        let corners = 3 * triangle..3 * triangle + 3;
        let highest = corners.max_by(|a, b| height(a).total_cmp(&height(b)));
        let (mut at, mut beyond) = (highest.unwrap_or_default(), 0.0);
        while beyond < most {
            let (mut rise, mut to) = (0.0, at);
            self.around(
                at / 3,
                Feature::Vertex((at % 3) as u8),
                |Fan { half_edge, edges: [u, v], .. }| {
                    for (edge, end) in [(u, next(half_edge)), (v, previous(half_edge))] {
                        let (height, length) = (edge.dot(direction), edge.length());
                        let is_flat = edge.dot(normal).abs() <= FLAT * length * normal.length();
                        if is_flat && height > rise && height > RISE * length {
                            (rise, to) = (height, end);
                        }
                    }
                    ControlFlow::Continue(())
                },
            );
            if to == at {
                break;
            }
            (at, beyond) = (to, beyond + rise);
        }
        beyond.min(most)
    }

    /// How far a direction points along the normal of a triangle, times twice the area, and whether
    /// it is nearly upright.
    fn over_face(&self, triangle: u32, direction: DVec3) -> (f64, bool) {
        let normal = self.normal(triangle);
        let height = normal.dot(direction);
        (height, height.abs() > (1.0 - RISE) * normal.length())
    }

    /// The normal of a triangle, as long as twice its area.
    fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = each(|i| self.corner(3 * triangle, i));
        (b - a).cross(c - a)
    }

    /// Visits the triangles around an edge or a vertex, the given one first, while it is told to.
    #[inline(always)]
    fn around(
        &self,
        triangle: u32,
        feature: Feature,
        mut visit: impl FnMut(Fan) -> ControlFlow<()>,
    ) {
        let first = half_edge(triangle, feature);
        let start = self.corner(first, 0);
        let edge = |half_edge: u32, i: usize| self.corner(half_edge, i) - start;
        let [first_u, first_v] = [edge(first, 1), edge(first, 2)];
        let own = Fan { half_edge: first, edges: [first_u, first_v], are_new: [true; 2] };
        if visit(own).is_break() {
            return;
        }
        if !matches!(feature, Feature::Vertex(_)) {
            if let Some(half_edge) = self.facets.twin(first) {
                let start = self.corner(half_edge, 0);
                let edge = |i: usize| self.corner(half_edge, i) - start;
                let [u, v] = [edge(1), edge(2)];
                let _ = visit(Fan { half_edge, edges: [u, v], are_new: [true; 2] });
            }
            return;
        }
        let (mut at, mut u) = (first, first_v);
        while let Some(twin) = self.facets.twin(previous(at)) {
            if twin == first {
                return;
            }
            at = twin;
            let v = edge(at, 2);
            if visit(Fan { half_edge: at, edges: [u, v], are_new: [false, true] }).is_break() {
                return;
            }
            u = v;
        }
        // A border: on from the other side.
        let (mut at, mut v) = (first, first_u);
        while let Some(twin) = self.facets.twin(at) {
            at = next(twin);
            let u = edge(at, 1);
            if visit(Fan { half_edge: at, edges: [u, v], are_new: [true, false] }).is_break() {
                return;
            }
            v = u;
        }
    }

    #[inline(always)]
    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        self.facets.corner(half_edge, i)
    }
}

/// A triangle at an edge or a vertex.
struct Fan {
    /// Starts at the vertex, or at an end of the edge.
    half_edge: u32,
    /// Two edges of the triangle, from there.
    edges: [DVec3; 2],
    /// Whether no triangle before it has them too.
    are_new: [bool; 2],
}

fn half_edge(triangle: u32, feature: Feature) -> u32 {
    3 * triangle
        + match feature {
            Feature::Face => 0,
            Feature::Edge(i) | Feature::Vertex(i) => u32::from(i),
        }
}

fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}
