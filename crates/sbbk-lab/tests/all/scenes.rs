//! What every scene must be at the start, and that it does what its documentation says.

use std::collections::HashSet;

use rapier3d::geometry::Collider;
use rapier3d::parry::bounding_volume::BoundingVolume;
use sbbk_lab::backend::{Backend, Question, shape_address};
use sbbk_lab::mesh::{self, Mesh};
use sbbk_lab::metrics::Judge;
use sbbk_lab::scene::{
    BallKind, BoxStack, Ground, HeadOnSlope, HeadsOnTerrain, HelicopterBallDrop, MonkeyPile, Scene,
    SceneWorld, SoftHeads, Solid,
};

/// Every scene, with the number of its moving bodies.
fn scenes() -> Vec<(Box<dyn Scene>, usize)> {
    let primitive =
        HelicopterBallDrop { ball: BallKind::Primitive, ..HelicopterBallDrop::default() };
    let terrain = HeadsOnTerrain { side_count: 2, cells: 16, ground: Ground::Mesh };
    vec![
        (Box::new(HelicopterBallDrop::default()), 1),
        (Box::new(primitive), 1),
        (Box::new(MonkeyPile::with_heads(30)), 30),
        (Box::new(BoxStack::default()), 10),
        (Box::new(HeadOnSlope::default()), 1),
        (Box::new(terrain), 4),
    ]
}

fn colliders(built: &SceneWorld) -> Vec<&Collider> {
    built.world.colliders.iter().map(|(_, collider)| collider).collect()
}

/// Would catch a body that is forgotten, listed twice, fixed by mistake or without mass, and bodies
/// that start in each other, which the solver would blow apart: against brute force in f64, no two
/// meshes may be within a ten-thousandth of a unit. Each scene must have a contact within two
/// seconds.
#[test]
fn bodies_start_apart_and_meet() {
    for (scene, count) in scenes() {
        let name = scene.name();
        let mut built = scene.build();
        assert_eq!(built.watched.iter().collect::<HashSet<_>>().len(), count, "{name}");
        assert_eq!(built.world.bodies.len(), count + 1, "one fixed body in {name}");
        for &handle in &built.watched {
            let body = &built.world.bodies[handle];
            assert!(body.is_dynamic() && body.mass() > 0.0 && body.mass().is_finite(), "{name}");
        }

        let colliders = colliders(&built);
        let judge = Judge::new(colliders.iter().map(|collider| collider.shared_shape()));
        for (index, one) in colliders.iter().enumerate() {
            for other in &colliders[index + 1..] {
                let boxes_meet = one.compute_aabb().intersects(&other.compute_aabb());
                let shapes = [one.shape(), other.shape()];
                if boxes_meet && shapes.iter().all(|shape| shape.as_trimesh().is_some()) {
                    let pos12 = one.position().inv_mul(other.position());
                    let truth = judge.truth(&Question::new(&pos12, shapes, 1e-4));
                    assert_eq!(truth.pairs().count(), 0, "{name}");
                } else {
                    assert!(!boxes_meet, "{name}");
                }
            }
        }

        let touches = (0..120).any(|_| {
            built.world.step();
            built.world.contact_pairs().any(|pair| pair.has_any_active_contact())
        });
        assert!(touches, "{name}");
    }
    let soft = SoftHeads::with_heads(2).build();
    assert_eq!((soft.watched.len(), soft.world.soft_bodies.iter().count()), (2, 2));
}

/// Would catch a pile whose memory, and whose number of trees, grows with its heads, and
/// orientations that are not random, or not seeded: comparisons of backends start from equal
/// worlds.
#[test]
fn a_seed_gives_one_pile_of_one_shape() {
    let pile = MonkeyPile::with_heads(50);
    let built = pile.build();
    let meshes = colliders(&built).into_iter().filter(|c| c.shape().as_trimesh().is_some());
    let addresses: HashSet<usize> = meshes.map(|mesh| shape_address(mesh.shape())).collect();
    assert_eq!(addresses.len(), 1);

    assert_eq!(pile.poses(), pile.poses());
    let other = MonkeyPile { seed: 2, ..pile.clone() };
    assert!(pile.poses().iter().zip(other.poses()).all(|(a, b)| a.rotation != b.rotation));
}

/// Would catch mass properties taken from an open or inside-out mesh: a body of negative mass
/// falls upwards.
#[test]
fn any_mesh_with_triangles_falls() {
    let inverted = mesh::ball(1.0, 4).mapped(|v| -v);
    for mesh in [mesh::terrain(4.0, 8, 0.2), inverted] {
        let size = mesh.bounds().volume();
        let mass = Solid::new(&mesh).collider().build().mass();
        assert!((mass - size).abs() < 1e-3 * size, "{}: {mass} instead of {size}", mesh.name);
    }
    let ball = Solid::new(&mesh::ball(1.0, 16)).collider().build();
    assert!((ball.mass() - 4.0 / 3.0 * std::f32::consts::PI).abs() < 0.1);
}

/// Would catch an error that does not say which mesh is wrong.
#[test]
#[should_panic(expected = "the mesh `nothing`")]
fn a_mesh_without_triangles_is_named() {
    MonkeyPile::of(2, Mesh::new("nothing", Vec::new(), Vec::new())).build();
}

/// Would catch a drop point beside the rotor: the first thing that the ball touches must be in
/// the top tenth of the helicopter.
#[test]
fn the_ball_meets_the_rotor_first() {
    let scene = HelicopterBallDrop::default();
    let bounds = scene.helicopter.bounds();
    let mut built = scene.build();
    let probe = Backend::Stock.install(&mut built.world).probe;
    let touches = (0..120).any(|_| {
        probe.start_recording();
        built.world.step();
        probe.take_answers().iter().any(|answer| !answer.reported.is_empty())
    });
    let lowest = built.world.bodies[built.watched[0]].translation().y - scene.ball_radius;
    assert!(touches && lowest > bounds.maxs.y - 0.1 * bounds.extents().y, "{lowest}");
}
