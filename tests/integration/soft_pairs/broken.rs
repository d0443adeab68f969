use glamx::Vec3;
use oorandom::Rand32;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::{PREDICTION, assert_same_set, furniture, hills};
use crate::support::{
    Manifold, Pair, Question, by_triangles, counting, distance, per_triangle, rotation, shape_with,
};

/// How the contacts of a mesh and a shape follow from where they are.
#[derive(Clone, Copy, PartialEq)]
enum Contacts {
    /// Bit for bit.
    Exact,
    /// The same of a first query; later ones begin where Parry's iterations ended.
    ExactAtFirst,
    /// But for stock's roundings of the pose, which depend on the sizes of the boxes.
    Rounded,
}

/// A shape of each kind that SBBK answers for.
fn others() -> Vec<(&'static str, SharedShape, Contacts)> {
    use Contacts::{Exact, ExactAtFirst, Rounded};
    let ball = mesh::ball(0.7, 3);
    let hull = SharedShape::convex_hull(&ball.vertices).expect("a ball has a hull");
    let of_mesh = |flags| SharedShape::new(shape_with(&ball, flags));
    vec![
        ("mesh", of_mesh(TriMeshFlags::empty()), Exact),
        ("deformable mesh", of_mesh(TriMeshFlags::DEFORMABLE), Exact),
        ("height field", SharedShape::new(hills(&mut Rand32::new(1))), Exact),
        ("ball", SharedShape::ball(0.7), Exact),
        ("cuboid", SharedShape::cuboid(0.7, 0.4, 0.6), Exact),
        ("capsule", SharedShape::capsule_y(0.4, 0.4), ExactAtFirst),
        ("cylinder", SharedShape::cylinder(0.5, 0.5), ExactAtFirst),
        ("cone", SharedShape::cone(0.5, 0.5), ExactAtFirst),
        ("convex polyhedron", hull, ExactAtFirst),
        ("round cuboid", SharedShape::round_cuboid(0.6, 0.4, 0.5, 0.1), ExactAtFirst),
        ("segment", SharedShape::segment(Vec3::X, -Vec3::X), ExactAtFirst),
        ("half-space", SharedShape::halfspace(Vec3::Y), Exact),
        ("compound", SharedShape::new(furniture(SharedShape::cuboid(0.5, 0.1, 0.1))), Rounded),
    ]
}

/// Makes some coordinates NaN or infinite: one, all of a vertex, or one of every seventh vertex.
fn break_some(mesh: &mut TriMesh, random: &mut Rand32) {
    let vertex = random.rand_range(0..mesh.vertices().len() as u32) as usize;
    let axis = random.rand_range(0..3) as usize;
    let bad = [Real::NAN, Real::INFINITY, -Real::INFINITY][random.rand_range(0..3) as usize];
    let how = random.rand_range(0..3);
    mesh.update_vertices(|vertices| match how {
        0 => vertices[vertex][axis] = bad,
        1 => vertices[vertex] = Vec3::splat(bad),
        _ => vertices.iter_mut().step_by(7).for_each(|vertex| vertex[axis] = bad),
    });
}

/// The mesh without its broken triangles, and the number in the whole of each that is left.
fn whole_part(mesh: &TriMesh) -> (TriMesh, Vec<u32>) {
    let finite = |vertex: &Vec3| if vertex.is_finite() { *vertex } else { Vec3::ZERO };
    let vertices = mesh.vertices().iter().map(finite).collect();
    let is_whole = |triangle: &[u32; 3]| {
        triangle.iter().all(|&vertex| mesh.vertices()[vertex as usize].is_finite())
    };
    let triangles = mesh.indices().iter().copied().zip(0..);
    let (indices, numbers) = triangles.filter(|(triangle, _)| is_whole(triangle)).unzip();
    (TriMesh::new(vertices, indices).expect("some triangles are whole"), numbers)
}

/// The contacts that the whole part of the mesh has, by the numbers of the mesh.
fn expected(question: &Question) -> Vec<Manifold> {
    let (whole, numbers) = whole_part(question.mesh());
    let mut manifolds =
        Question { shapes: [question.shapes[0], &whole], ..*question }.fresh(&per_triangle());
    for manifold in &mut manifolds {
        let Manifold { subshape1, subshape2, .. } = manifold;
        let number = if question.is_flipped { subshape1 } else { subshape2 };
        *number = numbers[*number as usize];
    }
    manifolds
}

