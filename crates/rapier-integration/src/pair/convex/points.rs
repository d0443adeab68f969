//! The contact points of a triangle and a convex shape, with the features that Parry names.

use std::sync::LazyLock;

use arrayvec::ArrayVec;
use glamx::{DVec3, Vec3};
use parry3d::math::{Real, Vector};
use parry3d::shape::{
    ConvexPolyhedron, Cuboid, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, Triangle,
    TypedShape,
};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::{ConvexContact, FeaturePoint, FeaturePoints, clip_feature};
use sbbk_core::surface::area_vector;
use sbbk_core::volumes::rounding::gamma;

use super::contact::{NormalSource, PartContact};
use super::ghosts::ROUNDED;
use super::shape::ConvexShape;
use crate::pair::tuning::ALONG_BORDER;

/// A contact point in the frame of the shape, without the rounding radius.
pub(super) struct PointPair {
    pub(super) on_triangle: DVec3,
    pub(super) on_shape: DVec3,
    pub(super) distance: f64,
    /// Features of the triangle and the shape.
    pub(super) features: [PackedFeatureId; 2],
}

/// Features of closest points.
const UNNAMED: [PackedFeatureId; 2] = [PackedFeatureId::UNKNOWN; 2];

/// Calls `found` with the contact points of a triangle and a shape with polygonal features. These
/// are closest points, points of a rim, and corners of the overlap of the triangle and the facing
/// feature.
///
/// `normal` replaces the normal of the contact where normal cones have turned it. `equal_depth` is
/// the difference up to which points count as equally deep.
pub(super) fn contact_points(
    corners: &[DVec3; 3],
    shape: ConvexShape<'_>,
    contact: &PartContact,
    normal: Option<DVec3>,
    equal_depth: f64,
    mut found: impl FnMut(PointPair),
) {
    let ConvexContact { distance, on_triangle, on_shape, .. } = contact.contact;
    let closest = PointPair { on_triangle, on_shape, distance, features: UNNAMED };
    if contact.source == NormalSource::PushOut {
        return found(closest);
    }
    let is_neighbours = contact.source == NormalSource::Neighbour;
    let is_own = !is_neighbours && normal.is_none();
    let normal = normal.unwrap_or(contact.contact.normal);
    let facing = match shape {
        // The nearest point of a round side is ahead of the lowest one.
        ConvexShape::Features { map, .. } if contact.source == NormalSource::Border => {
            map.local_support_point(-normal.as_vec3())
        }
        _ => on_shape.as_vec3(),
    };
    let (feature, has_rim) = facing_feature(shape, -normal.as_vec3(), facing);
    let polygon = &feature.vertices.map(|corner| corner.as_dvec3())[..feature.num_vertices];
    if let (NormalSource::Border, Feature::Edge(i), [p, q]) =
        (contact.source, contact.feature, polygon)
    {
        let edge = [corners[usize::from(i)], corners[usize::from(i + 1) % 3]];
        return border_points(edge, [*p, *q], &contact.contact, normal, found);
    }
    let has_closest =
        overlap_points(corners, (&feature, polygon), contact, normal, is_own, &mut found);
    if has_rim && let ConvexShape::Features { map, .. } = shape {
        rim_points(corners, map, on_shape, normal, polygon, equal_depth).for_each(&mut found);
    }
    // A rim may touch beside the corners of its feature, which for a disc is a square.
    let is_cuboid = matches!(shape, ConvexShape::Cuboid(_));
    if is_own && (has_rim || !has_closest) {
        found(closest);
    } else if is_neighbours && !is_cuboid {
        on_face(corners, on_shape, normal).into_iter().for_each(found);
    }
}

/// Calls `found` with the corners of the overlap of a triangle and a feature. Returns true if one
/// is as near as the closest points. No corner is nearer than the closest points if the normal is
/// theirs (`is_own`).
#[inline(always)]
fn overlap_points(
    corners: &[DVec3; 3],
    (feature, polygon): (&PolygonalFeature, &[DVec3]),
    PartContact { contact, source, .. }: &PartContact,
    normal: DVec3,
    is_own: bool,
    mut found: impl FnMut(PointPair),
) -> bool {
    let mut points = FeaturePoints::new();
    clip_feature(corners, polygon, normal, &mut points);
    // Features of curved shapes are rounded to f32, and edges of a hull are nearly faces. Points
    // nearer than the closest ones, or beyond the support point, are not on the shape.
    let size = polygon.iter().fold(0.0, |size: f64, x| size.max(x.abs().max_element()));
    let slack = f64::from(gamma(64)) * size;
    let is_neighbours = *source == NormalSource::Neighbour;
    let mut has_closest = false;
    for point in &points {
        let beyond = normal.dot(contact.on_shape - point.on_shape);
        if is_own && point.distance < contact.distance - slack || is_neighbours && beyond > slack {
            continue;
        }
        has_closest |= point.distance <= contact.distance + ROUNDED * size;
        let distance = if is_own { point.distance.max(contact.distance) } else { point.distance };
        found(PointPair { distance, ..named(point, feature) });
    }
    has_closest
}

