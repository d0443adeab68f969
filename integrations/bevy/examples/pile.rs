//! Mesh tori fall into a pile: with SBBK, or with stock Rapier.
//!
//! ```text
//! cargo run --release --ignore-rust-version --example pile
//! cargo run --release --ignore-rust-version --features window --example pile [-- stock]
//! ```
//!
//! Without the feature `window`, or with `-- --headless SECONDS`, the same app runs with both and
//! without a window, and prints what it measured.

use std::f32::consts::TAU;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::time::{TimePlugin, TimeUpdateStrategy};
use bevy_rapier_sbbk::{Sbbk, SbbkPlugin};
use bevy_rapier3d::prelude::*;

const TORI: usize = 60;
const RADII: [f32; 2] = [0.5, 0.2];
/// Along and around the tube.
const SEGMENTS: [u32; 2] = [32, 24];
const STEP: f32 = 1.0 / 60.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let headless = arguments.iter().position(|argument| argument == "--headless");
    let seconds = headless.and_then(|index| arguments.get(index + 1)?.parse().ok());
    #[cfg(feature = "window")]
    if headless.is_none() {
        return window(arguments.iter().any(|argument| argument == "stock"));
    }
    for is_stock in [true, false] {
        measure(is_stock, seconds.unwrap_or(5.0));
    }
}

/// The app without a window, as fast as it goes.
fn measure(is_stock: bool, seconds: f32) {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, TimePlugin));
    app.insert_resource(TimestepMode::Fixed { dt: STEP, substeps: 1 });
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(STEP)));
    build(&mut app, is_stock);
    app.finish();
    let start = Instant::now();
    let steps = (seconds / STEP).round() as u32;
    (0..steps).for_each(|_| app.update());
    let step = 1e3 * start.elapsed().as_secs_f64() / f64::from(steps.max(1));
    let mut tori = app.world_mut().query_filtered::<&Transform, With<Velocity>>();
    let heights: Vec<f32> = tori.iter(app.world()).map(|place| place.translation.y).collect();
    let fallen = heights.iter().filter(|height| **height < 0.0).count();
    let top = heights.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut contexts = app.world_mut().query::<&RapierContextSimulation>();
    let pairs = contexts.iter(app.world()).flat_map(|c| c.narrow_phase.contact_pairs());
    let touching = pairs.filter(|pair| pair.has_any_active_contact()).count();
    let name = if is_stock { "stock" } else { "SBBK " };
    println!(
        "{name}: {TORI} tori of {} triangles, {steps} steps: {step:.2} ms a step; {touching} pairs \
         touch, the highest is at {top:.2}, {fallen} fell through the floor",
        2 * SEGMENTS[0] * SEGMENTS[1],
    );
    if let Some(sbbk) = app.world().get_resource::<Sbbk>() {
        let stats = sbbk.stats();
        println!("       {} pairs answered, {} solids", stats.pairs, stats.solids);
    }
}

fn build(app: &mut App, is_stock: bool) {
    app.add_plugins(RapierPhysicsPlugin::<NoUserData>::default());
    if !is_stock {
        app.add_plugins(SbbkPlugin::default());
    }
    app.add_systems(Startup, spawn);
}

fn spawn(mut commands: Commands) {
    let floor = Transform::from_xyz(0.0, -0.5, 0.0);
    commands.spawn((RigidBody::Fixed, Collider::cuboid(20.0, 0.5, 20.0), floor));
    let (vertices, triangles) = torus();
    let collider = Collider::trimesh(vertices, triangles).expect("it has triangles");
    for index in 0..TORI {
        let [x, z] = [index % 3, index / 3 % 2].map(|place| 0.7 * place as f32 - 0.7);
        let place = Transform::from_xyz(x, 1.0 + 0.3 * index as f32, z)
            .with_rotation(Quat::from_rotation_x(0.5 + 0.3 * index as f32));
        commands.spawn((RigidBody::Dynamic, collider.clone(), place, Velocity::zero()));
    }
}

fn torus() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let [along, around] = SEGMENTS;
    let place = |i: u32, j: u32| (i % along) * around + j % around;
    let cells = (0..along).flat_map(|i| (0..around).map(move |j| (i, j)));
    let vertices = cells.clone().map(|(i, j)| {
        let [(sin, cos), (rise, out)] = [(i, along), (j, around)]
            .map(|(index, count)| (TAU * index as f32 / count as f32).sin_cos());
        let radius = RADII[0] + RADII[1] * out;
        Vec3::new(radius * cos, RADII[1] * rise, -radius * sin)
    });
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (vertices.collect(), triangles.collect())
}

/// The app with a window: the bodies as Bevy's meshes, and a layer of the tree of one.
#[cfg(feature = "window")]
fn window(is_stock: bool) {
    use bevy::asset::RenderAssetUsages;
    use bevy::mesh::{Indices, PrimitiveTopology};
    use bevy_rapier_sbbk::SbbkTree;
    use bevy_rapier_sbbk::rapier_integration::draw;

    /// Which layer of the tree to draw.
    const LAYER: u32 = 5;

    fn look(
        mut commands: Commands,
        mut meshes: ResMut<Assets<Mesh>>,
        mut materials: ResMut<Assets<StandardMaterial>>,
        bodies: Query<(Entity, &RigidBody)>,
    ) {
        let eye = Transform::from_xyz(7.0, 5.0, 9.0).looking_at(Vec3::Y, Vec3::Y);
        commands.spawn((Camera3d::default(), eye));
        let sun = Transform::from_xyz(4.0, 8.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y);
        commands.spawn((DirectionalLight { shadow_maps_enabled: true, ..default() }, sun));
        let floor = meshes.add(Cuboid::new(40.0, 1.0, 40.0));
        let (vertices, triangles) = torus();
        let torus = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vertices)
            .with_inserted_indices(Indices::U32(triangles.into_flattened()));
        let torus = meshes.add(torus.with_computed_normals());
        for (index, (entity, body)) in bodies.iter().enumerate() {
            let (mesh, colour) = match body {
                RigidBody::Fixed => (&floor, Color::hsl(90.0, 0.2, 0.5)),
                _ => (&torus, Color::hsl(6.0 * index as f32, 0.7, 0.6)),
            };
            let look = (Mesh3d(mesh.clone()), MeshMaterial3d(materials.add(colour)));
            commands.entity(entity).insert(look);
        }
    }

    fn draw_tree(mut gizmos: Gizmos, trees: Query<(&SbbkTree, &GlobalTransform)>) {
        if let Some((tree, place)) = trees.iter().next() {
            let (_, rotation, translation) = place.to_scale_rotation_translation();
            let pose = bevy_rapier3d::rapier::math::Pose::from_parts(translation, rotation);
            draw::layer(tree.tree(), LAYER, &pose, |a, b, [h, s, l, alpha]| {
                gizmos.line(a, b, Color::hsla(h, s, l, alpha));
            });
        }
    }

    let mut app = App::new();
    app.add_plugins(DefaultPlugins);
    build(&mut app, is_stock);
    app.add_systems(PostStartup, look).add_systems(Update, draw_tree).run();
}
