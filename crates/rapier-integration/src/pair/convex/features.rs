//! The contact of a triangle and a convex shape, exact at every scale: its distance, normal and
//! closest points, and for shapes with polygonal features the other points, are those of
//! [`sbbk_core::contact::convex`]; the features are Parry's.

use std::sync::{LazyLock, OnceLock};

use glamx::DVec3;
use parry3d::math::{Pose, Vector};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::shape::{
    Cone, ConvexPolyhedron, Cuboid, Cylinder, PackedFeatureId, PolygonalFeature, Segment, Shape,
    Triangle, TypedShape,
};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::{
    ConeSupport, ConvexContact, CuboidSupport, CylinderSupport, FeaturePoint, FeaturePoints,
    HullPoints, PointSupport, SegmentSupport, SupportMap, TriangleSupport, clip_feature,
    convex_contact, convex_touches, half_space_contact,
};
use sbbk_core::volumes::rounding::gamma;

use super::shape::ConvexShape;
use super::touch::Along;

/// Contact of a triangle with a shape without its rounding radius, in the frame of the shape. `hull`
/// keeps the points of a convex polyhedron from call to call.
pub(crate) fn core_contact(
    triangle: &[DVec3; 3],
    shape: ConvexShape<'_>,
    hull: &OnceLock<HullPoints>,
    margin: f64,
) -> Option<ConvexContact> {
    if let ConvexShape::HalfSpace(half_space) = shape {
        return half_space_contact(triangle, half_space.normal.as_dvec3(), margin);
    }
    with_core(shape, hull, TriangleContact { triangle, margin })?
}

/// Support point of a shape without its rounding radius, in f64; `None` for a half-space.
pub(super) fn core_support(
    shape: ConvexShape<'_>,
    hull: &OnceLock<HullPoints>,
    direction: DVec3,
) -> Option<DVec3> {
    with_core(shape, hull, SupportPoint(direction))
}

/// A computation with the support map of a shape without its rounding radius.
trait OfCore {
    type Output;

    fn of<S: SupportMap>(self, core: &S) -> Self::Output;
}

struct TriangleContact<'a> {
    triangle: &'a [DVec3; 3],
    margin: f64,
}

impl OfCore for TriangleContact<'_> {
    type Output = Option<ConvexContact>;

    #[inline(always)]
    fn of<S: SupportMap>(self, core: &S) -> Option<ConvexContact> {
        convex_contact(self.triangle, core, self.margin)
    }
}

struct SupportPoint(DVec3);

impl OfCore for SupportPoint {
    type Output = DVec3;

    #[inline(always)]
    fn of<S: SupportMap>(self, core: &S) -> DVec3 {
        core.support(self.0)
    }
}

/// That of a ball.
#[inline(always)]
pub(super) fn ball_contact(triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
    convex_contact(triangle, &PointSupport(DVec3::ZERO), margin)
}

/// Whether a triangle is at most `reach` from a shape without its radius, or crosses it.
pub(super) fn core_touches(
    triangle: &[DVec3; 3],
    shape: ConvexShape<'_>,
    hull: &OnceLock<HullPoints>,
    reach: f64,
) -> bool {
    // How deep hulls cross takes longer to find than that they do, and their faces are not needed.
    if let ConvexShape::Features { shape, .. } = shape
        && let Some(shape) = polyhedron(shape)
    {
        let points = hull.get_or_init(|| HullPoints::without_faces(shape.points().iter().copied()));
        return convex_touches(triangle, points, reach);
    }
    core_contact(triangle, shape, hull, reach).is_some()
}

fn polyhedron(shape: &dyn Shape) -> Option<&ConvexPolyhedron> {
    let round = || shape.as_round_convex_polyhedron().map(|shape| &shape.inner_shape);
    shape.as_convex_polyhedron().or_else(round)
}

