use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use glamx::Vec3;
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::dynamics::{RigidBodyBuilder, SoftBodyBuilder};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::{CompositeShape, Shape, SharedShape, TriMesh, TriMeshFlags};
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::mesh;
use sbbk_testkit::probe::{Probe, Timed, shape_address};

use crate::support::{
    Manifold, Pair, Question, TrianglePair, assert_same, by_triangles, counting, distance, nudge,
    rebuilt, sequence, shape, shape_with,
};
use crate::truth::pairs_within;

fn soft_ball(flags: TriMeshFlags) -> TriMesh {
    shape_with(&mesh::ball(1.0, 5), TriMeshFlags::DEFORMABLE | flags)
}

fn torus() -> TriMesh {
    shape(&mesh::torus(1.0, 0.4, 24, 12))
}

fn beside() -> Pose {
    Pose::from_parts(Vector::new(1.5, 0.4, 0.2), glamx::Quat::from_rotation_x(1.0))
}

/// Dents that wander over a mesh, from where its vertices are at rest.
fn deform(mesh: &mut TriMesh, rest: &[Vec3], frame: usize) {
    let phase = 0.07 * frame as Real;
    mesh.update_vertices(|vertices| {
        for (vertex, &rest) in vertices.iter_mut().zip(rest) {
            let dent = (3.0 * rest.x + phase).sin() * (2.0 * rest.y - 2.0 * phase).cos();
            *vertex = rest * (1.0 + 0.15 * dent) + Vec3::Z * (0.1 * (rest.x + phase).sin());
        }
    });
}

fn set<M, C>(
    manifolds: &[rapier3d::parry::query::ContactManifold<M, C>],
) -> BTreeSet<TrianglePair> {
    sequence(manifolds).into_iter().collect()
}

/// A soft ball and another mesh through hundreds of frames: of every twelve, five leave the
/// vertices, two the pose, and one both as they were. The answer of the pair that is kept is that
/// of a dispatcher that knows nothing of a mesh built anew, and no contact of the truth is missing.
///
/// Would catch candidates, features or cones of vertices that are no more, in either order.
fn check_frames(flags: TriMeshFlags, other: TriMesh, frames: usize) {
    let dispatcher = counting();
    let mut random = Rand32::new(9);
    let mut soft = soft_ball(flags);
    let rest = soft.vertices().to_vec();
    let [mut pair, mut swapped]: [Pair; 2] = Default::default();
    let mut pose = beside();
    let (mut contacts, mut deformations) = (0, 0);
    for frame in 0..frames {
        if frame % 12 < 7 {
            deform(&mut soft, &rest, frame);
            deformations += 1;
        }
        if !matches!(frame % 12, 4 | 11) {
            pose =
                nudge(&mut random, 0.001) * Pose::from_parts(beside().translation, pose.rotation);
        }
        let query = Question::new(&soft, &other, pose);
        let anew = rebuilt(&soft);
        let expected = Question::new(&anew, &other, pose).fresh(&SbbkDispatcher::default());
        contacts += expected.len();
        let found = &pair.ask(&dispatcher, &query).manifolds;
        assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
        assert_eq!(set(found), set(&expected), "frame {frame}");
        if flags.is_empty() {
            let truth = pairs_within(&query, f64::from(query.prediction) * 0.999);
            let found = set(found);
            assert!(truth.keys().all(|pair| found.contains(pair)), "frame {frame} lost a contact");
        }
        let query = query.flipped(true);
        let found = &swapped.ask(&dispatcher, &query).manifolds;
        assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
    }
    assert!(contacts > 10 * frames, "only {contacts} contacts");
    let stats = dispatcher.stats();
    // Nothing is built for a mesh that may change, and nothing kept.
    assert_eq!(
        (stats.trees, stats.internals.walks, stats.unsupported_queries),
        (0, 2 * frames as u64, 0)
    );
    assert!(deformations > frames / 2);
}

#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_rigid_one() {
    check_frames(TriMeshFlags::empty(), torus(), 350);
}

#[test]
fn cones_of_normals_turn_with_the_mesh() {
    check_frames(TriMeshFlags::FIX_INTERNAL_EDGES, torus(), 140);
    check_frames(TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED, torus(), 70);
}

