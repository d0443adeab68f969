use crate::prelude::*;
use rapier3d::parry::shape::CompoundFlags;

/// Compounds of parts of every kind, of boxes that share faces, of one part, and one that reaches
/// far.
pub fn compounds(size: Real) -> Vec<(&'static str, Compound)> {
    let mut random = Rand32::new(1);
    let half = 0.25 * size;
    let cloud: Vec<Vec3> = (0..20).map(|_| half * direction(&mut random)).collect();
    let parts = [
        SharedShape::ball(half),
        SharedShape::cuboid(half, 0.7 * half, 0.5 * half),
        SharedShape::capsule_y(half, 0.4 * half),
        SharedShape::cylinder(half, 0.6 * half),
        SharedShape::cone(half, 0.6 * half),
        SharedShape::convex_hull(&cloud).expect("a cloud has a hull"),
        SharedShape::round_cuboid(half, 0.5 * half, 0.5 * half, 0.1 * size),
        SharedShape::triangle(cloud[0], cloud[1], cloud[2]),
    ];
    let mut place =
        |spread: Real| Pose::from_parts(spread * direction(&mut random), rotation(&mut random));
    let mixed = parts.iter().map(|part| (place(0.5 * size), part.clone())).collect();
    let wide = (0..40).map(|i| (place(3.0 * size), parts[i % parts.len()].clone())).collect();
    let row = |flags| {
        let part = |i: i32| {
            let at = Pose::translation(2.0 * half * (i - 2) as Real, 0.0, 0.0);
            (at, SharedShape::cuboid(half, half, half))
        };
        Compound::with_flags((0..5).map(part).collect(), flags, None)
    };
    vec![
        ("mixed", Compound::new(mixed)),
        ("wide", Compound::new(wide)),
        ("row", row(CompoundFlags::empty())),
        ("row without inner faces", row(CompoundFlags::FIX_INTERNAL_EDGES)),
        ("one part", Compound::new(vec![(place(0.1), parts[1].clone())])),
    ]
}

/// Would catch parts that are left out, and poses or numbers of parts mixed up.
#[test]
fn contacts_are_those_of_each_part_by_itself() {
    let head = shape(&mesh::monkey_head());
    for size in [0.6, 3.0] {
        for (name, compound) in compounds(size).into_iter().filter(|(name, _)| !name.contains(' '))
        {
            let dispatcher = per_triangle();
            let mut random = Rand32::new(2);
            let (mut count, mut part_count) = (0, 0);
            for i in 0..24 {
                let depth = [0.0, -0.05, -0.3, 0.01][i % 4];
                let pose = touching_shapes(&mut random, [&head, &compound], 12.0, -depth);
                let (prediction, flipped) = ([0.02, 0.1, 0.02][i % 3], i % 8 < 4);
                let question =
                    Question::new(&head, &compound, pose).within(prediction).flipped(flipped);
                let named = |m: &Manifold, part: Option<u32>| {
                    let [triangle, other] = question.subshapes(m);
                    ([triangle, part.unwrap_or(other)], distance(m))
                };
                let found = question.fresh(&dispatcher);
                let found: BTreeMap<_, _> = found.iter().map(|m| named(m, None)).collect();
                let mut expected = BTreeMap::new();
                for (index, (at, part)) in (0..).zip(compound.shapes()) {
                    let part = Question::new(&head, &**part, pose * *at).within(prediction);
                    let near = part.flipped(flipped).fresh(&dispatcher);
                    expected.extend(near.iter().map(|m| named(m, Some(index))));
                }
                // The pose of a part is rounded.
                let tolerance = 2e-6 * size.max(1.0) * 10.0;
                for (one, other) in [(&found, &expected), (&expected, &found)] {
                    for (names, distance) in one {
                        let off = other.get(names).map(|other| (other - distance).abs());
                        let is_at_limit = prediction - distance < tolerance;
                        assert!(
                            off.map_or(is_at_limit, |off| off < tolerance),
                            "{name} of {size}: {names:?} at {distance}, off by {off:?}"
                        );
                    }
                }
                count += found.len();
                let parts: BTreeSet<u32> = found.keys().map(|[_, part]| *part).collect();
                part_count = part_count.max(parts.len());
            }
            assert!(count > 25, "{name} of {size}: {count} contacts");
            assert!(part_count > 1, "{name}: one part at a time");
        }
    }
}

/// Would catch contacts that flicker, sink in or do not hold a body at rest.
#[test]
fn compounds_rest_on_a_mesh_as_with_stock() {
    let dispatcher = every();
    let mut stock = dumbbells(None);
    let mut sbbk = dumbbells(Some(dispatcher.clone()));
    stock.step(300);
    sbbk.step(300);
    let before = sbbk.poses();
    stock.step(100);
    sbbk.step(100);
    for ((before, after), stock) in before.iter().zip(sbbk.poses()).zip(stock.poses()) {
        let moved = (before.translation - after.translation).length();
        assert!(moved < 0.02, "moves by {moved}");
        let apart = (stock.translation - after.translation).length();
        assert!(apart < 0.3, "{apart} from where it rests with stock");
        assert!(after.translation.y > 0.0, "{after:?}");
    }
    let stats = dispatcher.stats();
    assert!(stats.queries > 50 && stats.unsupported_queries == 0, "SBBK did not answer: {stats:?}");
}

