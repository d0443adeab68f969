use super::shapes::{pose, shapes};
use crate::prelude::*;
use crate::proximity::Proximity;
use glamx::{DAffine3, DVec3};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::shape::Triangle;
use sbbk_testkit::truth::{affine, convex_body};
use sbbk_truth::ConvexBody;

/// Signed distance of a triangle with the mesh at a place in the frame of the body.
pub(super) fn truth_of(triangle: &Triangle, body: &ConvexBody, pose: DAffine3) -> f64 {
    let place = |corner: &Vec3| pose.transform_point3(corner.as_dvec3());
    body.distance(&triangle.vertices().each_ref().map(place))
}

/// The least signed distance of a triangle from a body in the box `around`. Triangles whose own
/// boxes are farther than the nearest triangle so far are left out.
pub(super) fn least_at(mesh: &TriMesh, body: &ConvexBody, around: &Aabb, pose: DAffine3) -> f64 {
    let [low, high] = [around.mins, around.maxs].map(|end| end.as_dvec3());
    // The box is rounded to f32.
    let slack = 1.0e-3 * (high - low).max_element();
    mesh.triangles().fold(f64::INFINITY, |least, triangle| {
        let [a, b, c] = triangle.vertices().map(|corner| pose.transform_point3(corner.as_dvec3()));
        let gap = (a.min(b).min(c) - high).max(low - a.max(b).max(c)).max(DVec3::ZERO);
        if gap.length() - slack > least { least } else { least.min(body.distance(&[a, b, c])) }
    })
}

/// Would catch a wrong order or frame, triangles left out by a bound, a missing radius, and errors
/// that grow with the size.
#[test]
fn as_brute_force_says_at_every_size() {
    let dispatcher = SbbkDispatcher::default();
    let mut stocks_wrong = 0;
    for size in [0.01, 0.1, 2.0, 40.0] {
        let mesh = shape(&mesh::monkey_head_with(6).centred().scaled_to(size));
        let tolerance = 2.0e-6 * f64::from(size);
        for (seed, (name, other)) in (0..).zip(shapes(0.5 * size)) {
            let body = convex_body(&*other);
            let mut random = Rand32::new(seed);
            for i in 0..6 {
                let mut in_mesh = pose(&mut random, &mesh, 0.5 * size);
                in_mesh.translation *= [1.0, 1.1, 1.5][i % 3];
                let is_mesh_first = i % 2 == 0;
                let question = Question::new(&mesh, &*other, in_mesh).flipped(!is_mesh_first);
                let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
                let in_body = affine(&in_mesh).inverse();
                let triangles = mesh.triangles();
                let distances: Vec<f64> =
                    triangles.map(|triangle| truth_of(&triangle, &body, in_body)).collect();
                let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
                let of_mesh = |[one, two]: [u32; 2]| {
                    let [triangle, part] = if is_mesh_first { [one, two] } else { [two, one] };
                    assert_eq!(part, 0, "{name}, {size}, {i}");
                    distances[triangle as usize]
                };
                let proximity = Proximity { question, least, of: &of_mesh, tolerance };
                let margin = (least.abs() * [0.9, 1.1][i / 3]) as Real;
                proximity.check(&dispatcher, margin, &format!("{name}, {size}, {i}"));
                let stock = DefaultQueryDispatcher.distance(&pos12, g1, g2).unwrap().distance;
                let is_right = (f64::from(stock) - least.max(0.0)).abs() <= tolerance;
                stocks_wrong += usize::from(!is_right);
            }
        }
    }
    assert!(stocks_wrong > 50, "{stocks_wrong}");
}

/// Would catch a plane that allows for no rounding of boxes. The middle of this box is rounded away
/// from the plane.
#[test]
fn a_corner_on_a_plane_touches_it() {
    let step = f32::EPSILON;
    let (low, high) = (1.0 + step, 2.0 + 2.0 * step);
    let corners =
        vec![Vec3::new(0.0, low, 0.0), Vec3::new(1.0, high, 0.0), Vec3::new(0.0, high, 1.0)];
    let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).unwrap();
    let plane = SharedShape::halfspace(Vec3::Y);
    let dispatcher = SbbkDispatcher::default();
    let down = Pose3::translation(0.0, -low, 0.0);
    assert!(dispatcher.intersection_test(&down, &*plane, &mesh).unwrap().intersecting);
    let contact = dispatcher.contact(&down, &*plane, &mesh, 0.0).unwrap();
    assert_eq!(contact.map(|contact| contact.dist), Some(0.0));
    let above = Pose3::translation(0.0, -low + 1.0e-5, 0.0);
    assert!(!dispatcher.intersection_test(&above, &*plane, &mesh).unwrap().intersecting);
}

/// Would catch a nearest triangle lost just at the limit, and a result without a limit.
#[test]
fn a_limit_that_is_the_distance_is_enough() {
    let dispatcher = SbbkDispatcher::default();
    let floor = shape(&mesh::floor(8.0, 8));
    for (name, other) in [
        ("cuboid", SharedShape::cuboid(0.5, 0.5, 0.5)),
        ("cylinder", SharedShape::cylinder(0.5, 0.25)),
        ("capsule", SharedShape::capsule_y(0.25, 0.25)),
    ] {
        let high = Pose3::translation(0.25, 1.5, 0.25);
        let closest = |limit| dispatcher.closest_points(&high, &floor, &*other, limit).unwrap();
        assert!(matches!(closest(1.0), ClosestPoints::WithinMargin(..)), "{name}");
        assert_eq!(closest(0.99), ClosestPoints::Disjoint, "{name}");
        let low = Pose3::translation(0.25, 0.5, 0.25);
        let none = dispatcher.closest_points(&low, &floor, &*other, f32::NAN).unwrap();
        assert_eq!(none, ClosestPoints::Disjoint, "{name}");
    }
}
