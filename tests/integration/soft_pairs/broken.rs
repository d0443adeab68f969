use crate::prelude::*;
use crate::who_answers::kinds;
use rapier3d::parry::shape::CompositeShape;

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

fn is_whole(mesh: &TriMesh, triangle: u32) -> bool {
    mesh.triangle(triangle).vertices().iter().all(|corner| corner.is_finite())
}

/// Panics where a manifold is of a triangle with a NaN vertex, or has points that are not finite.
fn check(found: &[Manifold], mesh: &TriMesh, question: &Question) {
    for manifold in found.iter().filter(|manifold| !manifold.points.is_empty()) {
        assert!(is_whole(mesh, question.subshapes(manifold)[1]));
        assert!(manifold.local_n1.is_finite());
        for point in &manifold.points {
            assert!(point.dist.is_finite() && point.local_p1.is_finite());
            assert!(point.local_p2.is_finite());
        }
    }
}

/// A ball and how another shape meets it.
struct Meeting {
    mesh: TriMesh,
    rest: Vec<Vec3>,
    pose: Pose,
    is_flipped: bool,
}

impl Meeting {
    fn new(random: &mut Rand32, is_flipped: bool) -> Self {
        let flags = [TriMeshFlags::empty(), TriMeshFlags::DEFORMABLE];
        let mesh = mesh::ball(0.7, 4).trimesh(flags[random.rand_range(0..2) as usize]);
        let [x, y, z] = [0.5, 1.2, 0.5].map(|size| size * random.rand_float());
        let pose = Pose::from_parts(Vec3::new(x, y, z), rotation(random));
        Self { rest: mesh.vertices().to_vec(), mesh, pose, is_flipped }
    }

    fn question<'a>(&'a self, other: &'a dyn Shape) -> Question<'a> {
        Question::new(other, &self.mesh, self.pose).flipped(self.is_flipped)
    }
}

/// Would catch contacts of broken triangles, and whole triangles that are lost with them.
#[test]
fn triangles_with_a_nan_vertex_touch_nothing() {
    for (name, other, _) in kinds().into_iter().filter(|(.., by_sbbk)| *by_sbbk) {
        let dispatcher = every();
        let (mut count, mut broken) = (0, 0);
        for seed in 0..60 {
            let random = &mut Rand32::new(seed);
            let mut meeting = Meeting::new(random, seed % 2 == 0);
            let mut pair: Pair = Pair::default();
            for frame in 0..5 {
                meeting.mesh.set_vertices(&meeting.rest);
                if !CompositeShape::is_deformable(&meeting.mesh) {
                    // As Rapier does when a rigid shape was edited.
                    pair = Pair::default();
                }
                if !matches!(frame, 1 | 2) && (frame > 0 || seed % 4 > 0) {
                    let question = meeting.question(&*other);
                    let found = &pair.ask(&dispatcher, &question).manifolds;
                    assert_same(found, &question.fresh(&dispatcher), 1e-5);
                    count += found.len();
                    continue;
                }
                let mut expected = meeting.question(&*other).fresh(&per_triangle());
                break_some(&mut meeting.mesh, random);
                let question = meeting.question(&*other);
                let found = &pair.ask(&dispatcher, &question).manifolds;
                check(found, &meeting.mesh, &question);
                broken += found.len();
                expected.retain(|m| is_whole(&meeting.mesh, question.subshapes(m)[1]));
                // Boxes around NaN may hide whole triangles from meshes and height fields.
                if other.as_trimesh().is_none() && other.as_heightfield().is_none() {
                    let whole = sequence(&question.fresh(&per_triangle()));
                    assert_eq!(whole, sequence(&expected), "{name}, case {seed}, {frame}");
                }
            }
        }
        assert_eq!(dispatcher.stats().unsupported_queries, 0, "{name}");
        assert!(count > 30 && broken > 10, "{name}: {count}, {broken}");
    }
}
