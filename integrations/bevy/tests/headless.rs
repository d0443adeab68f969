//! Apps without a window: the same scene with stock Rapier and with SBBK.

use std::time::Duration;

use bevy::prelude::*;
use bevy::time::{TimePlugin, TimeUpdateStrategy};
use bevy_rapier_sbbk::rapier_integration::{SbbkConfig, SbbkDispatcher, SbbkStats};
use bevy_rapier_sbbk::{Sbbk, SbbkPlugin, SbbkTree, StockContacts};
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::parry::shape::{Ball, Cuboid};

const STEP: f32 = 1.0 / 60.0;

fn app(sbbk: Option<SbbkPlugin>) -> App {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, TimePlugin, RapierPhysicsPlugin::<NoUserData>::default()));
    app.insert_resource(TimestepMode::Fixed { dt: STEP, substeps: 1 });
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(STEP)));
    if let Some(sbbk) = sbbk {
        app.add_plugins(sbbk);
    }
    app.finish();
    app.update();
    app
}

/// Counts queries, too.
fn plugin() -> SbbkPlugin {
    let mut config = SbbkConfig::default();
    config.count_queries = true;
    SbbkPlugin::new(SbbkDispatcher::new(config))
}

fn stats(app: &App) -> SbbkStats {
    app.world().resource::<Sbbk>().stats()
}

fn cuboid(half_extents: Vec3) -> Collider {
    let (vertices, indices) = Cuboid::new(half_extents).to_trimesh();
    Collider::trimesh(vertices, indices).unwrap()
}

fn ball(radius: f32, segments: u32) -> Collider {
    let (vertices, indices) = Ball::new(radius).to_trimesh(segments, segments / 2);
    Collider::trimesh(vertices, indices).unwrap()
}

/// A floor, and a stack of mesh cubes with a mesh ball on top.
fn spawn_scene(app: &mut App) -> Vec<Entity> {
    let world = app.world_mut();
    let floor = Transform::from_xyz(0.0, -0.5, 0.0);
    world.spawn((RigidBody::Fixed, cuboid(Vec3::new(10.0, 0.5, 10.0)), floor));
    let cubes = (0..3).map(|index| (cuboid(Vec3::splat(0.5)), 0.6 + 1.1 * index as f32));
    let bodies = cubes.chain([(ball(0.5, 24), 4.5)]);
    let bodies: Vec<_> = bodies.collect();
    let spawn = |(collider, height)| {
        let place = Transform::from_xyz(0.0, height, 0.0);
        world.spawn((RigidBody::Dynamic, collider, place)).id()
    };
    bodies.into_iter().map(spawn).collect()
}

fn places(app: &App, bodies: &[Entity]) -> Vec<Vec3> {
    bodies.iter().map(|&body| app.world().get::<Transform>(body).unwrap().translation).collect()
}

fn default_context(app: &mut App) -> Entity {
    let mut contexts = app.world_mut().query_filtered::<Entity, With<DefaultRapierContext>>();
    contexts.single(app.world()).unwrap()
}

fn run(app: &mut App, steps: usize) {
    (0..steps).for_each(|_| app.update());
}

fn is_near(place: Vec3, height: f32) -> bool {
    (place - Vec3::new(0.0, height, 0.0)).length() < 0.05
}

/// Would catch a plugin that sets nothing: the numbers are those of the dispatcher in use.
#[test]
fn sbbk_answers_where_stock_did() {
    let (mut stock, mut sbbk) = (app(None), app(Some(plugin())));
    let bodies = [&mut stock, &mut sbbk].map(spawn_scene);
    run(&mut stock, 60);
    run(&mut sbbk, 60);
    let [with_stock, with_sbbk] = [places(&stock, &bodies[0]), places(&sbbk, &bodies[1])];
    assert!(stock.world().get_resource::<Sbbk>().is_none());
    assert!(with_sbbk.iter().zip([0.5, 1.5, 2.5]).all(|(&p, y)| is_near(p, y)), "{with_sbbk:?}");
    assert!(with_sbbk.iter().chain(&with_stock).all(|p| p.is_finite() && p.y > 0.3));
    let stats = stats(&sbbk);
    assert!(stats.pairs >= 4 && stats.queries > 8 && stats.solids >= 3, "{stats:?}");
    assert_eq!(stats.unsupported_queries, 0);
}