/// Calls `found` with the ends of the part of a shape's edge that is along a border. The nearest
/// points alone would turn a rod that rolls from mesh to mesh. `normal`: of the face at the border.
fn border_points(
    [a, b]: [DVec3; 2],
    [p, q]: [DVec3; 2],
    &ConvexContact { distance, on_triangle, .. }: &ConvexContact,
    normal: DVec3,
    mut found: impl FnMut(PointPair),
) {
    let (border, way) = (b - a, q - p);
    let at = |share: f64| p + share * way;
    let share_of = |point: DVec3| ((point - p).dot(way) / way.length_squared()).clamp(0.0, 1.0);
    let foot = |point: DVec3| {
        let share = (point - a).dot(border) / border.length_squared();
        a + share.clamp(0.0, 1.0) * border
    };
    let middle = share_of(on_triangle);
    let from_border = |share: f64| (at(share) - foot(at(share))).length();
    let least = from_border(middle);
    for (name, end) in [(1, share_of(a)), (2, share_of(b))] {
        let excess = from_border(end) - least;
        let part = if excess > 0.0 { (ALONG_BORDER * least / excess).min(1.0) } else { 1.0 };
        let end = middle + part * (end - middle);
        let on_shape = at(end);
        let distance = distance + normal.dot(on_shape - at(middle));
        let on_triangle = on_shape - distance * normal;
        let features = [PackedFeatureId::UNKNOWN, PackedFeatureId(name)];
        found(PointPair { on_triangle, on_shape, distance, features });
    }
}

/// Returns the points of a rim beside a contact, one on either side. A body on one point of a round
/// rim would roll to another in each step, and never rest. `polygon` has corners of the face that
/// touches.
///
/// A tilt moves a point by its lever. So a tilt first reaches the point with the greatest lever for
/// its distance and `equal_depth`. On a circle that point is the nearest one after the tilt below.
fn rim_points(
    corners: &[DVec3; 3],
    map: &dyn PolygonalFeatureMap,
    on_shape: DVec3,
    normal: DVec3,
    polygon: &[DVec3],
    equal_depth: f64,
) -> impl Iterator<Item = PointPair> {
    let face = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    let slope = face.cross(normal).length() / face.length();
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let across = normal.cross(middle - on_shape);
    let share = equal_depth / across.length();
    let tilt = (share * (share + 2.0 * slope)).sqrt() * across.normalize();
    [(1, tilt), (2, -tilt)].into_iter().filter_map(move |(name, tilt)| {
        let beside = map.local_support_point((tilt - normal).as_vec3()).as_dvec3();
        let is_new = beside.is_finite() && !polygon.contains(&beside) && beside != on_shape;
        let point = is_new.then(|| on_face(corners, beside, normal)).flatten()?;
        Some(PointPair { features: [PackedFeatureId::UNKNOWN, PackedFeatureId(name)], ..point })
    })
}

/// Names the features of a point. `of_shape` is the clipped feature of the shape.
fn named(point: &FeaturePoint, of_shape: &PolygonalFeature) -> PointPair {
    let FeaturePoint { on_triangle, on_shape, distance, features: [one, two], .. } = *point;
    let features = [feature_id(&TRIANGLE, one), feature_id(of_shape, two)];
    PointPair { on_triangle, on_shape, distance, features }
}

fn feature_id(polygon: &PolygonalFeature, feature: Feature) -> PackedFeatureId {
    match feature {
        Feature::Vertex(i) => polygon.vids[usize::from(i)],
        Feature::Edge(i) => polygon.eids[usize::from(i)],
        Feature::Face => polygon.fid,
    }
}