/// Would catch anything of one mesh taken for that of the other.
#[test]
fn two_soft_meshes_keep_apart() {
    let dispatcher = counting();
    let mut meshes = [(); 2].map(|()| soft_ball(TriMeshFlags::empty()));
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

/// What a host stores with each contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Impulse(u32);

/// Would catch impulses lost where a mesh deforms a little, or where it is copied first as Rapier
/// does with a shared shape: soft bodies would jitter.
#[test]
fn contacts_keep_their_data_while_a_mesh_deforms() {
    let dispatcher = SbbkDispatcher::default();
    let mut soft = soft_ball(TriMeshFlags::empty());
    let other = torus();
    let mut pair = Pair::<(), Impulse>::default();
    for step in 0..6 {
        if step == 3 {
            let copy = soft.clone();
            assert_ne!(copy.vertices().as_ptr(), soft.vertices().as_ptr());
            soft = copy;
        }
        soft.update_vertices(|vertices| vertices.iter_mut().for_each(|vertex| *vertex *= 1.00001));
        pair.ask(&dispatcher, &Question::new(&soft, &other, beside()));
        for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
            point.data.0 += 1;
        }
    }
    let points = || pair.manifolds.iter().flat_map(|manifold| &manifold.points);
    let old = points().filter(|point| point.data.0 == 6).count();
    assert!(old > 20 && 10 * old > 9 * points().count(), "{old} of {}", points().count());
}

/// Would catch a race between pairs of one mesh, a deadlock, or a lost contact.
#[test]
fn pairs_on_many_threads_agree() {
    const PAIRS: usize = 8;
    let dispatcher = SbbkDispatcher::default();
    let mut soft = soft_ball(TriMeshFlags::empty());
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

/// Would catch a panic, a verdict that outlives the vertices, and a mesh that goes to Parry.
#[test]
fn a_mesh_that_is_broken_for_a_while_comes_back() {
    let dispatcher = counting();
    let mut soft = soft_ball(TriMeshFlags::empty());
    let rest = soft.vertices().to_vec();
    let far = (0..rest.len()).min_by(|&i, &j| rest[i].x.total_cmp(&rest[j].x)).expect("vertices");
    let other = torus();
    let mut pair: Pair = Pair::default();
    for frame in 0..12 {
        deform(&mut soft, &rest, frame);
        let is_broken = frame % 4 == 2;
        if is_broken {
            soft.update_vertices(|vertices| vertices[far].x = Real::NAN);
        }
        let query = Question::new(&soft, &other, beside());
        pair.ask(&dispatcher, &query);
        assert_same(&pair.manifolds, &query.fresh(&SbbkDispatcher::default()), 1e-5);
        assert!(!pair.manifolds.is_empty());
    }
    let stats = dispatcher.stats();
    assert_eq!(stats.unsupported_queries, 0, "{stats:?}");
}

/// Triangles that change where the mesh is: the contacts are those of the new ones.
#[test]
fn other_triangles_at_the_same_place_are_seen() {
    let dispatcher = SbbkDispatcher::default();
    let mut soft = SharedShape::new(soft_ball(TriMeshFlags::empty()));
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

/// A soft ball against convex shapes, beside stock, which knows no state of such a mesh. Would
/// catch stale candidates, separating axes or points.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_convex_shapes() {
    let shapes: [SharedShape; 5] = [
        SharedShape::ball(0.5),
        SharedShape::cuboid(3.0, 0.2, 3.0),
        SharedShape::capsule_y(0.5, 0.3),
        SharedShape::cylinder(0.5, 0.4),
        SharedShape::halfspace(Vec3::Y),
    ];
    for (shape, flipped) in shapes.iter().flat_map(|shape| [(shape, false), (shape, true)]) {
        let dispatcher = counting();
        let mut soft = soft_ball(TriMeshFlags::empty());
        let rest = soft.vertices().to_vec();
        let [mut pair, mut stock]: [Pair; 2] = Default::default();
        let mut contacts = 0;
        for frame in 0..120 {
            deform(&mut soft, &rest, frame);
            // Parry's box of a half-space has no top.
            let is_half_space = shape.as_halfspace().is_some();
            let top = if is_half_space { 0.0 } else { shape.compute_local_aabb().maxs.y };
            let below = -0.85 - top.clamp(0.0, 1.0);
            let pose = Pose::translation(0.001 * frame as Real, below, 0.05);
            let ask = |dispatcher: &dyn PersistentQueryDispatcher<(), ()>, pair: &mut Pair| {
                let Pair { manifolds, workspace } = pair;
                let (pos12, [g1, g2]) = if flipped {
                    (pose.inverse(), [&**shape, &soft as &dyn Shape])
                } else {
                    (pose, [&soft as &dyn Shape, &**shape])
                };
                let answer =
                    dispatcher.contact_manifolds(&pos12, g1, g2, 0.02, manifolds, workspace);
                assert!(answer.is_ok());
            };
            ask(&dispatcher, &mut pair);
            let mut afresh: Pair = Pair::default();
            ask(&DefaultQueryDispatcher, &mut afresh);
            ask(&DefaultQueryDispatcher, &mut stock);
            contacts += afresh.manifolds.len();
            check_like(&pair.manifolds, [&afresh.manifolds, &stock.manifolds]);
        }
        assert!(contacts > 120, "{contacts} contacts");
    }
}

/// Equal to one of stock's answers, afresh or from step to step, up to what Parry's tolerances
/// leave open where its iterations begin elsewhere (its own two answers for a cylinder differ by
/// 0.004): contacts near the prediction distance may come or not. Vertices move by 0.01 a frame.
fn check_like(found: &[Manifold], stock: [&[Manifold]; 2]) {
    let clear = |manifolds: &[Manifold]| -> BTreeMap<TrianglePair, Real> {
        let known = by_triangles(manifolds).into_iter().map(|(pair, m)| (pair, distance(m)));
        known.filter(|(_, distance)| *distance < 0.016).collect()
    };
    let (found, stock) = (clear(found), stock.map(clear));
    for (triangles, distance) in &found {
        let answers = || stock.iter().filter_map(|stock| stock.get(triangles));
        let is_like = answers().any(|other| (other - distance).abs() < 4e-3);
        assert!(is_like, "{triangles:?} at {distance}, stock {:?}", answers().collect::<Vec<_>>());
    }
    for triangles in stock[0].keys().filter(|triangles| stock[1].contains_key(*triangles)) {
        assert!(found.contains_key(triangles), "{triangles:?} is lost");
    }
}

/// A soft ball above a fixed torus, under gravity.
fn soft_world(dispatcher: &SbbkDispatcher, probe: &Probe) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    let timed = Timed::new(std::sync::Arc::new(dispatcher.clone()), probe.clone());
    world.narrow_phase.set_query_dispatcher(timed);
    let ring = mesh::torus(1.0, 0.4, 24, 12);
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(SharedShape::new(shape(&ring))));
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

