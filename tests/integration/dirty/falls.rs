use super::*;
use rapier3d::parry::shape::Capsule;

/// Flat grounds at height 0.
fn grounds() -> [(&'static str, SharedShape); 9] {
    let floor = mesh::floor(20.0, 30);
    let slab = mesh::slab(Vec3::new(10.0, 0.5, 10.0), [30, 1, 30]).mapped(|v| v - 0.5 * Vec3::Y);
    // Bodies fall on the cell in the middle.
    let coarse = mesh::slab(Vec3::new(10.0, 0.5, 10.0), [7, 1, 7]).mapped(|v| v - 0.5 * Vec3::Y);
    let field = SharedShape::heightfield(Array2::repeat(31, 31, 0.0), Vec3::new(20.0, 1.0, 20.0));
    [
        ("slab", slab.shape()),
        ("slab inside out", mesh::turned_inside_out(slab.clone()).shape()),
        ("slab with a turned cell", mesh::turned_near(&coarse, Vec3::ZERO, 2.1).shape()),
        ("sheet", floor.shape()),
        ("sheet that faces down", mesh::turned_inside_out(floor.clone()).shape()),
        ("sheet of any winding", mesh::random_winding(&floor, 1).shape()),
        ("sheet of two triangles", mesh::floor(20.0, 1).shape()),
        ("strips", mesh::strips(20.0, 12, 1).shape()),
        ("height field", field),
    ]
}

/// Round bodies and a box. No side of their boxes is longer than a unit.
fn bodies() -> [Mesh; 4] {
    let (vertices, triangles) = Capsule::new_y(0.3, 0.2).to_trimesh(16, 8);
    let profile = [[0.0, -0.3], [0.3, -0.3], [0.3, 0.3], [0.0, 0.3]].map(Vec2::from_array);
    [
        mesh::ball(0.4, 8),
        Mesh::new("capsule", vertices, triangles),
        mesh::revolved(&profile, 24).named("cylinder"),
        mesh::cuboid(Vec3::new(0.4, 0.3, 0.35), 2).named("box"),
    ]
}

/// Drops a body without friction. Returns its greatest horizontal speed, and its depth at the end.
fn fall(ground: &SharedShape, body: &Mesh, random: &mut Rand32) -> [Real; 2] {
    let smooth = |shape: SharedShape| ColliderBuilder::new(shape).friction(0.0);
    let world = world(smooth(ground.clone()));
    let [x, z, y] = [(); 3].map(|()| random.rand_float());
    let pose = Pose3::from_parts(Vec3::new(x, 3.0 + y, z), rotation(random));
    let falling = RigidBodyBuilder::dynamic().pose(pose);
    let mut fastest: Real = 0.0;
    let look = |body: &RigidBody| fastest = fastest.max(body.linvel().with_y(0.0).length());
    let end = watched(240, world, falling, smooth(body.shape()), look);
    [fastest, -lowest(body, end.position())]
}

/// Would catch contacts aslant to a flat ground: without friction they alone push bodies aside. At
/// 8 m/s a step takes a body 13 cm into the ground.
#[test]
fn meshes_that_fall_on_flat_grounds_are_not_kicked_aside() {
    for (name, ground) in grounds() {
        for body in bodies() {
            let mut random = Rand32::new(21);
            let falls = [(); 16].map(|()| fall(&ground, &body, &mut random));
            let [speed, depth] =
                [0, 1].map(|i| falls.iter().map(|fall| fall[i]).fold(0.0, Real::max));
            println!("{} on a {name}: {speed:.3} m/s aside, {:.1} mm deep", body.name, 1e3 * depth);
            let is_there = |[_, depth]: &[Real; 2]| (-0.05..0.005).contains(depth);
            assert!(speed < 0.01 && falls.iter().all(is_there), "{} on a {name}", body.name);
        }
    }
}