/// Returns a point of the shape with the point of the triangle along a normal; `None` beside the
/// triangle.
fn on_face(corners: &[DVec3; 3], on_shape: DVec3, normal: DVec3) -> Option<PointPair> {
    let (face, features) = (area_vector(corners), UNNAMED);
    let distance = (on_shape - corners[0]).dot(face) / normal.dot(face);
    let on_triangle = on_shape - normal * distance;
    let point = PointPair { on_triangle, on_shape, distance, features };
    is_over(corners, on_triangle, 0.0).then_some(point)
}

/// Returns true if a point is over a triangle, seen along the normal of the triangle. Barycentric
/// coordinates may be as far below zero as `slack`.
pub(super) fn is_over(corners @ [a, b, c]: &[DVec3; 3], point: DVec3, slack: f64) -> bool {
    let face = area_vector(corners);
    let least = -slack * face.length_squared();
    let is_beside = |from: &DVec3, to: &DVec3| (to - from).cross(point - from).dot(face) >= least;
    is_beside(a, b) && is_beside(b, c) && is_beside(c, a)
}

/// Any triangle, for the ids of its features. Stored: Parry's constructor takes longer than the
/// clip.
static TRIANGLE: LazyLock<PolygonalFeature> =
    LazyLock::new(|| Triangle::new(Vector::X, Vector::Y, Vector::Z).into());

/// Angle at the centre of a ball by which a ray may miss a triangle and still hit. A ray at an edge
/// must not miss both triangles because of rounding.
const RAY_SLACK: f64 = 1.0e-6;

/// Returns the length of a ray from the origin along a unit vector to a triangle, if it hits.
///
/// Parry's balls touch there when a normal cone has turned the normal.
pub(super) fn ray_length(corners: &[DVec3; 3], direction: DVec3) -> Option<f64> {
    let ([a, b, c], normal) = (*corners, area_vector(corners));
    let length = a.dot(normal) / direction.dot(normal);
    let beside = |v: DVec3, w: DVec3| {
        let slack = RAY_SLACK * v.length() * w.length();
        let volume = v.cross(w).dot(direction);
        [volume >= -slack, volume <= slack]
    };
    let sides = [beside(a, b), beside(b, c), beside(c, a)];
    let is_hit = (0..2).any(|sign| sides.iter().all(|side| side[sign]));
    // Rounding may put a centre on the triangle behind it.
    let size = a.length() + b.length() + c.length();
    (is_hit && length >= -RAY_SLACK * size && length.is_finite()).then_some(length)
}

/// Stored: Parry's constructor is not inlined.
pub(super) static FACE: LazyLock<PackedFeatureId> = LazyLock::new(|| PackedFeatureId::face(0));

/// Returns the feature of a shape that faces a direction at a point, and true if it is part of a
/// face with more corners.
pub(super) fn facing_feature(
    shape: ConvexShape<'_>,
    direction: Vec3,
    point: Vec3,
) -> (PolygonalFeature, bool) {
    let mut feature = PolygonalFeature::default();
    match shape {
        ConvexShape::Cuboid(cuboid) => {
            feature = CUBE_FACES[face_toward(direction)].clone();
            feature.vertices = feature.vertices.map(|corner| corner * cuboid.half_extents);
        }
        ConvexShape::Features { core: TypedShape::ConvexPolyhedron(hull), .. } => {
            return facing_face(hull, direction, point);
        }
        ConvexShape::Features { core, map, .. } => {
            map.local_support_feature_toward(direction, point, &mut feature);
            // Cylinders and cones have discs as caps.
            let is_round = matches!(core, TypedShape::Cylinder(_) | TypedShape::Cone(_));
            let is_cap = feature.num_vertices == 4 && is_round;
            return (feature, is_cap);
        }
        ConvexShape::Ball(_) | ConvexShape::HalfSpace(_) => {}
    }
    (feature, false)
}

