use crate::prelude::*;

/// Half the width of a body's base, and half its height.
const HALF: Real = 0.2;
const HIGH: Real = 0.15;

/// A floor of this many cells a side that ends at a wall at `x = 2`, turned.
fn corner(cells: u32, turn: Quat) -> SharedShape {
    let floor = mesh::floor(4.0, cells);
    let wall = floor.clone().mapped(|v| Vec3::new(2.0, 2.0 + v.x, -v.z));
    Mesh::merged("corner", &[floor, wall]).welded().mapped(|v| turn * v).shape()
}

/// A pyramid, or a frustum of one. Widest at the base.
fn frustum(top: Real) -> Vec<Vec3> {
    let base = [[HALF, HALF], [HALF, -HALF], [-HALF, HALF], [-HALF, -HALF]];
    let at = |y: Real, scale: Real| base.map(|[x, z]| Vec3::new(scale * x, y, scale * z));
    [at(-HIGH, 1.0), at(HIGH, top)].concat()
}

/// Convex bodies that are widest at the base.
fn bodies() -> [(&'static str, SharedShape); 5] {
    let cone = SharedShape::cone(HIGH, HALF);
    [
        ("cone", cone.clone()),
        ("compound", SharedShape::compound(vec![(Pose::IDENTITY, cone)])),
        ("pyramid", SharedShape::convex_hull(&frustum(0.01)).unwrap()),
        ("frustum", SharedShape::convex_hull(&frustum(0.5)).unwrap()),
        ("cylinder", SharedShape::cylinder(HIGH, HALF)),
    ]
}

/// The edge at the foot of the wall is its nearest point to these bodies, and the floor is nearer
/// still. They have sunk into the floor as far as Rapier allows, or less.
///
/// Would catch walls that are taken for ghosts of the floor. Cones walked through them.
#[test]
fn bodies_at_the_foot_of_a_wall_touch_it() {
    let (dispatcher, mut random) = (SbbkDispatcher::default(), Rand32::new(3));
    for (cells, angle) in [(1, 0.0), (1, 0.3), (5, 0.0), (8, 1.1)] {
        let turn = Quat::from_rotation_z(angle);
        let ground = corner(cells, turn);
        for (name, body) in bodies() {
            for past in [-0.005, 0.0015, 0.005, 0.02, 0.05] {
                for sunk in [0.002, 0.0005, 0.0, -0.002] {
                    let z = random.rand_float() - 0.5;
                    let place = Vec3::new(2.0 - HALF + past, HIGH - sunk, z);
                    let pose = Pose::from_rotation(turn) * Pose::from_translation(place);
                    let question = Question::new(&*ground, &*body, pose);
                    let found = question.fresh(&dispatcher);
                    let level = turn * Vec3::X;
                    let walls = found.iter().filter(|it| it.local_n1.dot(level).abs() > 0.9);
                    let least = walls.flat_map(|wall| &wall.points).map(|point| point.dist);
                    let least = least.fold(Real::INFINITY, Real::min);
                    let says = format!("{name}, {cells} cells, {past} past, {sunk} sunk: {least}");
                    assert!((least + past).abs() < 0.002, "{says}");
                }
            }
        }
    }
}
