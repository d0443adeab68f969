use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use glamx::Vec3;
use rapier_integration::SbbkDispatcher;
use rapier3d::dynamics::{RigidBodyBuilder, SoftBodyBuilder};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::shape::{CompositeShape, SharedShape, TriMesh, TriMeshFlags};
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::mesh;
use sbbk_testkit::probe::{Probe, Recording, shape_address};

use crate::support::{
    Pair, Question, TrianglePair, assert_same, counting, deform, rebuilt, sequence, shape,
    shape_with,
};

fn soft_ball() -> TriMesh {
    shape_with(&mesh::ball(1.0, 5), TriMeshFlags::DEFORMABLE)
}

fn torus() -> TriMesh {
    shape(&mesh::torus(1.0, 0.4, 24, 12))
}

fn beside() -> Pose {
    Pose::from_parts(Vector::new(1.5, 0.4, 0.2), glamx::Quat::from_rotation_x(1.0))
}

fn set<M, C>(
    manifolds: &[rapier3d::parry::query::ContactManifold<M, C>],
) -> BTreeSet<TrianglePair> {
    sequence(manifolds).into_iter().collect()
}

/// Would catch one mesh taken for the other.
#[test]
fn two_soft_meshes_keep_apart() {
    let dispatcher = counting();
    let mut meshes = [(); 2].map(|()| soft_ball());
    let rest = meshes[0].vertices().to_vec();
    let mut pair: Pair = Pair::default();
    let mut contacts = 0;
    for frame in 0..200 {
        deform(&mut meshes[0], &rest, frame);
        deform(&mut meshes[1], &rest, frame / 2);
        let query = Question::new(&meshes[0], &meshes[1], Pose::translation(1.3, 1.2, 0.3));
        let found = &pair.ask(&dispatcher, &query).manifolds;
        contacts += found.len();
        assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
    }
    assert!(contacts > 1000);
    let stats = dispatcher.stats();
    assert_eq!((stats.trees, stats.internals.walks), (0, 200));
}

/// Would catch a race between pairs of one mesh, a deadlock, or a lost contact.
#[test]
fn pairs_on_many_threads_agree() {
    const PAIRS: usize = 8;
    let dispatcher = SbbkDispatcher::default();
    let mut soft = soft_ball();
    let rest = soft.vertices().to_vec();
    let other = torus();
    let mut pairs: [Pair; PAIRS] = Default::default();
    let contacts = AtomicUsize::new(0);
    for frame in 0..50 {
        deform(&mut soft, &rest, frame);
        thread::scope(|scope| {
            for (i, pair) in pairs.iter_mut().enumerate() {
                let (dispatcher, soft, other, contacts) = (&dispatcher, &soft, &other, &contacts);
                scope.spawn(move || {
                    let pose = Pose::translation(0.02 * i as Real, 0.0, 0.0) * beside();
                    let query = Question::new(soft, other, pose);
                    let found = &pair.ask(dispatcher, &query).manifolds;
                    contacts.fetch_add(found.len(), Ordering::Relaxed);
                    assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
                });
            }
        });
    }
    assert!(contacts.into_inner() > 50 * PAIRS);
    let stats = dispatcher.stats();
    assert_eq!((stats.trees, stats.internals.walks), (0, 50 * PAIRS as u64));
}

/// Would catch contacts of the triangles before the edit.
#[test]
fn other_triangles_at_the_same_place_are_seen() {
    let dispatcher = SbbkDispatcher::default();
    let mut soft = SharedShape::new(soft_ball());
    let other = torus();
    let mut pair: Pair = Pair::default();
    for _ in 0..4 {
        let mesh = soft.make_mut().as_trimesh_mut().expect("the shape is a mesh");
        mesh.reverse();
        let query = Question::new(soft.as_trimesh().expect("as above"), &other, beside());
        let expected = query.fresh(&SbbkDispatcher::default());
        assert!(!expected.is_empty());
        assert_same(&pair.ask(&dispatcher, &query).manifolds, &expected, 1e-5);
    }
}

/// A soft ball above a fixed torus, under gravity.
fn soft_world(dispatcher: &SbbkDispatcher, probe: &Probe) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    let recording = Recording::new(std::sync::Arc::new(dispatcher.clone()), probe.clone());
    world.narrow_phase.set_query_dispatcher(recording);
    let ring = mesh::torus(1.0, 0.4, 24, 12);
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(ring.shape()));
    let ball = mesh::ball(0.9, 5);
    let vertices = ball.vertices.iter().map(|v| *v + Vec3::new(0.2, 1.2, 0.1)).collect();
    let soft = SoftBodyBuilder::trimesh(vertices, ball.triangles.clone()).expect("a mesh");
    world.insert_soft_body(soft);
    world
}

/// The soft mesh of a world, and the other one.
fn meshes_of(world: &PhysicsWorld) -> (TriMesh, TriMesh) {
    let meshes = || world.colliders.iter().filter_map(|(_, c)| c.shape().as_trimesh());
    let find = |soft: bool| meshes().find(|mesh| mesh.is_deformable() == soft);
    let found = find(true).zip(find(false)).expect("a soft and a rigid mesh");
    (found.0.clone(), found.1.clone())
}

/// Would catch contacts of the vertices of an earlier step, and a soft body that falls through.
#[test]
fn a_soft_body_of_rapier_keeps_its_contacts() {
    let (dispatcher, probe) = (counting(), Probe::default());
    let mut world = soft_world(&dispatcher, &probe);
    let (mut contacts, mut queries) = (0, 0);
    for step in 0..200 {
        let (soft, rigid) = meshes_of(&world);
        let soft = rebuilt(&soft);
        probe.start_recording();
        world.step();
        let answers = probe.take_answers();
        if let Some(answer) = answers.first() {
            let is_soft_first = world.colliders.iter().any(|(_, collider)| {
                let is_first = shape_address(collider.shape()) == answer.shapes[0];
                is_first && collider.shape().as_trimesh().is_some_and(TriMesh::is_deformable)
            });
            let [mesh1, mesh2] = if is_soft_first { [&soft, &rigid] } else { [&rigid, &soft] };
            let query = Question::new(mesh1, mesh2, answer.pos12).within(answer.prediction);
            let found = set(&answer.manifolds);
            let expected = query.fresh(&SbbkDispatcher::default());
            assert_eq!(found, set(&expected), "step {step}");
            contacts += found.len();
            queries += 1;
        }
    }
    let stats = dispatcher.stats();
    assert!(queries > 50 && contacts > 1000, "{queries} queries, {contacts} contacts");
    assert!(stats.internals.walks as usize >= queries - 2, "{stats:?}");
    assert_eq!((stats.unsupported_queries, stats.trees), (0, 0));
    let (_, body) = world.soft_bodies().next().expect("the ball");
    let lowest = body.particle_positions().map(|p| p.y).fold(Real::INFINITY, Real::min);
    assert!(lowest > -1.5, "the body fell through to {lowest}");
}
