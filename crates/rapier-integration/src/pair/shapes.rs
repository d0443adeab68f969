//! Two shapes made of triangles, as the contact query sees them. A shape is a mesh or a height
//! field.

use std::ops::{ControlFlow, Index};
use std::sync::OnceLock;

use glamx::DVec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Real, Vector};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::{CompositeShapeRef, Triangle, TrianglePseudoNormals};
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact, contact, contact_from};
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::{self, Around, Facets, MinimumCones, PlaceMemo, Side, SurfaceKind};
use sbbk_core::traverse::MovingBody;
use sbbk_core::tree::Tree;
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::field::Field;
use super::pose::{Moving, PairPose};
use super::tuning::FILTERED;
use crate::mesh::{LazySurface, MeshFacets, MeshView, first_hit, leaves};

/// Distance, in sizes of the triangles, that rounding of poses to f32 may open between triangles
/// that touch.
pub(super) const NEARLY_TOUCHING: f64 = 1.0e-6;

/// Returns the distance up to which contacts must be local minima, from the radius of the smaller
/// shape.
pub(super) fn filter_distance(has_surface: bool, radius: Real) -> f64 {
    if has_surface { f64::from(FILTERED * radius) } else { f64::INFINITY }
}

/// Returns the unit of the filter: the prediction distance, or less for small shapes.
pub(super) fn filter_unit(pose: &PairPose, filter_distance: f64) -> f64 {
    f64::from(pose.prediction).min(filter_distance)
}

/// Normal cones of both triangles.
pub(super) type Cones<'a> = [Option<&'a dyn NormalConstraints>; 2];

/// Returns normal cones as Parry takes them.
pub(super) fn as_cones(of_triangles: &[Option<TrianglePseudoNormals>; 2]) -> Cones<'_> {
    of_triangles.each_ref().map(|cone| Some(cone.as_ref()? as &dyn NormalConstraints))
}

/// Features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// Two shapes made of triangles at a pose. One of them is a mesh.
pub(crate) struct TriangleShapes<'q> {
    pub(super) pose: &'q PairPose,
    pub(super) shapes: [TriangleShape<'q>; 2],
    /// 0 if shape 1 is the larger one or a height field, else 1.
    pub(super) larger: usize,
    /// Distance up to which contacts must be local minima; infinite for contacts of each two
    /// triangles. Farther contacts belong to soft CCD and need not be minima, as bodies may turn
    /// before they meet.
    pub(super) filter_distance: f64,
    /// See [`reach`](Self::reach).
    pub(super) reach: OnceLock<Real>,
    /// Position of the other shape over each shape that is a [sheet](super::sides).
    pub(super) over_sheets: [OnceLock<Option<OverSheet>>; 2],
}

/// Position of the middle of a shape over the nearest point of a sheet.
#[derive(Copy, Clone)]
pub(super) struct OverSheet {
    /// Direction from the back of the sheet to the front, in frame 1.
    pub(super) front: DVec3,
    /// Height over the front.
    pub(super) height: f64,
    /// Height of the shape over its middle.
    pub(super) half_height: f64,
}

impl<'q> Index<usize> for TriangleShapes<'q> {
    type Output = TriangleShape<'q>;

    /// Returns shape 1 (0) or 2 (1).
    #[inline(always)]
    fn index(&self, i: usize) -> &TriangleShape<'q> {
        &self.shapes[i]
    }
}

