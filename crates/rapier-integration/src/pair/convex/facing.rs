//! The feature of a convex shape that faces a triangle.

use std::sync::LazyLock;

use arrayvec::ArrayVec;
use glamx::Vec3;
use parry3d::math::{Real, Vector};
use parry3d::shape::{ConvexPolyhedron, Cuboid, PackedFeatureId, PolygonalFeature, ShapeType};

use super::shape::ConvexShape;

/// Returns the feature of a shape that faces a direction at a point, and true if it is part of a face with more corners.
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
        ConvexShape::Features { shape: of, map, .. } => {
            if let Some(hull) = shape.polyhedron() {
                return facing_face(hull, direction, point);
            }
            map.local_support_feature_toward(direction, point, &mut feature);
            let is_cap = feature.num_vertices == 4 && is_round(of.shape_type());
            return (feature, is_cap);
        }
        ConvexShape::Ball(_) | ConvexShape::HalfSpace(_) => {}
    }
    (feature, false)
}

/// True for shapes whose caps are discs.
fn is_round(shape: ShapeType) -> bool {
    use ShapeType::{Cone, Cylinder, RoundCone, RoundCylinder};
    matches!(shape, Cone | Cylinder | RoundCone | RoundCylinder)
}

/// Returns the face of a polyhedron that faces a direction, and true if it has more corners than those returned. Up to four corners
/// are returned, which are [far apart](spread).
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

/// Returns all of up to four corners of a polygon. Else returns the corner nearest to a point, the farthest from that one, and the
/// farthest on either side of both. Parry takes the first four, which may all be at one end.
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

    /// The point is at one end of the flat side of a half disc. Would catch a corner that comes twice.
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