/// Contexts that come later, that are replaced in the midst of a run, and that keep their own.
#[test]
fn all_contexts_have_the_dispatcher() {
    let mut app = app(Some(plugin()));
    let context = (RapierContextSimulation::default(), RapierConfiguration::new(1.0));
    let later = app.world_mut().spawn(context).id();
    let context =
        (RapierContextSimulation::default(), RapierConfiguration::new(1.0), StockContacts);
    let stock = app.world_mut().spawn(context).id();
    let mut pairs = 0;
    for (context, is_answered) in [(later, true), (stock, false)] {
        let bodies = spawn_scene(&mut app);
        let colliders: Vec<Entity> =
            app.world_mut().query_filtered::<Entity, With<Collider>>().iter(app.world()).collect();
        for entity in colliders {
            app.world_mut().entity_mut(entity).insert(RapierContextEntityLink(context));
        }
        run(&mut app, 30);
        let now = stats(&app).pairs;
        assert_eq!(now > pairs, is_answered, "{now} after {pairs}");
        pairs = now;
        assert!(places(&app, &bodies).iter().all(|place| place.y > 0.3));
        let entities: Vec<Entity> =
            app.world_mut().query_filtered::<Entity, With<Collider>>().iter(app.world()).collect();
        entities.into_iter().for_each(|entity| app.world_mut().entity_mut(entity).despawn());
        app.update();
    }
    let default = default_context(&mut app);
    app.world_mut().entity_mut(default).insert(RapierContextSimulation::default());
    spawn_scene(&mut app);
    run(&mut app, 30);
    assert!(stats(&app).pairs > pairs);
}

/// In the midst of a run: contacts stay, and SBBK takes over.
#[test]
fn a_running_context_can_be_taken_over() {
    let mut app = app(Some(plugin()));
    let context = default_context(&mut app);
    app.world_mut().entity_mut(context).insert(StockContacts);
    // Stock's until now: the first update has set the dispatcher.
    app.world_mut().entity_mut(context).insert(RapierContextSimulation::default());
    let bodies = spawn_scene(&mut app);
    run(&mut app, 40);
    assert_eq!(stats(&app).pairs, 0);
    app.world_mut().entity_mut(context).remove::<StockContacts>();
    run(&mut app, 60);
    assert!(stats(&app).pairs > 0);
    assert!(places(&app, &bodies).iter().all(|place| place.y > 0.3));
}

/// Also of a scaled collider, and of one whose shape changes; gone with the collider.
#[test]
fn meshes_are_prepared_when_colliders_are_added() {
    const LARGE: u32 = 160; // 25,280 triangles: no tree unasked
    for (is_prepared, plugin) in [(true, plugin()), (false, plugin().without_preparing())] {
        let mut app = app(Some(plugin));
        let scaled = Transform::from_scale(Vec3::splat(2.0));
        let large = app.world_mut().spawn((RigidBody::Fixed, ball(0.5, LARGE), scaled)).id();
        let primitive = app.world_mut().spawn(Collider::ball(0.5)).id();
        app.world_mut().spawn((
            RigidBody::Dynamic,
            ball(0.5, 24),
            Transform::from_xyz(0.0, 1.7, 0.0),
        ));
        run(&mut app, 60);
        assert_eq!(app.world().get::<SbbkTree>(large).is_some(), is_prepared);
        assert!(app.world().get::<SbbkTree>(primitive).is_none());
        let stats_now = stats(&app);
        // Trees of both, found by all queries, or walks without.
        assert_eq!(stats_now.internals.walks == 0, is_prepared, "{stats_now:?}");
        assert_eq!(stats_now.solids, if is_prepared { 2 } else { 1 }, "{stats_now:?}");
        let other = Sbbk(SbbkDispatcher::default());
        app.insert_resource(other.clone());
        run(&mut app, 1);
        assert_eq!(other.stats().trees > 0, is_prepared, "another dispatcher");
        app.world_mut().entity_mut(large).insert(Collider::ball(1.0));
        run(&mut app, 2);
        assert!(app.world().get::<SbbkTree>(large).is_none());
    }
}
