//! A few manifolds for all contacts of two shapes, beside every contact at the same pose.

use crate::heightfield::terrain::rolling;
use crate::prelude::*;
use rapier3d::parry::shape::{Cone, Cylinder, PackedFeatureId};
use sbbk_testkit::scene::random::first_touch;

/// Least cosine of the normals in one patch. A cone may remove the deepest contact; the others are
/// near to its normal.
const SAME_NORMAL: Real = 0.99;
const NEAR_ONE_NORMAL: Real = 2.0 * SAME_NORMAL * SAME_NORMAL - 1.0;

/// Least cosine to a contact that touches, and distance beyond which it counts, in prediction
/// distances.
const SAME_NORMAL_OVER: Real = 0.9;
const OVER: Real = 0.1;

/// Difference of depths, in prediction distances, up to which contacts are equally deep.
const EQUALLY_DEEP: Real = 2.1e-5;

/// Points on both shapes in frame 1.
fn place(pos12: &Pose, manifold: &Manifold, point: &TrackedContact<()>) -> [Vector; 2] {
    let own = |pose: Option<&Pose>, at: Vector| pose.map_or(at, |pose| *pose * at);
    let on2 = own(manifold.subshape_pos2(), point.local_p2);
    [own(manifold.subshape_pos1(), point.local_p1), *pos12 * on2]
}

/// Panics unless `patches` stand for `every`. Says how many manifolds there are of each.
fn assert_stand_for(
    patches: &[Manifold],
    every: &[Manifold],
    pos12: &Pose,
    prediction: Real,
    what: &str,
) -> [usize; 2] {
    assert_eq!(patches.is_empty(), every.is_empty(), "{what}");
    let least = if what.starts_with("fixed") { NEAR_ONE_NORMAL } else { SAME_NORMAL };
    for patch in patches {
        assert!((1..=4).contains(&patch.points.len()), "{what}: {} points", patch.points.len());
        let is_that = |m: &&Manifold| {
            [m.subshape1, m.subshape2] == [patch.subshape1, patch.subshape2]
                && m.local_n1 == patch.local_n1
                && m.local_n2 == patch.local_n2
                && m.subshape_pos1() == patch.subshape_pos1()
                && m.subshape_pos2() == patch.subshape_pos2()
                && m.points.iter().any(|point| point.dist == distance(patch))
        };
        assert!(every.iter().any(|m| is_that(&m)), "{what}: a patch of no contact");
        for point in &patch.points {
            let is_same = |m: &&Manifold| {
                let is_there = |p: &TrackedContact<()>| {
                    p.dist == point.dist && place(pos12, m, p) == place(pos12, patch, point)
                };
                m.local_n1.dot(patch.local_n1) >= least - 1e-6 && m.points.iter().any(is_there)
            };
            assert!(every.iter().any(|m| is_same(&m)), "{what}: a point of no contact");
        }
    }
    // Each contact is in a patch that is as deep and has its direction; or far over one that
    // touches, and leans little from it.
    for contact in every {
        let is_over = |patch: &&Manifold| {
            distance(contact) > OVER * prediction
                && distance(patch) <= 0.0
                && patch.local_n1.dot(contact.local_n1) >= SAME_NORMAL_OVER - 1e-6
        };
        let is_of = |patch: &&Manifold| {
            patch.local_n1.dot(contact.local_n1) >= least - 1e-6
                && distance(patch) <= distance(contact) + EQUALLY_DEEP * prediction
                || is_over(patch)
        };
        assert!(
            patches.iter().any(|patch| is_of(&patch)),
            "{what}: no patch for {} along {}, but {:?}",
            distance(contact),
            contact.local_n1,
            patches
                .iter()
                .map(|m| (m.local_n1.dot(contact.local_n1), distance(m)))
                .collect::<Vec<_>>(),
        );
    }
    let deepest = |all: &[Manifold]| all.iter().map(distance).fold(Real::INFINITY, Real::min);
    let [of_patches, of_every] = [patches, every].map(deepest);
    let range = of_every..=of_every + EQUALLY_DEEP * prediction;
    assert!(range.contains(&of_patches), "{what}: {of_patches} and {of_every}");
    [patches.len(), every.len()]
}

