//! Lines of contacts: where the contacts are, in the world, with parts of a compound at their
//! places.

use parry3d::math::{Pose, Vector};
use parry3d::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d::shape::{Ball, Shape, SharedShape, TriMesh};
use rapier_integration::{SbbkDispatcher, draw};

type Line = (Vector, Vector, draw::Colour);

fn contacts(shapes: [&dyn Shape; 2], poses: [&Pose; 2]) -> (usize, Vec<Line>, Vec<Line>) {
    let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
    let [one, two] = shapes;
    let pos12 = poses[0].inv_mul(poses[1]);
    let dispatcher = SbbkDispatcher::default();
    dispatcher.contact_manifolds(&pos12, one, two, 0.02, &mut manifolds, &mut None).unwrap();
    let [mut points, mut triangles] = [Vec::new(), Vec::new()];
    draw::contacts(&manifolds, poses, 0.1, |a, b, colour| points.push((a, b, colour)));
    draw::triangles(&manifolds, shapes, poses, |a, b, colour| triangles.push((a, b, colour)));
    // Each line of a patch joins two points that are drawn.
    draw::patches(&manifolds, poses, |a, b, _| {
        let is_drawn = |end| points.iter().step_by(2).any(|point: &Line| point.0 == end);
        assert!(is_drawn(a) && is_drawn(b), "{a} {b}");
    });
    (manifolds.iter().map(|manifold| manifold.points.len()).sum(), points, triangles)
}

/// Would catch points in the wrong frame, normals of the wrong way or length, and colours mixed up.
#[test]
fn contacts_are_drawn_where_shapes_touch() {
    let (vertices, indices) = Ball::new(1.0).to_trimesh(24, 12);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let part = Pose::new(Vector::new(0.9, 0.0, 0.0), Vector::new(0.3, 0.2, 0.1));
    let compound = SharedShape::compound(vec![
        (part, SharedShape::cuboid(0.3, 0.3, 0.3)),
        (part.inverse(), SharedShape::cuboid(0.2, 0.2, 0.2)),
    ]);
    let pose1 = Pose::new(Vector::new(3.0, -2.0, 1.0), Vector::new(0.5, 0.7, -0.2));
    for (other, away) in [(&mesh as &dyn Shape, 1.95), (&*compound.0, 2.1)] {
        let pose2 = pose1 * Pose::new(Vector::new(-away, 0.0, 0.0), Vector::new(0.0, 0.4, 0.0));
        for (shapes, poses) in
            [([&mesh, other], [&pose1, &pose2]), ([other, &mesh], [&pose2, &pose1])]
        {
            let (count, points, triangles) = contacts(shapes, poses);
            assert!(count > 2 && points.len() == 2 * count, "{count} points");
            for pair in points.chunks_exact(2) {
                let [(p1, p2, colour), (start, end, normal)] = [pair[0], pair[1]];
                assert!(start == p1 && normal == draw::NORMAL && colour != normal);
                assert!(((end - start).length() - 0.1).abs() < 1e-5);
                for (shape, pose, point) in [(shapes[0], poses[0], p1), (shapes[1], poses[1], p2)] {
                    let away = shape.project_point(pose, point, false).point.distance(point);
                    assert!(away < 1e-4, "{point} is {away} away from its shape");
                }
                // The normal leads from the first shape to the second.
                let is_apart = colour == draw::APART;
                let way = (p2 - p1).dot(end - start);
                assert!(if is_apart { way >= 0.0 } else { way <= 0.0 }, "{way}");
            }
            let sides = draw::TRIANGLES
                .map(|colour| triangles.iter().filter(|line| line.2 == colour).count());
            let is_mesh = shapes.map(|shape| shape.as_trimesh().is_some());
            assert_eq!(sides.map(|count| count > 0 && count % 3 == 0), is_mesh);
            for (a, _, colour) in triangles {
                let side = usize::from(colour == draw::TRIANGLES[1]);
                let point = poses[side].inverse_transform_point(a);
                let is_vertex = |vertex: &Vector| vertex.distance(point) < 1e-5;
                assert!(mesh.vertices().iter().any(is_vertex), "{a}");
            }
        }
    }
}
