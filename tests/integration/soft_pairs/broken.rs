use glamx::Vec3;
use oorandom::Rand32;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::{furniture, hills};
use crate::support::{Manifold, Pair, Question, assert_same, every, rotation, shape_with};

/// A shape of each kind that SBBK handles.
fn others() -> Vec<(&'static str, SharedShape)> {
    let ball = mesh::ball(0.7, 3);
    let hull = SharedShape::convex_hull(&ball.vertices).expect("a ball has a hull");
    let of_mesh = |flags| ball.shape_with(flags);
    vec![
        ("mesh", of_mesh(TriMeshFlags::empty())),
        ("deformable mesh", of_mesh(TriMeshFlags::DEFORMABLE)),
        ("height field", SharedShape::new(hills(&mut Rand32::new(1)))),
        ("ball", SharedShape::ball(0.7)),
        ("cuboid", SharedShape::cuboid(0.7, 0.4, 0.6)),
        ("capsule", SharedShape::capsule_y(0.4, 0.4)),
        ("cylinder", SharedShape::cylinder(0.5, 0.5)),
        ("cone", SharedShape::cone(0.5, 0.5)),
        ("convex polyhedron", hull),
        ("round cuboid", SharedShape::round_cuboid(0.6, 0.4, 0.5, 0.1)),
        ("half-space", SharedShape::halfspace(Vec3::Y)),
        ("compound", SharedShape::new(furniture(SharedShape::cuboid(0.5, 0.1, 0.1)))),
    ]
}

/// Makes some coordinates NaN: one, all of a vertex, or one of every seventh vertex.
fn break_some(mesh: &mut TriMesh, random: &mut Rand32) {
    let vertex = random.rand_range(0..mesh.vertices().len() as u32) as usize;
    let axis = random.rand_range(0..3) as usize;
    let how = random.rand_range(0..3);
    mesh.update_vertices(|vertices| match how {
        0 => vertices[vertex][axis] = Real::NAN,
        1 => vertices[vertex] = Vec3::NAN,
        _ => vertices.iter_mut().step_by(7).for_each(|vertex| vertex[axis] = Real::NAN),
    });
}

/// Panics where a manifold is of a triangle with a NaN vertex, or has points that are not finite.
fn check(found: &[Manifold], mesh: &TriMesh, is_flipped: bool) {
    for manifold in found.iter().filter(|manifold| !manifold.points.is_empty()) {
        let Manifold { subshape1, subshape2, local_n1, .. } = *manifold;
        let triangle = mesh.triangle(if is_flipped { subshape1 } else { subshape2 });
        assert!(triangle.vertices().iter().all(|corner| corner.is_finite()));
        assert!(local_n1.is_finite());
        for point in &manifold.points {
            assert!(point.dist.is_finite() && point.local_p1.is_finite());
            assert!(point.local_p2.is_finite());
        }
    }
}

#[test]
fn triangles_with_a_nan_vertex_touch_nothing() {
    for (name, other) in others() {
        let dispatcher = every();
        let (mut count, mut broken) = (0, 0);
        for seed in 0..60 {
            let random = &mut Rand32::new(seed);
            let flags =
                [TriMeshFlags::empty(), TriMeshFlags::DEFORMABLE][random.rand_range(0..2) as usize];
            let mut mesh = shape_with(&mesh::ball(0.7, 4), flags);
            let rest = mesh.vertices().to_vec();
            let [x, y, z] = [0.5, 1.2, 0.5].map(|size| size * random.rand_float());
            let pose = Pose::from_parts(Vec3::new(x, y, z), rotation(random));
            let mut pair: Pair = Pair::default();
            for frame in 0..5 {
                mesh.set_vertices(&rest);
                if flags.is_empty() {
                    // As Rapier does when a rigid shape was edited.
                    pair = Pair::default();
                }
                let is_broken = matches!(frame, 1 | 2) || frame == 0 && seed % 4 == 0;
                if is_broken {
                    break_some(&mut mesh, random);
                }
                println!("{name}, case {seed}, frame {frame}");
                let question = Question::new(&*other, &mesh, pose).flipped(seed % 2 == 0);
                let found = &pair.ask(&dispatcher, &question).manifolds;
                check(found, &mesh, question.is_flipped);
                if is_broken {
                    broken += found.len();
                } else {
                    assert_same(found, &question.fresh(&dispatcher), 1e-5);
                    count += found.len();
                }
            }
        }
        assert_eq!(dispatcher.stats().unsupported_queries, 0, "{name}");
        assert!(count > 30 && broken > 10, "{name}: {count}, {broken}");
    }
}