/// `None` for a half-space.
#[inline(always)]
fn with_core<C: OfCore>(
    shape: ConvexShape<'_>,
    hull: &OnceLock<HullPoints>,
    compute: C,
) -> Option<C::Output> {
    let shape = match shape {
        ConvexShape::Ball(_) => return Some(compute.of(&PointSupport(DVec3::ZERO))),
        ConvexShape::HalfSpace(_) => return None,
        ConvexShape::Cuboid(cuboid) => return Some(compute.of(&cuboid_support(cuboid))),
        ConvexShape::Features { shape, .. } => shape,
    };
    let hull_of = |shape: &ConvexPolyhedron| hull.get_or_init(|| hull_points(shape));
    Some(match shape.as_typed_shape() {
        TypedShape::Segment(shape) => compute.of(&segment_support(shape)),
        TypedShape::Capsule(shape) => compute.of(&segment_support(&shape.segment)),
        TypedShape::Triangle(shape) => compute.of(&triangle_support(shape)),
        TypedShape::RoundTriangle(shape) => compute.of(&triangle_support(&shape.inner_shape)),
        TypedShape::Cylinder(shape) => compute.of(&cylinder_support(shape)),
        TypedShape::RoundCylinder(shape) => compute.of(&cylinder_support(&shape.inner_shape)),
        TypedShape::Cone(shape) => compute.of(&cone_support(shape)),
        TypedShape::RoundCone(shape) => compute.of(&cone_support(&shape.inner_shape)),
        TypedShape::RoundCuboid(shape) => compute.of(&cuboid_support(&shape.inner_shape)),
        TypedShape::ConvexPolyhedron(shape) => compute.of(hull_of(shape)),
        TypedShape::RoundConvexPolyhedron(shape) => compute.of(hull_of(&shape.inner_shape)),
        _ => return None,
    })
}

fn segment_support(segment: &Segment) -> SegmentSupport {
    SegmentSupport([segment.a, segment.b].map(|end| end.as_dvec3()))
}

fn triangle_support(triangle: &Triangle) -> TriangleSupport {
    TriangleSupport(triangle.vertices().map(|corner| corner.as_dvec3()))
}

fn cuboid_support(cuboid: &Cuboid) -> CuboidSupport {
    CuboidSupport(cuboid.half_extents.as_dvec3())
}

fn cylinder_support(cylinder: &Cylinder) -> CylinderSupport {
    let [half_height, radius] = [cylinder.half_height, cylinder.radius].map(f64::from);
    CylinderSupport { half_height, radius }
}

fn cone_support(cone: &Cone) -> ConeSupport {
    let [half_height, radius] = [cone.half_height, cone.radius].map(f64::from);
    ConeSupport { half_height, radius }
}

/// Points of a hull whose depth is found by search, where a few triangles cross it.
pub(super) fn searched_hull(shape: ConvexShape<'_>) -> Option<HullPoints> {
    let ConvexShape::Features { shape, .. } = shape else { return None };
    polyhedron(shape).map(|shape| HullPoints::without_faces(shape.points().iter().copied()))
}

fn hull_points(shape: &ConvexPolyhedron) -> HullPoints {
    let corners = shape.vertices_adj_to_face();
    let fans = shape.faces().iter().flat_map(|face| {
        let start = face.first_vertex_or_edge as usize;
        let corners = &corners[start..start + face.num_vertices_or_edges as usize];
        let (first, rest) = corners.split_first().unwrap_or((&0, &[]));
        rest.windows(2).map(|ends| [*first, ends[0], ends[1]])
    });
    HullPoints::with_faces(shape.points().iter().copied(), fans)
}

/// The normals of a contact, in the order of the pair.
pub(super) struct Normals {
    /// Unit vectors from each body to the other, in its frame.
    pub(super) normals: [Vector; 2],
    /// Whether the cones have turned them.
    pub(super) are_turned: bool,
}

impl Normals {
    /// Turned into the cones of both bodies. None where these reject the contact.
    #[inline]
    pub(super) fn new(
        pos12: &Pose,
        free: [Vector; 2],
        cones: [Option<&dyn NormalConstraints>; 2],
    ) -> Option<Self> {
        let [mut normal1, mut normal2] = free;
        if cones.iter().all(Option::is_none) {
            return Some(Self { normals: free, are_turned: false });
        }
        if !(cones[0], cones[1]).project_local_normals(pos12, &mut normal1, &mut normal2) {
            return None;
        }
        // Parry makes one normal of the other, with its roundings: that is no turn.
        let normals = [normal1, normal2];
        let are_turned = (0..2).any(|i| cones[i].is_some() && normals[i] != free[i]);
        Some(Self { normals: if are_turned { normals } else { free }, are_turned })
    }
}

/// A triangle and a shape with features that touch, in the frame of the shape.
pub(super) struct Touching<'a> {
    pub(super) corners: &'a [DVec3; 3],
    pub(super) shape: ConvexShape<'a>,
    pub(super) contact: &'a ConvexContact,
    pub(super) along: Along,
}

/// A point of a manifold, radii not counted.
pub(super) struct Point {
    pub(super) on_triangle: DVec3,
    pub(super) on_shape: DVec3,
    pub(super) distance: f64,
    /// Of the triangle and of the shape.
    pub(super) features: [PackedFeatureId; 2],
}

