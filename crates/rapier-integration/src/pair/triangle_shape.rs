//! A shape made of triangles: a mesh or a height field, as the contact query sees it.

use std::ops::ControlFlow;

use glamx::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Real, Vector};
use parry3d::query::{Ray, RayCast};
use parry3d::shape::{CompositeShapeRef, Triangle, TrianglePseudoNormals};
use sbbk_core::contact::Feature;
use sbbk_core::surface::{Around, Facets, MinimumCones, PlaceMemo, Side, SurfaceKind};
use sbbk_core::volumes::Sphere;

use super::field::Field;
use crate::mesh::{
    BEHIND, LazySurface, MeshFacets, MeshView, ends_within, exit, is_covered, nearest_triangle,
};

/// A shape made of triangles.
pub(crate) enum TriangleShape<'q> {
    Mesh(MeshShape<'q>),
    Field(FieldShape<'q>),
}

/// A mesh.
pub(crate) struct MeshShape<'q> {
    pub(super) view: &'q MeshView<'q>,
    /// Set for contacts of surfaces.
    pub(super) surface: Option<LazySurface<'q>>,
    pub(super) room: Room,
}

/// Tells if a mesh is a room for the other shape, and has no inside.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) enum Room {
    No,
    /// Faces lead away from the room. They collide on both sides, as what stands in the room has faces of its own.
    FacingOut,
    /// Faces lead into the room, so the body is behind them.
    FacingIn,
}

/// A height field.
pub(crate) struct FieldShape<'q> {
    pub(super) field: Field<'q>,
    /// Side of the ground, for contacts of surfaces.
    pub(super) side: Option<Side>,
    /// The last triangle that was asked for its normal cone, and the cone. Contacts of a triangle follow each
    /// other, and Parry computes the cone from four triangles.
    pub(super) cone: Option<(u32, Option<TrianglePseudoNormals>)>,
}