impl TriangleShapes<'_> {
    /// Returns two triangles in frame 1, relative to a corner: with all digits. `None` if one does
    /// not exist.
    #[inline(always)]
    pub(super) fn local(&self, [triangle1, triangle2]: [u32; 2]) -> Option<TrianglePair> {
        let corners1 = self[0].corners(triangle1)?;
        Some(TrianglePair::new(&self.pose.placement12, corners1, self[1].corners(triangle2)?))
    }

    /// Returns true for contacts of surfaces.
    pub(super) fn has_surface(&self) -> bool {
        self.filter_distance < f64::INFINITY
    }

    /// Returns the normal cones that contacts of two triangles obey: none for contacts of surfaces.
    #[inline(always)]
    pub(super) fn cones(&self, triangles: [u32; 2]) -> [Option<TrianglePseudoNormals>; 2] {
        if self.has_surface() {
            return [None, None];
        }
        [0, 1].map(|i| self[i].cone(triangles[i]))
    }

    /// Returns the body whose motion limits how long candidates serve: the smaller one.
    pub(super) fn moving(&self) -> Moving {
        let smaller = 1 - self.larger;
        let body = MovingBody { ball: self[smaller].ball(), is_ball: false };
        Moving { body, shape: smaller }
    }

    /// Returns a lower bound of the distance between two meshes, from the ball around the smaller
    /// one, if that is more than `margin`.
    pub(super) fn clearance(&self, margin: Real) -> Option<Real> {
        let [larger, _] = [self[self.larger].mesh()?, self[1 - self.larger].mesh()?];
        let Sphere { centre, radius } = self.moving().body.ball;
        let placed = self.pose.in_other(1 - self.larger, centre);
        let offset = self.pose.pos12.translation.abs().max_element();
        let size = larger.magnitude() + centre.abs().max_element() + radius + offset;
        let reach = radius + gamma(64) * size;
        let clearance = larger.distance_beyond(placed, reach + margin)? - reach;
        (clearance > margin && clearance.is_finite()).then_some(clearance)
    }

    /// Returns the unit of the filter: the prediction distance, or less for small shapes.
    pub(super) fn filter_unit(&self) -> f64 {
        filter_unit(self.pose, self.filter_distance)
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
    /// A contact of two triangles.
    pub(super) fn of_triangles(contact: TriangleContact) -> Self {
        Self { contact, source: ContactSource::Triangles }
    }

    /// Returns a contact that pushes shapes apart along a normal, at points that belong to no
    /// feature.
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

/// Returns the contact of two triangles within a distance. `hint` has the features to be tried
/// first.
#[inline(always)]
pub(super) fn contact_of(
    TrianglePair { corners: [t1, t2], .. }: &TrianglePair,
    within: f64,
    hint: Hint,
) -> Option<TriangleContact> {
    match hint {
        Some(features) => contact_from(t1, t2, within, features),
        None => contact(t1, t2, within),
    }
}

/// A shape made of triangles, as a pair has it.
#[derive(Copy, Clone)]
pub(crate) enum ShapeView<'a> {
    Mesh(MeshView<'a>),
    Field(Field<'a>),
}

/// A shape made of triangles, with what a query knows of it.
pub(crate) struct TriangleShape<'q> {
    pub(super) view: &'q ShapeView<'q>,
    /// Surface of a mesh, for contacts of surfaces.
    pub(super) surface: Option<LazySurface<'q>>,
    /// Tree of a mesh, for another mesh.
    pub(super) tree: Option<&'q Tree>,
    pub(super) room: Room,
    /// Side of the ground of a height field, for contacts of surfaces.
    pub(super) side: Option<Side>,
}

/// Tells if a mesh is a room for the other shape, and has no inside.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(crate) enum Room {
    #[default]
    No,
    /// Faces lead away from the room. They collide on both sides, as what stands in the room has
    /// faces of its own.
    FacingOut,
    /// Faces lead into the room, so the body is behind them.
    FacingIn,
}

impl<'q> TriangleShape<'q> {
    /// Returns a mesh; `None` for a height field.
    pub(super) fn mesh(&self) -> Option<&'q MeshView<'q>> {
        if let ShapeView::Mesh(mesh) = self.view { Some(mesh) } else { None }
    }