/// Returns the face of a polyhedron that faces a direction, and true if it has more corners than
/// those returned. Up to four corners are returned, which are [far apart](spread).
fn facing_face(hull: &ConvexPolyhedron, direction: Vec3, point: Vec3) -> (PolygonalFeature, bool) {
    let faces = hull.faces();
    let heights = faces.iter().map(|face| face.normal.dot(direction)).enumerate();
    // The first of equal ones, as in Parry.
    let (facing, _) = heights
        .fold((0, Real::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    let first = faces[facing].first_vertex_or_edge as usize;
    let range = first..first + faces[facing].num_vertices_or_edges as usize;
    let vertices = &hull.vertices_adj_to_face()[range.clone()];
    let edges = &hull.edges_adj_to_face()[range];
    let corner = |i: usize| hull.points()[vertices[i] as usize];
    let corners = spread(vertices.len(), corner, faces[facing].normal, point);
    let (num_vertices, fid) = (corners.len(), PackedFeatureId::face(facing as u32));
    let mut feature = PolygonalFeature { num_vertices, fid, ..Default::default() };
    for (to, from) in corners.into_iter().enumerate() {
        feature.vertices[to] = corner(from);
        feature.vids[to] = PackedFeatureId::vertex(vertices[from]);
        feature.eids[to] = PackedFeatureId::edge(edges[from]);
    }
    (feature, vertices.len() > num_vertices)
}

/// Returns all of up to four corners of a polygon. Else returns the corner nearest to a point, the
/// farthest from that one, and the farthest on either side of both. Parry takes the first four,
/// which may all be at one end.
fn spread(
    count: usize,
    corner: impl Fn(usize) -> Vec3,
    normal: Vec3,
    point: Vec3,
) -> ArrayVec<usize, 4> {
    if count <= 4 {
        return (0..count).collect();
    }
    let farthest = |height: &dyn Fn(Vec3) -> Real| {
        let heights = (0..count).map(|i| (i, height(corner(i))));
        heights.max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(i, _)| i)
    };
    let near = farthest(&|corner| -corner.distance_squared(point));
    let far = farthest(&|to| to.distance_squared(corner(near)));
    let aside = normal.cross(corner(far) - corner(near));
    let [one, other] = [aside, -aside].map(|aside| farthest(&|corner| corner.dot(aside)));
    let mut corners = [near, far, one, other];
    corners.sort_unstable();
    // All corners may be on one side.
    corners.chunk_by(PartialEq::eq).map(|equal| equal[0]).collect()
}

/// The faces of a cube with half lengths of 1, by [`face_toward`].
static CUBE_FACES: LazyLock<[PolygonalFeature; 6]> = LazyLock::new(|| {
    let axes = [Vector::X, Vector::Y, Vector::Z];
    std::array::from_fn(|i| {
        let outward = if i < 3 { axes[i] } else { -axes[i - 3] };
        Cuboid::new(Vector::ONE).support_face(outward)
    })
});

/// Returns the index of the cuboid's face that is farthest along a direction.
fn face_toward(direction: Vector) -> usize {
    let axis = direction.abs().max_position();
    if direction[axis] < 0.0 { axis + 3 } else { axis }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{PI, TAU};

    use super::*;

    /// Would catch corners at one end of a face, and a face without the corner that touches.
    #[test]
    fn a_face_of_many_corners_has_four_far_apart() {
        let around = |i: u32, height: Real| {
            let (sin, cos) = (TAU * i as Real / 24.0).sin_cos();
            Vec3::new(cos, height, sin)
        };
        let points: Vec<Vec3> = (0..24).flat_map(|i| [around(i, -1.0), around(i, 1.0)]).collect();
        let drum = ConvexPolyhedron::from_convex_hull(&points).unwrap();
        for i in 0..24 {
            let touching = around(i, -1.0);
            let (face, has_more) = facing_face(&drum, Vec3::new(0.01, -1.0, 0.02), touching);
            assert!(
                has_more && face.num_vertices == 4 && face.vertices.contains(&touching),
                "{face:?}"
            );
            let apart = (0..4).map(|j| face.vertices[j].distance(face.vertices[(j + 1) % 4]));
            assert!(apart.fold(2.0, Real::min) > 1.3, "{face:?}");
            let (side, has_more) = facing_face(&drum, around(2 * i + 1, 0.0).with_y(0.0), touching);
            assert!(!has_more && side.num_vertices <= 4, "{side:?}");
        }
    }

    /// The point is at one end of the flat side of a half disc. Would catch a corner that comes
    /// twice.
    #[test]
    fn corners_far_apart_are_unlike_if_all_are_on_one_side() {
        let corner = |i: usize| {
            let (sin, cos) = (PI * i as Real / 12.0).sin_cos();
            Vec3::new(cos, sin, 0.0)
        };
        let corners = spread(13, corner, Vec3::Z, Vec3::X);
        assert_eq!(corners[..], [0, 6, 12]);
    }
}
