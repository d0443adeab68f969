use crate::prelude::*;

/// A head that falls on a floor and comes to rest: where it is, step by step.
fn fall(floor: SharedShape, dispatcher: Option<SbbkDispatcher>) -> Vec<Pose> {
    let head = mesh::monkey_head().shape();
    let mut world = bodies_above(floor, &head, [Vec3::new(0.3, 1.6, -0.2)], 2.0, dispatcher);
    let step = |_| {
        world.step(1);
        world.poses()[0]
    };
    (0..600).map(step).collect()
}

/// Would catch contacts that flicker, sink in or do not hold a body at rest: ten seconds on a
/// floor, beside stock. A head rolls to where it likes, which is chaos; so heights and speeds are
/// compared, not places.
#[test]
fn a_head_rests_on_a_floor_as_with_stock() {
    for shape in [SharedShape::cuboid(50.0, 0.25, 50.0), SharedShape::halfspace(Vec3::Y)] {
        let dispatcher = every();
        let stock = fall(shape.clone(), None);
        let sbbk = fall(shape, Some(dispatcher.clone()));
        let apart = |i: usize| (stock[i].translation - sbbk[i].translation).length();
        assert!((0..40).all(|i| apart(i) < 1e-4), "apart at the first touch: {}", apart(39));
        for poses in [&stock, &sbbk] {
            let moved = (poses[599].translation - poses[540].translation).length();
            assert!(moved < 0.02, "moves by {moved} in the last second");
        }
        let height = stock[599].translation.y - sbbk[599].translation.y;
        assert!(height.abs() < 0.02, "{height} higher");
        assert!(dispatcher.stats().queries > 30, "SBBK did not answer");
    }
}

/// A cone of radius 0.4 with so many corners around its base.
fn pyramid(corners: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let around = (0..corners).map(|i| {
        let (sin, cos) = (TAU * i as f32 / corners as f32).sin_cos();
        Vec3::new(0.4 * cos, -0.4, 0.4 * sin)
    });
    let [base, top] = [-0.4, 0.4].map(|y| Vec3::new(0.0, y, 0.0));
    let side = |i: u32| [[i, corners, (i + 1) % corners], [(i + 1) % corners, corners + 1, i]];
    (around.chain([top, base]).collect(), (0..corners).flat_map(side).collect())
}

/// Cones, cylinders, hulls and meshes with round bases, on a ground whose triangles are as large as
/// they are.
///
/// Would catch bodies that roll on one point of a rim, or between points that hover. Up to half of
/// them were awake.
#[test]
fn discs_on_uneven_ground_fall_asleep() {
    let ground = mesh::terrain(20.0, 20, 0.6).shape();
    let (points, triangles) = pyramid(32);
    let shapes = [
        SharedShape::cone(0.4, 0.4),
        SharedShape::cylinder(0.4, 0.4),
        SharedShape::convex_hull(&points).unwrap(),
        SharedShape::trimesh(points, triangles).unwrap(),
    ];
    for shape in shapes {
        let awake = [0.0, 0.26, 0.52].map(|aside| {
            let place = |i: usize| {
                let [row, column] = [i / 6, i % 6].map(|i| i as f32);
                Vec3::new(1.9 * column - 4.9 + aside, 1.5, 1.7 * row - 4.2)
            };
            let (places, dispatcher) = ((0..36).map(place), Some(SbbkDispatcher::default()));
            let mut world = bodies_above(ground.clone(), &shape, places, 1.0, dispatcher);
            world.step(900);
            world.awake()
        });
        let all: usize = awake.iter().sum();
        assert!(all <= 27, "{awake:?} of three times 36 {:?} are awake", shape.shape_type());
    }
}
