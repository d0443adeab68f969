//! Scenes at their start, and in their first steps.

use std::collections::HashSet;

use rapier3d::parry::query;
use sbbk_testkit::mesh;
use sbbk_testkit::scene::{BoxStack, HeadOnSlope, HelicopterBallDrop, MonkeyPile, Scene, collider};

/// Would catch a forgotten, fixed or massless body, and bodies that start in each other, which the
/// solver would blow apart.
#[test]
fn bodies_start_apart_and_touch_within_two_seconds() {
    // Each with the number of its moving bodies.
    let (pile, slope) = (MonkeyPile::with_heads(30), HeadOnSlope { angle: 0.17 });
    let scenes: [(&dyn Scene, usize); 4] =
        [(&HelicopterBallDrop, 1), (&pile, 30), (&BoxStack, 10), (&slope, 1)];
    for (scene, count) in scenes {
        let name = scene.name();
        let mut built = scene.build();
        assert_eq!(built.watched.iter().collect::<HashSet<_>>().len(), count, "{name}");
        assert_eq!(built.world.bodies.len(), count + 1, "one fixed body in {name}");
        for &handle in &built.watched {
            let body = &built.world.bodies[handle];
            assert!(body.is_dynamic() && body.mass() > 0.0 && body.mass().is_finite(), "{name}");
        }
        let colliders: Vec<_> = built.world.colliders.iter().map(|(_, it)| it).collect();
        for (index, one) in colliders.iter().enumerate() {
            for other in &colliders[index + 1..] {
                let [pose1, pose2] = [one.position(), other.position()];
                let meets = query::contact(pose1, one.shape(), pose2, other.shape(), 1e-4);
                assert_eq!(meets, Ok(None), "{name}");
            }
        }
        let touches = (0..120).any(|_| {
            built.world.step();
            built.world.contact_pairs().any(|pair| pair.has_any_active_contact())
        });
        assert!(touches, "{name}");
    }
}

/// Would catch mass properties taken from an open or inside-out mesh: a body of negative mass
/// falls upwards.
#[test]
fn any_mesh_with_triangles_has_a_positive_mass() {
    let inverted = mesh::ball(1.0, 4).mapped(|v| -v);
    for mesh in [mesh::terrain(4.0, 8, 0.2), inverted] {
        let size = mesh.bounds().volume();
        let mass = collider(&mesh).build().mass();
        assert!((mass - size).abs() < 1e-3 * size, "{}: {mass} instead of {size}", mesh.name);
    }
    let ball = collider(&mesh::ball(1.0, 16)).build();
    assert!((ball.mass() - 4.0 / 3.0 * std::f32::consts::PI).abs() < 0.1);
}