/// Shapes that meet the mesh, each about 2 units across.
fn partners() -> Vec<(&'static str, SharedShape)> {
    let part = |x: Real| (Pose::translation(x, 0.0, 0.0), SharedShape::cuboid(0.3, 0.5, 0.4));
    let balls = [-0.3, 0.3].map(|x| (Pose::translation(x, 0.0, 0.0), SharedShape::ball(0.7)));
    let torus = mesh::torus(0.7, 0.3, 24, 12);
    vec![
        ("torus", torus.shape()),
        ("fixed torus", torus.shape_with(TriMeshFlags::FIX_INTERNAL_EDGES)),
        ("coarse box", mesh::cuboid(Vec3::splat(0.7), 1).shape()),
        ("balls", SharedShape::compound(balls.to_vec())),
        ("cuboid", SharedShape::cuboid(0.8, 0.5, 0.6)),
        ("capsule", SharedShape::capsule_y(0.5, 0.4)),
        ("cylinder", SharedShape::cylinder(0.6, 0.5)),
        ("half-space", SharedShape::halfspace(Vec3::Y)),
        ("compound", SharedShape::compound(vec![part(-0.6), part(0.6)])),
        ("field", SharedShape::new(rolling(4.0, 8, 0.1))),
    ]
}

/// Would catch contacts without a patch, invented points, more than four points, wrong depths,
/// names of other subshapes, and memory in the result.
#[test]
fn patches_stand_for_every_contact() {
    let head = shape(&mesh::monkey_head());
    let (every, patches) = (every(), SbbkDispatcher::default());
    let mut random = Rand32::new(5);
    for (name, partner) in partners() {
        let mut counts = [0; 2];
        for prediction in [0.002, 0.1] {
            for is_swapped in [false, true] {
                let mut pair = Pair::default();
                let mut at = Pose::IDENTITY;
                for i in 0..40 {
                    at = match i % 4 {
                        0 => {
                            let away = direction(&mut random) * (0.7 + 0.8 * random.rand_float());
                            Pose3::from_parts(away, rotation(&mut random))
                        }
                        _ => nudge(&mut random, 0.01) * at,
                    };
                    let question = Question::new(&head, &*partner, at).within(prediction);
                    let question = question.flipped(is_swapped);
                    let what = format!("{name}, {prediction}, {is_swapped}, {i}");
                    let [expected, found] = [&every, &patches].map(|d| question.fresh(d));
                    let count =
                        assert_stand_for(&found, &expected, &question.pos12(), prediction, &what);
                    counts = [counts[0] + count[0], counts[1] + count[1]];
                    pair.ask(&patches, &question);
                    assert_bits(&pair.manifolds, &found, &format!("{what}: memory"));
                }
            }
        }
        println!("{name}: {counts:?}");
        assert!(counts[0] > 100 && counts[0] < counts[1], "{name}: {counts:?}");
    }
}

/// A box with six legs at the corners of a hexagon.
fn table() -> Mesh {
    let legs = (0..6).map(|i: u8| {
        let (sin, cos) = (TAU * f32::from(i) / 6.0).sin_cos();
        let at = Vec3::new(0.9 * cos, -0.7, 0.9 * sin);
        mesh::cuboid(Vec3::new(0.05, 0.3, 0.05), 2).posed(&Pose3::from_translation(at))
    });
    let top = mesh::cuboid(Vec3::new(1.0, 0.4, 1.0), 4);
    Mesh::merged("table", &legs.chain([top]).collect::<Vec<_>>())
}

/// Cubes of 5 cm that touch, at Rapier's default prediction distance. Would catch a point for each
/// triangle within it.
#[test]
fn small_bodies_have_few_points_beyond_what_touches() {
    const PREDICTION: Real = 0.02;
    const DEPTH: Real = 2e-4;
    let cube = shape(&mesh::cuboid(Vec3::splat(0.025), 3));
    let patches = SbbkDispatcher::default();
    let mut random = Rand32::new(3);
    let mut points = 0;
    for is_flipped in [false, true].repeat(100) {
        let away = direction(&mut random);
        let turned = rotation(&mut random);
        let at = |shift: Real| Pose::from_parts(shift * away, turned);
        let meets = |shift: Real| patches.intersection_test(&at(shift), &cube, &cube).unwrap();
        let touch = first_touch(0.1, 0.0, |shift| meets(shift).intersecting).expect("cubes meet");
        let question = Question::new(&cube, &cube, at(touch - DEPTH)).within(PREDICTION);
        let found = question.flipped(is_flipped).fresh(&patches);
        assert!(found.iter().map(distance).any(|distance| distance <= 0.0));
        points += found.iter().map(|manifold| manifold.points.len()).sum::<usize>();
    }
    let mean = points as f64 / 200.0;
    println!("{mean} points a pair");
    assert!(mean < 16.0, "{mean} points a pair");
}