impl TriangleShape<'_> {
    /// Returns the corners of a triangle; `None` if it does not exist.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> Option<[Vector; 3]> {
        match self {
            Self::Mesh(mesh) => Some(mesh.view.corners(triangle)),
            Self::Field(FieldShape { field, .. }) => {
                let Triangle { a, b, c } = field.triangle(triangle)?;
                Some([a, b, c])
            }
        }
    }

    /// Returns the normal cone of a triangle.
    pub(super) fn cone(&mut self, triangle: u32) -> Option<TrianglePseudoNormals> {
        let FieldShape { field, cone, .. } = match self {
            Self::Mesh(mesh) => return mesh.view.mesh.triangle_normal_constraints(triangle),
            Self::Field(field) => field,
        };
        let known = cone.take().filter(|(of, _)| *of == triangle);
        let known =
            known.unwrap_or_else(|| (triangle, field.0.triangle_normal_constraints(triangle)));
        cone.insert(known).1.clone()
    }

    /// Returns the surface around a triangle, for contacts of surfaces.
    #[inline]
    pub(super) fn around(&self, triangle: u32) -> Option<Around<ShapeFacets<'_>>> {
        match self {
            Self::Mesh(MeshShape { surface, room, .. }) => {
                let Around { facets, side } = surface.as_ref()?.around(triangle);
                let side = match (room, side) {
                    (Room::FacingOut, _) => Side::Sheet,
                    (Room::FacingIn, Side::Turned) => Side::Outer,
                    _ => side,
                };
                Some(Around { facets: ShapeFacets::Mesh(facets), side })
            }
            Self::Field(FieldShape { field, side, .. }) => {
                Some(Around { facets: ShapeFacets::Field(*field), side: (*side)? })
            }
        }
    }

    /// Returns the sign with which most normals of the shape lead out of it.
    pub(super) fn outward(&self) -> f64 {
        match self {
            Self::Mesh(MeshShape { surface: Some(surface), room: Room::No, .. })
                if surface.kind() == SurfaceKind::InsideOut =>
            {
                -1.0
            }
            _ => 1.0,
        }
    }

    /// Returns true if a triangle of a mesh has a double that is wound the other way.
    pub(super) fn is_two_sided(&self, triangle: u32) -> bool {
        let Self::Mesh(MeshShape { surface: Some(surface), .. }) = self else { return false };
        surface.facets().is_two_sided(triangle)
    }

    /// Returns true if the shape has an inside. Only contacts of surfaces ask for it.
    pub(super) fn is_solid(&self) -> bool {
        match self {
            Self::Mesh(MeshShape { surface, room, .. }) => {
                let is_solid = |surface: &LazySurface<'_>| surface.kind() != SurfaceKind::Sheet;
                *room == Room::No && surface.as_ref().is_some_and(is_solid)
            }
            Self::Field(FieldShape { side, .. }) => *side == Some(Side::Outer),
        }
    }

    /// Returns the box around the shape, in its frame.
    #[inline]
    pub(super) fn bounds(&self) -> Aabb {
        match self {
            Self::Mesh(mesh) => *mesh.view.root(),
            Self::Field(FieldShape { field, .. }) => *field.0.root_aabb(),
        }
    }

    /// Returns a ball around a mesh; an infinite one for a height field.
    pub(super) fn ball(&self) -> Sphere {
        match self {
            Self::Mesh(mesh) => mesh.view.ball(),
            Self::Field(_) => Sphere { centre: Vector::ZERO, radius: Real::INFINITY },
        }
    }

    /// Returns the square of half the diagonal of the box around a mesh. A height field counts as larger than any.
    pub(super) fn size_squared(&self) -> Real {
        match self {
            Self::Mesh(mesh) => mesh.view.size_squared(),
            Self::Field(_) => Real::INFINITY,
        }
    }

    /// Returns the length of a triangle's side, if equal triangles cover the box around the shape.
    pub(super) fn triangle_size(&self) -> Real {
        let count = match self {
            Self::Mesh(mesh) => mesh.view.mesh.indices().len(),
            Self::Field(field) => field.field.triangle_count(),
        };
        let Vector { x, y, z } = self.bounds().extents();
        let area = 2.0 * (x * y + y * z + z * x);
        (2.0 * area / count as Real).sqrt()
    }

    /// Returns the height of a mesh over the middle of its box along a unit direction; 0 for a height field.
    pub(super) fn height(&self, direction: Vector) -> Real {
        let Self::Mesh(mesh) = self else { return 0.0 };
        mesh.view.height(direction, 0.0)
    }

    /// Returns the least coordinate along a direction, in the frame of the shape; `None` if not known.
    pub(super) fn lowest(&self, direction: Vector) -> Option<Real> {
        let Self::Mesh(mesh) = self else { return None };
        Some(mesh.view.lowest(direction))
    }

    /// Returns the nearest point of the surface, and the cosine between the direction to the point
    /// and the inward normal.
    pub(super) fn nearest(&self, point: Vector) -> Option<(Vector, Real)> {
        match self {
            Self::Mesh(MeshShape { surface, .. }) => {
                let (_, nearest, behind) = surface.as_ref()?.nearest(point)?;
                Some((nearest, behind))
            }
            Self::Field(FieldShape { field, .. }) => field.nearest(point),
        }
    }

    /// Returns the nearest point of the surface, if a point is inside.
    pub(super) fn nearest_exit(&self, point: Vector) -> Option<Vector> {
        let may_be_inside = match self {
            Self::Mesh(mesh) => is_covered(mesh.view.mesh, point),
            Self::Field(_) => true,
        };
        let (exit, behind) = may_be_inside.then(|| self.nearest(point))??;
        (behind >= BEHIND).then_some(exit)
    }

    /// Returns the distance in which a ray from a point inside leaves the shape, and the outward normal there. `None`
    /// if the ray meets nothing, or first meets the front of a solid's triangle.
    pub(super) fn exit(&self, ray: &Ray, is_sheet: bool) -> Option<(Real, Vector)> {
        let outward = (!is_sheet).then(|| self.outward());
        match self {
            Self::Mesh(mesh) => exit(mesh.view.mesh, ray, outward),
            Self::Field(FieldShape { field, .. }) => exit(field.0, ray, outward),
        }
    }

    /// Returns true if a solid ends within a length along a ray that starts in it. The ground below a height field
    /// has no end.
    pub(super) fn ends_within(&self, ray: [DVec3; 2], length: f64) -> bool {
        let Self::Mesh(mesh) = self else { return false };
        ends_within(mesh.view.mesh, ray, length, self.outward())
    }

    /// Returns true if a point may be in the body. Rays disagree on points of the surface. Sheets have the body behind them.
    pub(super) fn may_hold(&self, point: Vector) -> bool {
        let is_inside = |sign: i32| f64::from(sign) * self.outward() > 0.0;
        match self {
            Self::Mesh(MeshShape { surface: Some(surface), .. })
                if surface.kind() != SurfaceKind::Sheet =>
            {
                surface.winding_sign(point).is_none_or(is_inside)
            }
            _ => self.nearest(point).is_none_or(|(_, behind)| behind >= 0.0),
        }
    }

    /// Returns the signs with which normals of triangles may lead out of the shape.
    pub(super) fn ways_out(&self) -> &'static [Real] {
        match (self.is_solid(), self.outward() > 0.0) {
            (false, _) => &[1.0, -1.0],
            (true, true) => &[1.0],
            (true, false) => &[-1.0],
        }
    }

    /// Returns the first triangle that a ray meets within a length, the length, and the cosine of the angle with the normal.
    pub(super) fn first_met(&self, ray: &Ray, within: Real) -> Option<(u32, Real, Real)> {
        let (triangle, hit) = match self {
            Self::Mesh(mesh) => {
                let shape = CompositeShapeRef(mesh.view.mesh);
                shape.cast_local_ray_and_get_normal(ray, within, false)?
            }
            Self::Field(FieldShape { field, .. }) => {
                let hit = field.0.cast_local_ray_and_get_normal(ray, within, false)?;
                let place = ray.point_at(hit.time_of_impact);
                (field.nearest_triangle(place, within)?, hit)
            }
        };
        Some((triangle, hit.time_of_impact, -hit.normal.dot(ray.dir)))
    }

    /// Returns the nearest triangle to a point, if that is within a distance. The triangle of a height field may be
    /// another that is near.
    pub(super) fn nearest_triangle(&self, point: Vector, within: Real) -> Option<u32> {
        match self {
            Self::Mesh(mesh) => nearest_triangle(mesh.view.mesh, point, within),
            Self::Field(FieldShape { field, .. }) => field.nearest_triangle(point, within),
        }
    }

    /// Returns the tips of a mesh and half-edges that start there, for [far](super::far) contacts.
    pub(super) fn tips(&self) -> impl Iterator<Item = (u32, Vector)> {
        let surface = match self {
            Self::Mesh(MeshShape { surface, .. }) => surface.as_ref(),
            Self::Field(_) => None,
        };
        surface.into_iter().flat_map(LazySurface::tips)
    }
}

