use crate::prelude::*;
use sbbk_testkit::scene::{BoxStack, HeadOnSlope, Scene};

/// Adds SBBK to a scene.
fn with_sbbk(mut scene: SceneWorld) -> SceneWorld {
    scene.world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
    scene
}

/// The bodies that a scene is about.
fn bodies(scene: &SceneWorld) -> impl Iterator<Item = &RigidBody> {
    scene.watched.iter().map(|&body| &scene.world.bodies[body])
}

fn speed(body: &RigidBody) -> Real {
    body.linvel().length().max(body.angvel().length())
}

/// Ten unit boxes for a minute, kept awake.
///
/// Would catch contacts that jitter, sink, lose their impulses, or push sideways. Recycling is on,
/// Rapier's default, as stacks of meshes collapse under stock without it.
#[test]
fn a_stack_of_ten_boxes_stands_for_a_minute() {
    let awake = || {
        let mut scene = BoxStack.build();
        for &body in &scene.watched {
            scene.world.bodies[body].activation_mut().normalized_linear_threshold = -1.0;
        }
        scene
    };
    let (mut stock, mut sbbk) = (awake(), with_sbbk(awake()));
    stock.step(3600);
    sbbk.step(600);
    let early: Vec<Vector> = bodies(&sbbk).map(RigidBody::translation).collect();
    sbbk.step(3000);
    let pairs = bodies(&stock).zip(bodies(&sbbk)).zip(early);
    for (index, ((stock, sbbk), early)) in pairs.enumerate() {
        let apart = (stock.translation() - sbbk.translation()).length();
        // The sine of the half angle: the arc cosine of a dot product would lose small angles.
        let turned = 2.0 * (stock.rotation().inverse() * *sbbk.rotation()).xyz().length();
        assert!(apart <= 5e-4 && turned <= 1e-3, "{apart} units and {turned} radians apart");
        assert!(!sbbk.is_sleeping() && speed(sbbk) < 2e-4, "box {index}: {}", speed(sbbk));
        let crept = (sbbk.translation() - early).length();
        assert!(crept < 2e-4, "box {index} has crept by {crept}");
        let upright = Vector::Y * (0.5 + index as Real);
        let off = (sbbk.translation() - upright).length();
        assert!(off < 0.03, "box {index} is {off} units from where it was put");
    }
}

/// Contacts of inner edges hold the head under stock. Would catch such contacts, and contacts that
/// let it sink or roll on its back.
#[test]
fn a_head_that_nothing_holds_tips_over_and_rests() {
    let scene = HeadOnSlope { angle: 0.0 };
    let mut scenes = [scene.build(), with_sbbk(scene.build())];
    scenes.iter_mut().for_each(|scene| scene.step(1000));
    let [stock, sbbk] = scenes.each_ref().map(|scene| bodies(scene).next().expect("one head"));
    let turned = |body: &RigidBody| 2.0 * body.rotation().xyz().length().asin();
    assert!(turned(stock) < 0.02 && turned(sbbk) > 0.9);
    assert_eq!(speed(sbbk), 0.0, "at rest");
    let lowest = lowest(&mesh::monkey_head().centred().scaled_to(2.0), sbbk.position());
    assert!(lowest.abs() < 0.01, "its lowest point is at {lowest}");
}

/// Would catch contacts of surfaces that go stale while Rapier recycles them.
#[test]
fn a_head_rests_on_a_slope_by_its_surface() {
    for degrees in [10.0, 14.0] {
        let scene = HeadOnSlope { angle: Real::to_radians(degrees) };
        let mut sbbk = with_sbbk(scene.build());
        sbbk.step(1200);
        bodies(&sbbk).for_each(|head| assert_eq!(speed(head), 0.0, "on {degrees} degrees"));
    }
}

/// Would catch points that lose their impulses when they pass from triangle to triangle.
#[test]
fn a_light_box_carries_a_heavy_one() {
    let part =
        |half: Real, cells| ColliderBuilder::new(mesh::cuboid(Vec3::splat(half), cells).shape());
    let mut fallen = Vec::new();
    for (ratio, cells) in
        [100.0, 150.0, 200.0].into_iter().flat_map(|r| [1, 2, 3, 4].map(|c| (r, c)))
    {
        let ground = ColliderBuilder::new(mesh::cuboid(Vec3::new(5.0, 0.5, 5.0), 6).shape());
        let ground = ground.translation(-0.5 * Vec3::Y);
        let mut world = world_of([ground], SbbkDispatcher::default());
        let body = |height: Real| {
            RigidBodyBuilder::dynamic().translation(height * Vec3::Y).can_sleep(false)
        };
        world.insert(body(0.25), part(0.25, cells).mass(1.0));
        let heavy = after(900, world, body(0.9), part(0.4, cells + 1).mass(ratio));
        if heavy.translation().y < 0.6 {
            fallen.push((ratio, cells));
        }
    }
    assert!(fallen.is_empty(), "{fallen:?}");
}