/// Cubes of 5 cm deep in each other, at Rapier's default prediction distance. Would catch contacts
/// from within, which hold bodies in each other.
#[test]
fn far_contacts_are_outside_of_solids() {
    const HALF: Real = 0.025;
    let cube = shape(&mesh::cuboid(Vec3::splat(HALF), 3));
    let dispatcher = every();
    let mut random = Rand32::new(5);
    let is_within = |at: Vector| at.abs().max_element() < HALF - 1e-5;
    let mut count = 0;
    for _ in 0..100 {
        let pos12 = Pose::from_parts(0.02 * direction(&mut random), rotation(&mut random));
        let found = Question::new(&cube, &cube, pos12).within(0.02).fresh(&dispatcher);
        assert!(found.iter().map(distance).any(|distance| distance <= 0.0));
        for manifold in found.iter().filter(|manifold| distance(manifold) > 0.2 * HALF) {
            // Other points of a manifold may be beside the contact.
            let contact = manifold.find_deepest_contact().expect("a manifold has points");
            let [one, two] = place(&pos12, manifold, contact);
            let middle = 0.5 * (one + two);
            count += 1;
            assert!(!is_within(middle) && !is_within(pos12.inverse() * middle), "{contact:?}");
        }
    }
    assert!(count > 100, "{count} far contacts");
}

/// Would catch supports that are lost, as two of six legs at the corners of a hexagon would be.
#[test]
fn a_patch_for_each_leg() {
    let table = shape(&table());
    let floor = shape(&mesh::floor(4.0, 20));
    let slab = SharedShape::cuboid(2.0, 0.5, 2.0);
    let dispatcher = SbbkDispatcher::default();
    for (other, height) in [(&floor as &dyn Shape, 0.0), (&*slab.0, 0.5)] {
        for turn in [0.0, 0.3] {
            let at = Pose3::from_parts(Vec3::Y * (height + 0.999), Quat::from_rotation_y(turn));
            let found = Question::new(other, &table, at).within(0.002).fresh(&dispatcher);
            let mut legs: Vec<_> = (found.iter().flat_map(|m| &m.points))
                .map(|point| (point.local_p2.z.atan2(point.local_p2.x) / TAU * 6.0).round() as i32)
                .map(|sixth| sixth.rem_euclid(6))
                .collect();
            legs.sort_unstable();
            legs.dedup();
            assert_eq!(legs.len(), 6, "{legs:?}");
            assert!(found.len() <= 12, "{} patches for six legs", found.len());
        }
    }
}

/// Would catch points that hover over the floor instead of points that carry.
#[test]
fn heads_come_to_rest() {
    let head = mesh::monkey_head().centred().scaled_to(2.0).shape();
    let floor = ColliderBuilder::cuboid(40.0, 1.0, 40.0).translation(-Vec3::Y);
    let heads = (0..10).map(|i| {
        let turn = Quat::from_rotation_x(i as Real) * Quat::from_rotation_y(2.3 * i as Real);
        let at = Pose3::from_parts(Vec3::new(6.0 * i as Real - 30.0, 1.4, 0.0), turn);
        (RigidBodyBuilder::dynamic().pose(at), ColliderBuilder::new(head.clone()))
    });
    let mut heads = SceneWorld::new(world_of([floor], SbbkDispatcher::default()), heads);
    heads.step(600);
    assert!(heads.awake() <= 2, "{} of 10 heads do not lie still", heads.awake());
}

/// Features and data of all points.
fn named(pair: &Pair<u32, u32>) -> Vec<(PackedFeatureId, PackedFeatureId, u32)> {
    let all = pair.manifolds.iter().flat_map(|m| &m.points);
    let mut all: Vec<_> = all.map(|point| (point.fid1, point.fid2, point.data)).collect();
    all.sort_unstable_by_key(|point| point.2);
    all
}