/// The triangles of a shape.
pub(super) enum ShapeFacets<'a> {
    Mesh(MeshFacets<'a>),
    Field(Field<'a>),
}

impl Facets for ShapeFacets<'_> {
    #[inline]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        match self {
            Self::Mesh(mesh) => mesh.twin(half_edge),
            Self::Field(field) => field.twin(half_edge),
        }
    }

    #[inline(always)]
    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        match self {
            Self::Mesh(mesh) => mesh.corner(half_edge, i),
            Self::Field(field) => field.corner(half_edge, i),
        }
    }

    #[inline]
    fn is_whole(&self, triangle: u32, feature: Feature) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.is_whole(triangle, feature),
            Self::Field(field) => field.is_whole(triangle, feature),
        }
    }

    fn near(&self, corners: [DVec3; 2], visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        match self {
            Self::Mesh(mesh) => mesh.near(corners, visit),
            Self::Field(field) => field.near(corners, visit),
        }
    }

    fn outward(&self, triangle: u32) -> f64 {
        match self {
            Self::Mesh(mesh) => mesh.outward(triangle),
            Self::Field(field) => field.outward(triangle),
        }
    }

    #[inline]
    fn cones(&self, triangle: u32) -> MinimumCones {
        match self {
            Self::Mesh(mesh) => mesh.cones(triangle),
            Self::Field(field) => field.cones(triangle),
        }
    }

    fn memo(&self) -> Option<&PlaceMemo> {
        match self {
            Self::Mesh(mesh) => mesh.memo(),
            Self::Field(_) => None,
        }
    }
}