impl Touching<'_> {
    /// Hands on the points along a normal: the closest ones, and the corners of the overlap of the
    /// triangle and the feature that faces it.
    ///
    /// `turned` is the normal if cones have turned it, in the direction of the contact's.
    pub(super) fn points(&self, turned: Option<DVec3>, mut each: impl FnMut(Point)) {
        let Self { corners, shape, contact, along } = *self;
        let ConvexContact { distance, normal, on_triangle, on_shape } = *contact;
        let unnamed = [PackedFeatureId::UNKNOWN; 2];
        if along == Along::WayOut {
            return each(Point { on_triangle, on_shape, distance, features: unnamed });
        }
        let is_turned = along == Along::Other;
        let is_own = !is_turned && turned.is_none();
        let normal = turned.unwrap_or(normal);
        let toward = -normal.as_vec3();
        let mut feature = PolygonalFeature::default();
        // Closest points are wanted even if others are as near, but of a cuboid: another shape may
        // not touch at the corners of its features.
        let mut is_round = true;
        match shape {
            ConvexShape::Cuboid(cuboid) => {
                is_round = false;
                feature = FACES[face_toward(toward)].clone();
                feature.vertices = feature.vertices.map(|corner| corner * cuboid.half_extents);
            }
            ConvexShape::Features { map, .. } => {
                map.local_support_feature_toward(toward, on_shape.as_vec3(), &mut feature);
            }
            ConvexShape::Ball(_) | ConvexShape::HalfSpace(_) => {}
        }
        let polygon = feature.vertices.map(|corner| corner.as_dvec3());
        let mut points = FeaturePoints::new();
        clip_feature(corners, &polygon[..feature.num_vertices], normal, &mut points);
        // Features of curved shapes are rounded to f32, and edges of a hull are nearly faces: points
        // that are nearer than the closest ones by more than that, or beyond the farthest one along the
        // normal, are not on the shape.
        let size = polygon.iter().fold(0.0, |size: f64, x| size.max(x.abs().max_element()));
        let slack = f64::from(gamma(64)) * size;
        let mut has_closest = false;
        for point in &points {
            let beyond = normal.dot(contact.on_shape - point.on_shape);
            if is_own && point.distance < distance - slack || is_turned && beyond > slack {
                continue;
            }
            has_closest |= point.distance <= distance + slack;
            let distance = if is_own { point.distance.max(distance) } else { point.distance };
            let of_triangle = match point.features[0] {
                Feature::Vertex(i) => TRIANGLE.vids[usize::from(i)],
                Feature::Edge(i) => TRIANGLE.eids[usize::from(i)],
                Feature::Face => TRIANGLE.fid,
            };
            let of_shape = match point.features[1] {
                Feature::Vertex(i) => feature.vids[usize::from(i)],
                Feature::Edge(i) => feature.eids[usize::from(i)],
                Feature::Face => feature.fid,
            };
            let features = [of_triangle, of_shape];
            let FeaturePoint { on_triangle, on_shape, .. } = *point;
            each(Point { on_triangle, on_shape, distance, features });
        }
        if is_own && (is_round || !has_closest) {
            each(Point { on_triangle, on_shape, distance, features: unnamed });
        }
        // The farthest point of a shape may be beside its feature, if that is a square in place of a disc.
        if is_turned
            && is_round
            && let Some(distance) = height(corners, on_shape, normal)
        {
            let on_triangle = on_shape - normal * distance;
            each(Point { on_triangle, on_shape, distance, features: unnamed });
        }
    }
}

/// How far a point is from a triangle along a normal; `None` if it is not over it.
fn height(&[a, b, c]: &[DVec3; 3], point: DVec3, normal: DVec3) -> Option<f64> {
    let face = (b - a).cross(c - a);
    let height = (point - a).dot(face) / normal.dot(face);
    let foot = point - normal * height;
    let is_beside = |from: DVec3, to: DVec3| (to - from).cross(foot - from).dot(face) >= 0.0;
    (is_beside(a, b) && is_beside(b, c) && is_beside(c, a)).then_some(height)
}

/// A triangle, for the names of its features. Made once, as the faces of cuboids are: Parry's
/// constructors are not inlined and took more than the clip.
static TRIANGLE: LazyLock<PolygonalFeature> =
    LazyLock::new(|| Triangle::new(Vector::X, Vector::Y, Vector::Z).into());

/// The faces of a cuboid with half lengths of 1, by [`face_toward`].
static FACES: LazyLock<[PolygonalFeature; 6]> = LazyLock::new(|| {
    let axes = [Vector::X, Vector::Y, Vector::Z];
    std::array::from_fn(|i| {
        let outward = if i < 3 { axes[i] } else { -axes[i - 3] };
        Cuboid::new(Vector::ONE).support_face(outward)
    })
});

/// The number of the face of a cuboid that is farthest along a direction.
fn face_toward(direction: Vector) -> usize {
    let axis = direction.abs().max_position();
    if direction[axis] < 0.0 { axis + 3 } else { axis }
}
