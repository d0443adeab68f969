use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d::parry::shape::TriMeshFlags;
use sbbk_testkit::mesh;

use super::table::{Case, judge};
use super::{FLAGS, prepared_world, row, world};
use crate::worlds::after;

/// Half the side of a room, and of a body in it.
const ROOM: f32 = 3.0;
const BODY: f32 = 0.4;

fn bodies(flags: TriMeshFlags) -> [(&'static str, SharedShape); 4] {
    [
        ("mesh cube", mesh::cuboid(Vec3::splat(BODY), 2).shape_with(flags)),
        ("mesh ball", mesh::ball(BODY, 6).shape_with(flags)),
        ("cuboid", SharedShape::cuboid(BODY, BODY, BODY)),
        ("ball", SharedShape::ball(BODY)),
    ]
}

/// Would catch rooms whose walls push bodies out through them. A room is a closed box that faces
/// outward.
#[test]
fn bodies_stay_in_rooms() {
    let mut cases = Vec::new();
    let settings = [1, 5, 30, 40]
        .into_iter()
        .flat_map(|cells| [false, true].map(|is_prepared| (cells, is_prepared)));
    for ((cells, is_prepared), flags) in
        settings.flat_map(|setting| FLAGS.map(|flags| (setting, flags)))
    {
        let room = mesh::cuboid(Vec3::splat(ROOM), cells).shape_with(flags);
        let (mut world, prepared) = prepared_world(&[&room], is_prepared);
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(room));
        let bodies = bodies(flags).map(|(name, shape)| (name, ColliderBuilder::new(shape)));
        let mut at = Vec3::new(-1.8, 0.1, 0.17);
        let bodies = bodies.map(|(name, collider)| {
            at.x += 0.9;
            (name, world.insert(RigidBodyBuilder::dynamic().translation(at), collider).0)
        });
        (0..240).for_each(|_| world.step());
        let how = if is_prepared { ", prepared" } else { "" };
        let name = row(&format!("{} triangles{how}", 12 * cells * cells), flags);
        for (column, body) in bodies {
            let height = world.bodies[body].translation().y;
            let is_right = (height - BODY + ROOM).abs() < 0.05;
            let shown = format!("{height:.2}");
            cases.push(Case { row: name.clone(), column, shown, is_right });
        }
        drop(prepared);
    }
    judge("height of a body in a room with its floor at -3, after 4 s", &cases, &[]);
}

/// Balls in tubes whose open ends are far apart. Would catch tubes that push balls out, as if these had sunk in.
#[test]
fn bodies_stay_in_long_tubes() {
    const RADIUS: f32 = 1.0;
    for half_width in [2.0, 5.0, 20.0] {
        let tube = mesh::tube(RADIUS, half_width, 48);
        for tube in [mesh::turned_inside_out(tube.clone()), tube] {
            let world = world(ColliderBuilder::new(tube.shape()));
            let ball = ColliderBuilder::new(mesh::ball(BODY, 12).shape());
            let height = after(240, world, RigidBodyBuilder::dynamic(), ball).translation().y;
            assert!((height - BODY + RADIUS).abs() < 0.05, "{height} in a tube of {half_width}");
        }
    }
}