/// Would catch impulses lost or handed to other points while bodies slide, and manifolds without
/// data.
#[test]
fn patches_and_points_keep_their_data() {
    let floor = shape(&mesh::floor(4.0, 2));
    let dispatcher = SbbkDispatcher::default();
    for cube in [
        mesh::cuboid(Vec3::splat(0.5), 1).shape(),
        SharedShape::cuboid(0.5, 0.5, 0.5),
        SharedShape::round_cuboid(0.4, 0.4, 0.4, 0.1),
    ] {
        let mut pair = Pair::default();
        let on = |pose| Question::new(&floor, &*cube, pose).within(0.002);
        let at = |x: Real| on(Pose::translation(0.3 + x, 0.4995, 0.2));
        pair.ask(&dispatcher, &at(0.0));
        pair.manifolds.iter_mut().for_each(|manifold| manifold.data = 7);
        let points = pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points);
        (100..).zip(points).for_each(|(mark, point)| point.data = mark);
        let before = named(&pair);
        assert!(before.len() >= 4, "{before:?}");
        // Corners of two triangles of the floor have a name each, which says what they are.
        let names: BTreeSet<_> = before.iter().map(|(fid1, fid2, _)| [fid1.0, fid2.0]).collect();
        assert_eq!(names.len(), before.len(), "{before:?}");
        let is_name = |id: PackedFeatureId| id.is_vertex() || id.is_edge() || id.is_face();
        assert!(before.iter().all(|&(fid1, fid2, _)| is_name(fid1) && is_name(fid2)));
        for step in 1..20 {
            pair.ask(&dispatcher, &at(1e-4 * step as Real));
            assert_eq!(named(&pair), before);
            assert!(pair.manifolds.iter().all(|manifold| manifold.data == 7));
        }
        // On the other side of the floor there are others.
        pair.ask(&dispatcher, &on(Pose::translation(0.3, -0.4995, 0.2)));
        assert!(!pair.manifolds.is_empty());
        assert!(pair.manifolds.iter().all(|manifold| manifold.data == 0));
        let mut other = Pair::<u32, u32>::default();
        other.ask(&dispatcher, &at(0.0));
        assert!(named(&other).iter().all(|&(.., data)| data == 0));
    }
}

/// A cube in a groove whose sides are so flat that their normals are much alike. Would catch a
/// patch that gets the data of the other one.
#[test]
fn each_patch_keeps_the_data_of_the_one_most_like_it() {
    let bent = |v: Vec3| v + Vec3::Y * 0.15 * v.x.abs();
    let groove = shape(&mesh::floor(4.0, 2).mapped(bent));
    let keel = shape(&mesh::cuboid(Vec3::splat(0.5), 2).mapped(bent));
    let dispatcher = SbbkDispatcher::default();
    let at = |z: Real| {
        Question::new(&groove, &keel, Pose::translation(0.0, 0.4995, 0.1 + z)).within(0.002)
    };
    let mut pair = Pair::<u32>::default();
    pair.ask(&dispatcher, &at(0.0));
    let side = |normal: Vector| if normal.x > 0.0 { 7 } else { 8 };
    assert_eq!(pair.manifolds.iter().map(|m| side(m.local_n1)).collect::<BTreeSet<_>>().len(), 2);
    for step in 1..20 {
        for manifold in &mut pair.manifolds {
            manifold.data = side(manifold.local_n1);
        }
        // A host may move them.
        pair.manifolds.rotate_left(step % 2);
        pair.ask(&dispatcher, &at(1e-5 * step as Real));
        for manifold in &pair.manifolds {
            assert_eq!(manifold.data, side(manifold.local_n1), "{step}");
        }
    }
}