/// In each step of a real soft body Rapier's narrow phase gets the contacts that a dispatcher finds
/// which knows nothing, on a mesh built of the vertices as they are in that step; and the body,
/// which falls, is caught by them.
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
            let question = answer.question;
            let is_soft_first = world.colliders.iter().any(|(_, collider)| {
                let is_first = shape_address(collider.shape()) == question.shapes[0];
                is_first && collider.shape().as_trimesh().is_some_and(TriMesh::is_deformable)
            });
            let [mesh1, mesh2] = if is_soft_first { [&soft, &rigid] } else { [&rigid, &soft] };
            let query = Question::new(mesh1, mesh2, question.pos12).within(question.prediction);
            let found: BTreeSet<_> =
                answer.reported.iter().map(|pair| [pair.triangle1, pair.triangle2]).collect();
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

/// A world with a soft body in contact, saved and restored, goes on bit for bit.
#[test]
fn a_restored_soft_body_goes_on_bit_for_bit() {
    let (dispatcher, other) = (SbbkDispatcher::default(), SbbkDispatcher::default());
    let mut world = soft_world(&dispatcher, &Probe::default());
    for _ in 0..60 {
        world.step();
    }
    let bytes = postcard::to_stdvec(&world).expect("a world with SBBK can be saved");
    let mut copy: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
    copy.narrow_phase.set_query_dispatcher(other.clone());
    for _ in 0..30 {
        world.step();
        copy.step();
    }
    let particles = |world: &PhysicsWorld| -> Vec<Vector> {
        world.soft_bodies().flat_map(|(_, body)| body.particle_positions()).collect()
    };
    assert_eq!(particles(&world), particles(&copy));
    assert!(other.stats().internals.walks > 20, "{:?}", other.stats());
}
