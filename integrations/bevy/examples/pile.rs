//! Mesh tori fall into a pile: with SBBK, or with stock Rapier.
//!
//! ```text
//! cargo run --release --ignore-rust-version --example pile --features window [-- stock]
//! ```

use bevy::prelude::*;
use bevy_rapier_sbbk::rapier_integration::draw;
use bevy_rapier_sbbk::{SbbkPlugin, SbbkTree};
use bevy_rapier3d::prelude::*;

/// Which layer of the trees to draw.
const LAYER: u32 = 5;

fn main() {
    let mut app = App::new();
    app.add_plugins((DefaultPlugins, RapierPhysicsPlugin::<NoUserData>::default()));
    if !std::env::args().any(|argument| argument == "stock") {
        app.add_plugins(SbbkPlugin::default()).add_systems(Update, draw_trees);
    }
    app.add_systems(Startup, spawn).run();
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let eye = Transform::from_xyz(7.0, 5.0, 9.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((Camera3d::default(), eye));
    let sun = Transform::from_xyz(4.0, 8.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y);
    commands.spawn((DirectionalLight { shadow_maps_enabled: true, ..default() }, sun));

    let floor = Cuboid::new(20.0, 1.0, 20.0).mesh().build();
    let torus = Torus { minor_radius: 0.2, major_radius: 0.5 }.mesh().build();
    let mut spawn = |mesh: Mesh, body: RigidBody, place: Transform, colour: Color| {
        let collider = collider(&mesh);
        let look = (Mesh3d(meshes.add(mesh)), MeshMaterial3d(materials.add(colour)));
        commands.spawn((look, body, collider, place));
    };
    spawn(floor, RigidBody::Fixed, Transform::from_xyz(0.0, -0.5, 0.0), Color::hsl(90.0, 0.2, 0.5));
    for index in 0..60 {
        let [x, z] = [index % 3, index / 3 % 2].map(|place| 0.7 * place as f32 - 0.7);
        let place = Transform::from_xyz(x, 1.0 + 0.3 * index as f32, z)
            .with_rotation(Quat::from_rotation_x(0.5 + 0.3 * index as f32));
        let colour = Color::hsl(6.0 * index as f32, 0.7, 0.6);
        spawn(torus.clone(), RigidBody::Dynamic, place, colour);
    }
}

/// A mesh as a collider: Rapier welds the vertices that Bevy doubles for normals.
fn collider(mesh: &Mesh) -> Collider {
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION).and_then(|values| values.as_float3());
    let positions = positions.expect("meshes of shapes have positions");
    let vertices = positions.iter().map(|&position| Vec3::from(position)).collect();
    let indices: Vec<u32> = mesh.indices().expect("and indices").iter().map(|i| i as u32).collect();
    let triangles = indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]);
    let flags = TriMeshFlags::MERGE_DUPLICATE_VERTICES;
    Collider::trimesh_with_flags(vertices, triangles.collect(), flags).expect("it has triangles")
}

fn draw_trees(mut gizmos: Gizmos, trees: Query<(&SbbkTree, &GlobalTransform, &RigidBody)>) {
    for (tree, place, _) in trees.iter().filter(|(.., body)| **body == RigidBody::Dynamic).take(1) {
        let (_, rotation, translation) = place.to_scale_rotation_translation();
        let pose = bevy_rapier3d::rapier::math::Pose::from_parts(translation, rotation);
        draw::layer(tree.tree(), LAYER, &pose, |a, b, [h, s, l, alpha]| {
            gizmos.line(a, b, Color::hsla(h, s, l, alpha));
        });
    }
}