/// A table whose legs are alike, as shape 1, that slides to other triangles of a floor. Would catch
/// a leg that gets the data of another one, as all have their points at the same places in their
/// frames.
#[test]
fn each_part_of_a_compound_keeps_its_data() {
    let leg = SharedShape::cuboid(0.1, 0.5, 0.1);
    let feet = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0]];
    let feet = feet.map(|[x, z]| (Pose::translation(x, 0.0, z), leg.clone()));
    let (table, floor) = (SharedShape::compound(feet.into()), shape(&mesh::floor(16.0, 16)));
    let dispatcher = SbbkDispatcher::default();
    let at = |x: Real| {
        Question::new(&*table, &floor, Pose::translation(-0.3 - x, -0.4995, 0.35)).within(0.002)
    };
    let mut pair = Pair::<u32, u32>::default();
    pair.ask(&dispatcher, &at(0.0));
    assert_eq!(pair.manifolds.len(), 4);
    let mut handed_on = 0;
    for step in 1..300 {
        for manifold in &mut pair.manifolds {
            let leg = manifold.subshape1 + 1;
            manifold.points.iter_mut().for_each(|point| point.data = leg);
        }
        pair.ask(&dispatcher, &at(0.004 * step as Real));
        for manifold in &pair.manifolds {
            let leg = manifold.subshape1 + 1;
            for point in &manifold.points {
                assert!([0, leg].contains(&point.data), "leg {leg} has that of {}", point.data);
                handed_on += usize::from(point.data == leg);
            }
        }
    }
    assert!(handed_on > 3000, "{handed_on}");
}

/// Turns as files have them are of unit length to four digits, and cones then leave normals that
/// are not. Would catch patches without end.
#[test]
fn normals_of_any_length_make_patches() {
    let head = mesh::monkey_head();
    let [bare, cones] =
        [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES].map(|flags| head.trimesh(flags));
    let dispatcher = with(|config| config.contact_set = ContactSet::Triangles);
    let turn = Quat::from_xyzw(0.6, 0.0, 0.0, 0.79999);
    for x in [0.5, 0.9, 1.1] {
        let pose = Pose::from_parts(x * Vec3::X, turn);
        let found = Question::new(&bare, &cones, pose).fresh(&dispatcher);
        assert!(!found.is_empty() && found.iter().all(|manifold| !manifold.points.is_empty()));
    }
}

/// Bodies that stand on a flat mesh. The caps of Parry's meshes are fans around one vertex. Would
/// catch points of contacts with a common deepest point: a body would stand on one side of its
/// base.
#[test]
fn patches_reach_as_far_around_a_body_as_all_contacts() {
    let corners = (0..9).flat_map(|i| {
        let (sin, cos) = (TAU * i as Real / 9.0).sin_cos();
        [-0.4, 0.4].map(|y| Vec3::new(0.4 * cos, y, 0.4 * sin))
    });
    let hull = SharedShape::convex_hull(&corners.collect::<Vec<_>>()).unwrap();
    let of = |(vertices, triangles)| SharedShape::trimesh(vertices, triangles).unwrap();
    // Its bases have vertices in the middle.
    let shaft = |radius: Real| {
        let profile = [[0.0, -0.4], [radius, -0.4], [radius, 0.4], [0.0, 0.4]];
        mesh::revolved(&profile.map(Vec2::from), 16).shape()
    };
    let bodies = [
        ("cone", SharedShape::cone(0.4, 0.4)),
        ("cylinder", SharedShape::cylinder(0.4, 0.4)),
        ("cuboid", SharedShape::cuboid(0.3, 0.4, 0.4)),
        ("hull", hull),
        ("mesh of a cone", of(Cone::new(0.4, 0.4).to_trimesh(20))),
        ("mesh of a cylinder", of(Cylinder::new(0.4, 0.4).to_trimesh(20))),
        ("shaft", shaft(0.1)),
        ("pin", shaft(0.04)),
        ("mesh of a cuboid", of(Cuboid::new(Vec3::splat(0.4)).to_trimesh())),
    ];
    let mut random = Rand32::new(11);
    let (patches, every) = (SbbkDispatcher::default(), every());
    for (name, body) in &bodies {
        let mut least: Real = 1.0;
        for i in 0..200 {
            let floor = shape(&mesh::floor(8.0, 2 + i % 12));
            let mut within = |size: Real| size * (2.0 * random.rand_float() - 1.0);
            let at = Vec3::new(within(3.0), 0.3995 + within(0.001), within(3.0));
            let turn = Quat::from_rotation_y(within(3.0));
            let most = if i % 2 == 0 { 0.0 } else { 1e-4 };
            let tilt = Quat::from_scaled_axis(Vec3::new(within(most), 0.0, within(most)));
            let question = Question::new(&floor, &**body, Pose::from_parts(at, tilt * turn));
            let [patches, every] = [&patches, &every].map(|detail| question.fresh(detail));
            for i in 0..24 {
                let (sin, cos) = (TAU * i as Real / 24.0).sin_cos();
                let reach = |all: &[Manifold]| {
                    let points = all.iter().flat_map(|m| &m.points);
                    let along =
                        |p: &TrackedContact<()>| (p.local_p1 - at).dot(Vec3::new(cos, 0.0, sin));
                    points.map(along).fold(Real::NEG_INFINITY, Real::max)
                };
                least = least.min(reach(&patches) / reach(&every));
            }
        }
        assert!(least > 0.6, "{name}: {least}");
    }
}

