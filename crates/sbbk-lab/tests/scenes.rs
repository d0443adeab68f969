//! What every scene must be at the start, and that it does what its documentation says.

use std::collections::HashSet;

use rapier3d::geometry::{Collider, TriMesh};
use rapier3d::parry::bounding_volume::BoundingVolume;
use sbbk_lab::backend::{Backend, Question, shape_address};
use sbbk_lab::mesh;
use sbbk_lab::metrics::Judge;
use sbbk_lab::scene::{
    BallKind, BoxStack, HeadOnSlope, HelicopterBallDrop, MonkeyPile, Scene, SceneWorld, Solid,
    TwoMeshes,
};

/// Every scene, with the number of its moving bodies.
fn scenes() -> Vec<(Box<dyn Scene>, usize)> {
    let primitive =
        HelicopterBallDrop { ball: BallKind::Primitive, ..HelicopterBallDrop::default() };
    vec![
        (Box::new(HelicopterBallDrop::default()), 1),
        (Box::new(primitive), 1),
        (Box::new(MonkeyPile::with_heads(30)), 30),
        (Box::new(TwoMeshes::default()), 1),
        (Box::new(BoxStack::default()), 10),
        (Box::new(HeadOnSlope::default()), 1),
    ]
}

/// Would catch a body that is forgotten, listed twice, fixed by mistake or without mass.
#[test]
fn bodies_are_counted_and_can_move() {
    for (scene, count) in scenes() {
        let SceneWorld { world, watched } = scene.build().unwrap();
        assert_eq!(watched.len(), count, "{}", scene.name());
        assert_eq!(watched.iter().collect::<HashSet<_>>().len(), count);
        assert_eq!(world.bodies.len(), count + 1, "one fixed body in {}", scene.name());
        for &handle in &watched {
            let body = &world.bodies[handle];
            assert!(body.is_dynamic() && body.mass() > 0.0 && body.mass().is_finite());
        }
    }
}

/// Would catch a scene that starts with bodies in each other, which would be blown apart by the
/// solver: against brute force in f64, no two meshes may be within a ten-thousandth of a unit.
#[test]
fn nothing_overlaps_at_the_start() {
    for (scene, _) in scenes() {
        let world = scene.build().unwrap().world;
        let colliders: Vec<&Collider> = world.colliders.iter().map(|(_, c)| c).collect();
        let judge = Judge::new(colliders.iter().map(|collider| collider.shared_shape()));
        for (index, collider1) in colliders.iter().enumerate() {
            for collider2 in &colliders[index + 1..] {
                let aabbs = [collider1, collider2].map(|collider| collider.compute_aabb());
                let are_meshes = [collider1, collider2]
                    .iter()
                    .all(|collider| collider.shape().as_shape::<TriMesh>().is_some());
                if !are_meshes {
                    assert!(!aabbs[0].intersects(&aabbs[1]), "{}", scene.name());
                } else if aabbs[0].intersects(&aabbs[1]) {
                    let pos12 = collider1.position().inv_mul(collider2.position());
                    let shapes = [collider1.shape(), collider2.shape()];
                    let truth = judge.truth(&Question::new(&pos12, shapes, 1e-4));
                    assert_eq!(truth.pairs().count(), 0, "{}", scene.name());
                }
            }
        }
    }
}

/// Would catch a scene in which nothing ever touches: each must have a contact within its first
/// two seconds.
#[test]
fn bodies_meet_within_two_seconds() {
    for (scene, _) in scenes() {
        let mut world = scene.build().unwrap().world;
        let touches = (0..120).any(|_| {
            world.step();
            world.narrow_phase.contact_pairs().any(|pair| pair.has_any_active_contact())
        });
        assert!(touches, "{}", scene.name());
    }
}

/// Would catch a pile whose memory, and whose number of trees, grows with its heads.
#[test]
fn all_heads_share_one_shape() {
    let world = MonkeyPile::with_heads(50).build().unwrap().world;
    let meshes = world.colliders.iter().map(|(_, collider)| collider.shape());
    let meshes = meshes.filter(|shape| shape.as_shape::<TriMesh>().is_some());
    let addresses: HashSet<usize> = meshes.map(shape_address).collect();
    assert_eq!(addresses.len(), 1);
}

/// Would catch orientations that are not random, or not seeded: comparisons of backends start
/// from equal worlds.
#[test]
fn a_seed_gives_one_pile() {
    let pile = MonkeyPile::with_heads(20);
    assert_eq!(pile.poses(), pile.poses());
    let other = MonkeyPile { seed: 2, ..pile.clone() };
    assert!(pile.poses().iter().zip(other.poses()).all(|(a, b)| a.rotation != b.rotation));
}

/// Would catch mass properties taken from an open or inside-out mesh: a body of negative mass
/// falls upwards.
#[test]
fn open_and_inverted_meshes_fall_as_boxes() {
    let inverted = mesh::ball(1.0, 4).mapped(|v| -v);
    for mesh in [mesh::terrain(4.0, 8, 0.2), inverted] {
        let size = mesh.bounds().volume();
        let mass = Solid::new(&mesh).unwrap().collider().build().mass();
        assert!((mass - size).abs() < 1e-3 * size, "{}: {mass} instead of {size}", mesh.name);
    }
    let ball = Solid::new(&mesh::ball(1.0, 16)).unwrap().collider().build();
    assert!((ball.mass() - 4.0 / 3.0 * std::f32::consts::PI).abs() < 0.1);
}

/// Would catch an error that does not say which mesh is wrong.
#[test]
fn a_mesh_without_triangles_is_named() {
    let empty = mesh::Mesh::new("nothing", Vec::new(), Vec::new());
    let pile = MonkeyPile::of(2, empty);
    let message = pile.build().err().unwrap().to_string();
    assert!(message.contains("`nothing`"), "{message}");
}

/// Would catch a drop point beside the rotor: the first thing that the ball touches must be in
/// the top tenth of the helicopter.
#[test]
fn the_ball_meets_the_rotor_first() {
    let scene = HelicopterBallDrop::default();
    let bounds = scene.helicopter.bounds();
    let mut built = scene.build().unwrap();
    let ball = built.watched[0];
    let stock = Backend::Stock.install(&mut built.world);
    for _ in 0..120 {
        stock.probe.start_recording();
        built.world.step();
        let answers = stock.probe.take_answers();
        if answers.iter().any(|answer| !answer.reported.is_empty()) {
            let lowest = built.world.bodies[ball].translation().y - scene.ball_radius;
            assert!(lowest > bounds.maxs.y - 0.1 * bounds.extents().y);
            return;
        }
    }
    panic!("the ball met nothing");
}