/// A mesh that breaks near what it touches, deforms and is whole again, against every kind: whole
/// triangles touch as if there were no others, broken ones touch nothing. Would catch a panic of
/// Parry's, which looks at the broken ones, a box that means nothing, and a manifold of a triangle
/// that has broken since.
#[test]
fn whole_triangles_touch_and_broken_ones_do_not() {
    for (name, other, contacts) in others() {
        let dispatcher = counting();
        let (mut count, mut lost) = (0, 0);
        for seed in 0..60 {
            let random = &mut Rand32::new(seed);
            let mut soft = shape_with(&mesh::ball(0.7, 4), TriMeshFlags::DEFORMABLE);
            let rest = soft.vertices().to_vec();
            let [x, y, z] = [0.5, 1.2, 0.5].map(|size| size * random.rand_float());
            let pose = Pose::from_parts(Vec3::new(x, y, z), rotation(random));
            let mut pair: Pair = Pair::default();
            let mut before = 0;
            for frame in 0..5 {
                soft.set_vertices(&rest);
                soft.update_vertices(|vertices| {
                    vertices.iter_mut().for_each(|v| *v *= 1.0 - 1e-4 * frame as Real);
                });
                // Frame 0 is whole in most cases: others are broken from the start.
                let is_broken = matches!(frame, 1 | 2) || frame == 0 && seed % 4 == 0;
                if is_broken {
                    break_some(&mut soft, random);
                }
                let flipped = seed % 2 == 0;
                let question = Question::new(&*other, &soft, pose).flipped(flipped);
                let expected = expected(&question);
                println!("{name}, case {seed}, frame {frame}");
                let fresh = question.fresh(&dispatcher);
                let found = &pair.ask(&dispatcher, &question).manifolds;
                check_kept(found, &question);
                match contacts {
                    Contacts::Exact => assert_same_set(found, &expected),
                    Contacts::ExactAtFirst => assert_same_set(&fresh, &expected),
                    Contacts::Rounded => assert_near(found, &expected),
                }
                count += expected.len();
                lost += usize::from(is_broken && expected.len() < before);
                before = expected.len();
            }
        }
        assert!(count > 300 && lost > 10, "{name}: {count} contacts, {lost} times lost some");
        let stats = dispatcher.stats();
        assert_eq!(stats.unsupported_queries, 0, "{name}: {stats:?}");
    }
}

/// Panics unless each contact of one side that is clearly within the prediction distance is on the
/// other, as deep.
fn assert_near(found: &[Manifold], expected: &[Manifold]) {
    let [found, expected] = [found, expected].map(by_triangles);
    for (these, others) in [(&found, &expected), (&expected, &found)] {
        for (triangles, manifold) in these {
            let near = distance(manifold);
            let other = others.get(triangles).map(|manifold| distance(manifold));
            let is_like = other.is_some_and(|other| (other - near).abs() < 1e-4);
            assert!(is_like || near > PREDICTION - 1e-4, "{triangles:?}: {near} and {other:?}");
        }
    }
}

/// Panics where a manifold is of a broken triangle or has points that are no numbers.
fn check_kept(found: &[Manifold], question: &Question) {
    for manifold in found {
        let Manifold { subshape1, subshape2, .. } = *manifold;
        let triangle =
            question.mesh().triangle(if question.is_flipped { subshape1 } else { subshape2 });
        assert!(triangle.vertices().iter().all(|corner| corner.is_finite()));
        assert!(manifold.points.iter().all(|point| point.dist.is_finite()));
    }
}

/// A mesh of which nothing is left has no contacts, and comes back.
#[test]
fn a_mesh_all_broken_has_no_contacts() {
    for (name, other, _) in others() {
        let dispatcher = counting();
        let mut soft = shape_with(&mesh::ball(0.7, 4), TriMeshFlags::DEFORMABLE);
        let rest = soft.vertices().to_vec();
        let mut pair: Pair = Pair::default();
        for bad in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            for is_broken in [false, true, false] {
                soft.set_vertices(&rest);
                if is_broken {
                    soft.update_vertices(|vertices| vertices.fill(Vec3::splat(bad)));
                }
                let pose = Pose::translation(0.1, 0.5, 0.1);
                let question = Question::new(&*other, &soft, pose).flipped(true);
                let found = &pair.ask(&dispatcher, &question).manifolds;
                let has_points = found.iter().any(|manifold| !manifold.points.is_empty());
                assert_eq!(has_points, !is_broken, "{name}, {bad}");
            }
        }
    }
}