/// Grounds with their tops at height 0.
fn flat_grounds() -> [(&'static str, SharedShape); 5] {
    let corners = [-1.0, 1.0].map(|x| [[x, 0.0, -9.0], [x, 0.0, 9.0], [9.0 * x, -2.0, 0.0]]);
    let corners: Vec<_> = corners.into_iter().flatten().map(Vec3::from).collect();
    let plate = (Pose::translation(0.0, -0.5, 0.0), SharedShape::cuboid(9.0, 0.5, 9.0));
    [
        ("cuboid", SharedShape::compound(vec![plate])),
        ("half-space", SharedShape::halfspace(Vec3::Y)),
        ("hull", SharedShape::convex_hull(&corners).unwrap()),
        ("floor", mesh::floor(20.0, 10).shape()),
        ("coarse floor", mesh::floor(20.0, 1).shape()),
    ]
}

/// Returns the least height of a turned shape.
fn lowest(shape: &SharedShape, turn: Quat) -> Real {
    let Some(mesh) = shape.as_trimesh() else {
        let down = turn.inverse() * Vec3::NEG_Y;
        return (turn * shape.as_support_map().unwrap().local_support_point(down)).y;
    };
    let heights = mesh.vertices().iter().map(|&corner| (turn * corner).y);
    heights.fold(Real::INFINITY, Real::min)
}

/// Small bodies over flat grounds, with predictions of up to twenty radii, as soft CCD has them.
/// Would catch patches without the nearest contact: a body would pass through a floor.
#[test]
fn the_nearest_contact_is_kept_at_any_prediction() {
    let bodies = [
        ("coarse box", mesh::cuboid(Vec3::splat(0.4), 1).shape()),
        ("box", mesh::cuboid(Vec3::splat(0.4), 4).shape()),
        ("slab", mesh::cuboid(Vec3::new(0.5, 0.1, 0.4), 3).shape()),
        ("head", mesh::monkey_head().shape()),
        ("cuboid", SharedShape::cuboid(0.4, 0.3, 0.2)),
        ("cylinder", SharedShape::cylinder(0.1, 0.4)),
        ("cone", SharedShape::cone(0.3, 0.4)),
        ("capsule", SharedShape::capsule_y(0.3, 0.2)),
    ];
    let (dispatcher, mut random) = (SbbkDispatcher::default(), Rand32::new(17));
    for (on, ground) in flat_grounds() {
        let is_mesh = |shape: &SharedShape| shape.as_trimesh().is_some();
        for (name, body) in bodies.iter().filter(|(_, body)| is_mesh(body) || is_mesh(&ground)) {
            let radius = body.compute_local_bounding_sphere().radius;
            for i in 0..60 {
                let gap = radius * [0.0, 0.5, 1.0, 4.0, 16.0][i % 5];
                let turn = rotation(&mut random);
                let at = Vec3::new(0.03, gap - lowest(body, turn), 0.02);
                let question = Question::new(&*ground, &**body, Pose::from_parts(at, turn));
                let question = question.within(gap + 1.5 * radius).flipped(i % 2 == 0);
                let found = question.fresh(&dispatcher);
                let nearest = found.iter().map(distance).fold(Real::INFINITY, Real::min);
                let is_right = (nearest - gap).abs() < 1e-3 * (radius + gap);
                assert!(is_right, "{name} on {on}, {i}: {nearest} instead of {gap}");
            }
        }
    }
}