    /// Returns the corners of a triangle; `None` if it does not exist.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: u32) -> Option<[Vector; 3]> {
        match self.view {
            ShapeView::Mesh(mesh) => Some(mesh.corners(triangle)),
            ShapeView::Field(field) => {
                let Triangle { a, b, c } = field.triangle(triangle)?;
                Some([a, b, c])
            }
        }
    }

    /// Returns the normal cone of a triangle.
    fn cone(&self, triangle: u32) -> Option<TrianglePseudoNormals> {
        match self.view {
            ShapeView::Mesh(mesh) => mesh.mesh.triangle_normal_constraints(triangle),
            ShapeView::Field(field) => field.0.triangle_normal_constraints(triangle),
        }
    }

    /// Returns the surface around a triangle, for contacts of surfaces.
    #[inline]
    pub(super) fn around(&self, triangle: u32) -> Option<Around<ShapeFacets<'_>>> {
        match self.view {
            ShapeView::Mesh(_) => {
                let Around { facets, side } = self.surface.as_ref()?.around(triangle);
                let side = match (self.room, side) {
                    (Room::FacingOut, _) => Side::Sheet,
                    (Room::FacingIn, Side::Turned) => Side::Outer,
                    _ => side,
                };
                Some(Around { facets: ShapeFacets::Mesh(facets), side })
            }
            ShapeView::Field(field) => {
                Some(Around { facets: ShapeFacets::Field(*field), side: self.side? })
            }
        }
    }

    /// Returns the sign with which most normals of the shape lead out of it.
    pub(super) fn outward(&self) -> f64 {
        let is_inside_out = |surface: &LazySurface<'_>| surface.kind() == SurfaceKind::InsideOut;
        let is_turned = self.room == Room::No && self.surface.as_ref().is_some_and(is_inside_out);
        if is_turned { -1.0 } else { 1.0 }
    }

    /// Returns true if the winding of a triangle tells the front of a sheet.
    pub(super) fn has_front(&self, triangle: u32) -> bool {
        self.surface.as_ref().is_none_or(|surface| surface.facets().has_front(triangle))
    }

    /// Returns true if the shape has an inside. Only contacts of surfaces ask for it.
    pub(super) fn is_solid(&self) -> bool {
        match &self.surface {
            Some(surface) => self.room == Room::No && surface.kind() != SurfaceKind::Sheet,
            None => self.side == Some(Side::Outer),
        }
    }

    /// Returns the box around the shape, in its frame.
    #[inline]
    pub(super) fn bounds(&self) -> Aabb {
        match self.view {
            ShapeView::Mesh(mesh) => *mesh.root(),
            ShapeView::Field(field) => *field.0.root_aabb(),
        }
    }

    /// Returns a ball around a mesh; an infinite one for a height field.
    pub(super) fn ball(&self) -> Sphere {
        let infinite = Sphere { centre: Vector::ZERO, radius: Real::INFINITY };
        self.mesh().map_or(infinite, MeshView::ball)
    }

    /// Returns the square of half the diagonal of the box around a mesh. A height field counts as
    /// larger than any.
    pub(super) fn size_squared(&self) -> Real {
        self.mesh().map_or(Real::INFINITY, MeshView::size_squared)
    }

    /// Returns the length of a triangle's side, if equal triangles cover the box around the shape.
    pub(super) fn triangle_size(&self) -> Real {
        let count = match self.view {
            ShapeView::Mesh(mesh) => mesh.mesh.indices().len(),
            ShapeView::Field(field) => field.triangle_count(),
        };
        let Vector { x, y, z } = self.bounds().extents();
        let area = 2.0 * (x * y + y * z + z * x);
        (2.0 * area / count as Real).sqrt()
    }

    /// Returns the height of a mesh over the middle of its box along a unit direction; 0 for a
    /// height field.
    pub(super) fn height(&self, direction: Vector) -> Real {
        self.mesh().map_or(0.0, |mesh| mesh.height(direction, 0.0))
    }

    /// Returns the nearest point of the surface, and the cosine between the direction to the point
    /// and the inward normal.
    pub(super) fn nearest(&self, point: Vector) -> Option<(Vector, Real)> {
        match self.view {
            ShapeView::Mesh(_) => {
                let (_, nearest, behind) = self.surface.as_ref()?.nearest(point)?;
                Some((nearest, behind))
            }
            ShapeView::Field(field) => field.nearest(point),
        }
    }

    /// Returns the distance in which a ray from a point inside leaves the shape, and the outward
    /// normal there. `None` if the ray meets nothing, or first meets the front of a solid's
    /// triangle.
    pub(super) fn exit(&self, ray: &Ray, is_two_way: bool) -> Option<(Real, Vector)> {
        let outward = (!is_two_way).then(|| self.outward());
        match self.view {
            ShapeView::Mesh(mesh) => mesh.exit(ray, outward),
            ShapeView::Field(field) => {
                // A ray leaves a field once at most.
                let hit = field.0.cast_local_ray_and_get_normal(ray, Real::MAX, false);
                let exit = hit.filter(|hit| leaves(hit, outward))?;
                Some((exit.time_of_impact, -exit.normal))
            }
        }
    }

    /// Returns true if a solid ends within a length along a ray that starts in it. The ground below
    /// a height field has no end.
    pub(super) fn ends_within(&self, [start, direction]: [DVec3; 2], length: f64) -> bool {
        let Some(MeshView { mesh, .. }) = self.mesh() else { return false };
        let ends = [start, start + length * direction].map(|end| end.as_vec3());
        // The box has all points of the ray, as rounding to f32 is monotonic up to one step.
        let segment = Aabb::from_points(ends)
            .loosened(Real::EPSILON * ends[0].abs().max(ends[1].abs()).max_element());
        let near = mesh.bvh().intersect_aabb(&segment);
        let corners =
            |triangle| mesh.triangle(triangle).vertices().map(|corner| corner.as_dvec3() - start);
        surface::ends_within(near.map(corners), direction, length, self.outward())
    }

    /// Returns true if a point may be in the body. Rays disagree on points of the surface. Sheets
    /// have the body behind them.
    pub(super) fn may_hold(&self, point: Vector) -> bool {
        let is_inside = |sign: i32| f64::from(sign) * self.outward() > 0.0;
        match &self.surface {
            Some(surface) if surface.kind() != SurfaceKind::Sheet => {
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

    /// Returns the first triangle that a ray meets within a length, the length, and the cosine of
    /// the angle with the normal.
    pub(super) fn first_met(&self, ray: &Ray, within: Real) -> Option<(u32, Real, Real)> {
        let (triangle, hit) = match self.view {
            ShapeView::Mesh(mesh) => first_hit(mesh.mesh, ray, within)?,
            ShapeView::Field(field) => {
                let hit = field.0.cast_local_ray_and_get_normal(ray, within, false)?;
                let place = ray.point_at(hit.time_of_impact);
                (field.nearest_triangle(place, within)?, hit)
            }
        };
        Some((triangle, hit.time_of_impact, -hit.normal.dot(ray.dir)))
    }

    /// Returns the nearest triangle to a point, if that is within a distance. The triangle of a
    /// height field may be another that is near.
    pub(super) fn nearest_triangle(&self, point: Vector, within: Real) -> Option<u32> {
        match self.view {
            ShapeView::Mesh(mesh) => {
                let nearest = CompositeShapeRef(mesh.mesh);
                Some(nearest.project_local_point(point, within, false)?.0)
            }
            ShapeView::Field(field) => field.nearest_triangle(point, within),
        }
    }
}

/// The triangles of a shape.
pub(super) enum ShapeFacets<'a> {
    Mesh(MeshFacets<'a>),
    Field(Field<'a>),
}

/// Calls the triangles of either kind of shape.
macro_rules! either {
    ($facets:expr, $of:ident => $call:expr) => {
        match $facets {
            ShapeFacets::Mesh($of) => $call,
            ShapeFacets::Field($of) => $call,
        }
    };
}

impl Facets for ShapeFacets<'_> {
    #[inline]
    fn twin(&self, half_edge: u32) -> Option<u32> {
        either!(self, of => of.twin(half_edge))
    }

    #[inline(always)]
    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        either!(self, of => of.corner(half_edge, i))
    }

    #[inline]
    fn is_whole(&self, triangle: u32, feature: Feature) -> bool {
        either!(self, of => of.is_whole(triangle, feature))
    }

    fn near(&self, corners: [DVec3; 2], visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        either!(self, of => of.near(corners, visit))
    }

    fn outward(&self, triangle: u32) -> f64 {
        either!(self, of => of.outward(triangle))
    }

    #[inline]
    fn cones(&self, triangle: u32) -> MinimumCones {
        either!(self, of => of.cones(triangle))
    }

    fn memo(&self) -> Option<&PlaceMemo> {
        either!(self, of => of.memo())
    }
}