/// Would catch a part that stands for another one of the same compound, which has many.
#[test]
fn each_of_many_parts_is_where_it_is() {
    let floor = shape(&mesh::floor(200.0, 40));
    let part = |i: i32| {
        let at = Vec3::new((i % 13) as Real * 3.0, 0.001 * i as Real, (i / 13) as Real * 3.0);
        (Pose::from_translation(at), SharedShape::cuboid(0.5, 0.5, 0.5))
    };
    let compound = Compound::new((0..130).map(part).collect());
    let pose = Pose::translation(-20.0, 0.45, -15.0);
    let question = Question::new(&floor, &compound, pose).within(0.2);
    let mut nearest = vec![Real::INFINITY; 130];
    for manifold in question.fresh(&every()) {
        let nearest = &mut nearest[manifold.subshape2 as usize];
        *nearest = nearest.min(distance(&manifold));
    }
    for (i, distance) in nearest.into_iter().enumerate() {
        assert!((distance - (0.001 * i as Real - 0.05)).abs() < 1e-4, "part {i} at {distance}");
    }
}

/// A compound whose parts are far out, and a long mesh on a half-space, turn a little at a time.
/// Would catch contacts lost as the ball that is to hold what moves is too small.
#[test]
fn far_parts_keep_their_contacts_while_a_body_turns() {
    let floor = shape(&mesh::floor(40.0, 160));
    let bar = shape(&mesh::slab(Vec3::new(10.0, 0.3, 0.3), [20, 1, 1]));
    let part = |sign: Real| {
        let at = sign * Vec3::new(8.0, 0.0, 8.0);
        (Pose::from_translation(at), SharedShape::cuboid(0.3, 0.3, 0.3))
    };
    let compound = Compound::new(vec![part(1.0), part(-1.0)]);
    let half_space = SharedShape::halfspace(Vec3::Y);
    let dispatcher = every();
    let mut touched = 0;
    for (mesh, other, at, axis) in [
        (&floor, &compound as &dyn Shape, Vec3::new(0.1, 0.29, 0.2), Vec3::Y),
        // In the frame of the mesh.
        (&bar, &*half_space as &dyn Shape, Vec3::new(0.0, -2.0, 0.0), Vec3::Z),
    ] {
        for sign in [1.0, -1.0] {
            let mut pair: Pair = Pair::default();
            for step in 0..600 {
                let turn = Quat::from_axis_angle(axis, 0.0005 * sign * step as Real);
                let pose = if std::ptr::eq(mesh, &floor) {
                    Pose::from_parts(at, turn)
                } else {
                    Pose::from_parts(Vec3::ZERO, turn) * Pose::from_translation(at)
                };
                let question = Question::new(mesh, other, pose);
                pair.ask(&dispatcher, &question);
                let expected = sequence(&question.fresh(&dispatcher));
                assert_eq!(sequence(&pair.manifolds), expected, "step {step}");
                touched += pair.manifolds.len();
            }
        }
    }
    assert!(touched > 100, "{touched}");
}

/// Cubes look the same after quarter turns. Would catch normals of parts with different axes that
/// are compared.
#[test]
fn parts_touch_a_mesh_alike_whichever_axes_they_have() {
    let table = |turns: [Quat; 2]| {
        let leg = |i: usize| {
            let at = Vec3::Z * [0.8, -0.8][i];
            (Pose::from_parts(at, turns[i]), SharedShape::cuboid(0.2, 0.2, 0.2))
        };
        Compound::new((0..2).map(leg).collect())
    };
    let quarters = [Vec3::X, Vec3::Y, Vec3::Z]
        .map(|axis| [1.0, 2.0, 3.0].map(|turns| Quat::from_axis_angle(axis, turns * FRAC_PI_2)));
    let plain = table([Quat::IDENTITY; 2]);
    let box_with_wall = mesh::walled_box(Vec3::new(2.0, 0.5, 2.0), 4);
    let mut random = Rand32::new(4);
    for ground in [mesh::floor(4.0, 8), box_with_wall] {
        let (top, ground) = (ground.bounds().maxs.y, shape(&ground));
        for i in 0..300 {
            let at = |random: &mut Rand32| 2.2 * (2.0 * random.rand_float() - 1.0);
            let at = Vec3::new(at(&mut random), top + 0.193, at(&mut random));
            let turn = if i % 2 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
            let turned = table([Quat::IDENTITY, quarters[i % 3][i / 3 % 3]]);
            let contacts = |compound: &Compound| {
                let pose = Pose::from_parts(at, turn);
                let found = Question::new(&ground, compound, pose).fresh(&every());
                let of = |m: &Manifold| (triangles(m), distance(m), m.local_n1);
                found.iter().map(of).collect::<Vec<_>>()
            };
            let [expected, found] = [&plain, &turned].map(contacts);
            let is_same = expected.len() == found.len()
                && expected.iter().zip(&found).all(|(a, b)| {
                    a.0 == b.0 && (a.1 - b.1).abs() < 1e-4 && a.2.distance(b.2) < 1e-3
                });
            assert!(is_same, "{i} at {at}: {expected:?}\n{found:?}");
        }
    }
}
