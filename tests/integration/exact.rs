use crate::prelude::*;
use crate::truth::{check_all_right, errors_of};
use sbbk_testkit::judge::Errors;
use sbbk_testkit::mesh::Thread;

/// Sizes of meshes and prediction distances at which contacts must be right.
const SIZES: [Real; 3] = [0.1, 2.0, 40.0];
const PREDICTIONS: [Real; 3] = [0.001, 0.002, 0.02];

/// Depths of poses, as shares of the size: just apart, touching, a step's fall, and deep.
const DEPTHS: [Real; 4] = [-0.0005, 0.0005, 0.01, 0.2];

/// Panics unless all contacts of two meshes are right, at every size, depth and prediction
/// distance.
fn judge(seed: u64, meshes: [&Mesh; 2], least_contacts: usize) {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(seed);
    let mut errors = Errors::default();
    for size in SIZES {
        let [one, two] = meshes.map(|mesh| shape(&mesh.clone().scaled_to(size)));
        for (prediction, depth) in PREDICTIONS.into_iter().flat_map(|p| DEPTHS.map(|d| (p, d))) {
            let pos12 = touching(&mut random, [&one, &two], depth * size);
            let query = Question::new(&one, &two, pos12).within(prediction);
            errors += errors_of(&query, &query.fresh(&dispatcher));
        }
    }
    check_all_right(errors, least_contacts);
}

/// Would catch contacts missed, invented, or with wrong depths, as stock has them at small
/// triangles. Would also catch contacts that depend on the winding.
#[test]
fn contacts_are_those_of_brute_force_at_every_size() {
    let head = mesh::monkey_head();
    judge(2, [&head, &head], 1000);
    judge(3, [&mesh::monkey_head_with(7), &mesh::torus(1.0, 0.4, 60, 30)], 1000);
    judge(4, [&mesh::ball(1.0, 32), &mesh::ball(1.0, 20)], 1000);
    let inside_out = mesh::turned_inside_out(mesh::monkey_head_with(7));
    judge(5, [&inside_out, &inside_out], 500);
}

/// Edges and faces that are exactly parallel, and vertices that meet exactly.
#[test]
fn aligned_boxes_touch_as_the_truth_says() {
    let dispatcher = per_triangle();
    let mut errors = Errors::default();
    for size in SIZES {
        let cube = shape(&mesh::cuboid(Vector::splat(0.5 * size), 4));
        for gap in [-0.1, -0.0005, 0.0, 0.0005, 0.0009, 0.015] {
            for shift in [[0.0, 0.0], [0.25, 0.0], [0.1, 0.3], [1.0, 0.0]] {
                let [x, z] = shift.map(|shift| shift * size);
                let query = Question::new(&cube, &cube, Pose::translation(x, size + gap, z));
                for prediction in PREDICTIONS {
                    let query = query.within(prediction);
                    errors += errors_of(&query, &query.fresh(&dispatcher));
                }
            }
        }
    }
    check_all_right(errors, 10_000);
}

/// Would catch f32 coordinates that lose contacts of bodies or vertices far from an origin.
#[test]
fn distant_meshes_touch_as_the_truth_says() {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(6);
    let mut errors = Errors::default();
    let head = mesh::monkey_head_with(7);
    let near = shape(&head);
    for offset in [10.0, 100.0, 1000.0] {
        let shift = Vector::new(offset, -0.5 * offset, 0.25 * offset);
        let away = shape(&head.clone().mapped(|vertex| vertex + shift));
        for depth in DEPTHS {
            let pos12 =
                touching(&mut random, [&near, &near], depth) * Pose::from_translation(-shift);
            let query = Question::new(&near, &away, pos12);
            errors += errors_of(&query, &query.fresh(&dispatcher));
            let query = query.flipped(true);
            errors += errors_of(&query, &query.fresh(&dispatcher));
        }
    }
    check_all_right(errors, 200);
}

/// A corner of a box above the middle of a triangle. Would catch features of the two shapes that
/// are taken for each other: impulses would be handed to other points as bodies slide.
#[test]
fn features_are_those_of_their_shape() {
    let [floor, cube] = [mesh::floor(4.0, 1), mesh::cuboid(Vec3::splat(0.5), 1)].map(|m| shape(&m));
    let turn = Quat::from_rotation_arc(Vec3::splat(-1.0).normalize(), -Vec3::Y);
    let at = Pose::from_parts(Vec3::new(0.7, 0.75_f32.sqrt() + 0.001, 0.3), turn);
    let query = Question::new(&floor, &cube, at);
    for dispatcher in SETS.map(having) {
        for query in [query, query.flipped(true)] {
            let found = query.fresh(&dispatcher);
            let points = found.iter().flat_map(|manifold| &manifold.points);
            let nearest = points.min_by(|a, b| a.dist.total_cmp(&b.dist)).expect("they touch");
            let [floors, cubes] = query.host_order([nearest.fid1, nearest.fid2]);
            assert!(floors.is_face() && cubes.is_vertex(), "{floors:?} {cubes:?}");
        }
    }
}

/// Two bars of 12 to 3072 triangles that cross edge over edge, apart by less than what triangles
/// are searched in. Would catch edges that are left out as passing by, though nothing else is as
/// near.
#[test]
fn the_nearest_edges_of_crossed_bars_have_a_contact() {
    let mut random = Rand32::new(2);
    let dispatcher = SbbkDispatcher::default();
    for i in 0..400 {
        let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
        let half: Real = [0.02, 0.1, 0.5][i % 3];
        // Fine meshes have only far contacts beyond 0.04 radii.
        let gap = within(0.05, 0.95) * (0.12 * half).min(0.02);
        let turns =
            [Quat::from_rotation_x(within(0.3, 1.2)), Quat::from_rotation_z(within(0.3, 1.2))];
        let halves = [Vec3::new(3.0 * half, half, half), Vec3::new(half, half, 3.0 * half)];
        let cells = [1, 4, 8, 16][i % 4];
        let [bar1, bar2] = halves.map(|half| shape(&mesh::cuboid(half, cells)));
        let [cuboid1, cuboid2] = halves.map(Cuboid::new);
        let heights = [0, 1].map(|k| {
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (turns[k] * axis).y.abs());
            Vec3::new(x, y, z).dot(halves[k])
        });
        let place =
            Vec3::new(within(-half, half), heights[0] + heights[1] + gap, within(-half, half));
        let pose = Pose::from_rotation(turns[0]).inverse() * Pose::from_parts(place, turns[1]);
        let truth = DefaultQueryDispatcher.distance(&pose, &cuboid1, &cuboid2).unwrap().distance;
        let found = Question::new(&bar1, &bar2, pose).within(0.02).fresh(&dispatcher);
        let nearest = found.iter().map(distance).fold(Real::INFINITY, Real::min);
        assert!((nearest - truth).abs() < 1e-5, "{i}: {nearest}, {truth}");
    }
}

/// A nut in the middle of the play on its bolt, and a prediction distance of up to two thirds of
/// the pitch. Would catch triangles that seem to have passed each other, as normals of far contacts
/// lead into both threads. They pushed nuts by a flank.
#[test]
fn solids_that_are_apart_have_no_nearer_contacts() {
    let [bolt, nut] = [Thread::BOLT.bolt(), Thread::NUT.nut(1.2)].map(|mesh| shape(&mesh));
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(11);
    let mut found = 0;
    for i in 0..60 {
        let mut within = |most: Real| most * (2.0 * random.rand_float() - 1.0);
        let turn = within(3.0);
        let height = Thread::BOLT.pitch * (2.0 + turn / TAU + within(0.03));
        let turn = Quat::from_rotation_y(turn) * Quat::from_rotation_x(within(0.003));
        let pose = Pose::from_parts(Vec3::new(within(0.005), height, within(0.005)), turn);
        let least = DefaultQueryDispatcher.distance(&pose, &bolt, &nut).unwrap().distance;
        assert!(least > 1e-3, "{least}");
        let question = Question::new(&bolt, &nut, pose).within([0.02, 0.1, 0.3][i % 3]);
        let contacts = question.fresh(&dispatcher);
        let nearest = contacts.iter().map(distance).fold(Real::INFINITY, Real::min);
        assert!(nearest > least - 1e-4, "{i}: {nearest}, {least}");
        found += contacts.len();
    }
    assert!(found > 1000, "{found}");
}

/// A roof of two slopes, with triangles that get smaller towards the middle of its ridge along the
/// x axis.
fn roof(length: Real, cells: i32) -> SharedShape {
    let place = |i: i32| length * i as Real * i.abs() as Real / (cells * cells) as Real;
    let row = |i: i32| (-cells..=cells).map(move |j| [place(i), -place(j.abs()), place(j)]);
    let vertices = (-cells..=cells).flat_map(row).map(Vec3::from_array).collect();
    let width = 2 * cells as u32 + 1;
    let cell =
        |first: u32| [[0, 1, width + 1], [0, width + 1, width]].map(|of| of.map(|i| first + i));
    let rows = (0..width - 1).flat_map(|i| (0..width - 1).map(move |j| i * width + j));
    SharedShape::trimesh(vertices, rows.flat_map(cell).collect()).unwrap()
}

/// Triangles at the nearest points are much smaller than their distance. Would catch triangles that
/// a descent rejects as beside each other, though nothing else is as near.
#[test]
fn the_nearest_ridges_of_fine_roofs_have_a_contact() {
    let mut random = Rand32::new(3);
    let dispatcher = SbbkDispatcher::default();
    let roofs = [0, 1].map(|i| roof(0.5, 20 + i));
    for prepared in [false, true] {
        let _keep = prepared.then(|| roofs.each_ref().map(|roof| dispatcher.prepare_shape(roof)));
        for _ in 0..50 {
            let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
            let gap = within(0.006, 0.019);
            let turn = Quat::from_rotation_y(within(0.5, 2.5)) * Quat::from_rotation_x(PI);
            let place = Vec3::new(within(-1e-3, 1e-3), gap, within(-1e-3, 1e-3));
            let query = Question::new(&*roofs[0].0, &*roofs[1].0, Pose::from_parts(place, turn));
            let query = query.within(0.02);
            let found = query.fresh(&dispatcher);
            let nearest = found.iter().map(distance).fold(Real::INFINITY, Real::min);
            assert!((nearest - gap).abs() < 1e-5, "{nearest}, {gap}");
        }
    }
}

/// A prism along the z axis over a polygon, and the triangles of the polygon.
fn prism(outline: &[[Real; 2]], triangles: &[[u32; 3]], half_length: Real) -> SharedShape {
    let count = outline.len() as u32;
    let end = |z: Real| outline.iter().map(move |&[x, y]| Vec3::new(x, y, z));
    let ends = triangles.iter().flat_map(|&[a, b, c]| [[a, c, b], [a, b, c].map(|i| count + i)]);
    let sides = (0..count).flat_map(|i| {
        let j = (i + 1) % count;
        [[i, j, count + j], [i, count + j, count + i]]
    });
    let vertices = end(-half_length).chain(end(half_length)).collect();
    SharedShape::trimesh(vertices, ends.chain(sides).collect()).unwrap()
}

/// A tail in an undercut slot, and in a straight one. Triangles of the tail cross the floor and a
/// wall of the slot. Would catch acute corners that seem to lead into the solid, and contacts with
/// the floor that count for the wall.
#[test]
fn overlaps_with_the_walls_of_a_slot_have_contacts() {
    const PLAY: Real = 0.01;
    let mut random = Rand32::new(8);
    let dispatcher = SbbkDispatcher::default();
    let (mut count, mut lost) = (0, 0);
    for top in [0.3, 0.5] {
        let [x, y] = [top + PLAY, 0.5 + PLAY];
        let slot = [
            [-1.0, -0.3],
            [1.0, -0.3],
            [1.0, 0.4],
            [x, 0.4],
            [y, -PLAY],
            [-y, -PLAY],
            [-x, 0.4],
            [-1.0, 0.4],
        ];
        let of_slot = [[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]];
        let slot_mesh = prism(&slot, &of_slot, 0.6);
        let tail = [[-0.5, 0.0], [0.5, 0.0], [top, 0.4], [-top, 0.4]];
        let tail_mesh = prism(&tail, &[[0, 1, 2], [0, 2, 3]], 0.5);
        let hull = |outline: &[[Real; 2]], half_length: Real| {
            let ends =
                [-half_length, half_length].map(|z| outline.iter().map(move |&[x, y]| [x, y, z]));
            let points: Vec<_> = ends.into_iter().flatten().map(Vec3::from_array).collect();
            SharedShape::convex_hull(&points).unwrap()
        };
        let tail_hull = hull(&tail, 0.5);
        let walls =
            [[1, 2, 3, 4], [0, 5, 6, 7]].map(|wall| hull(&wall.map(|i: usize| slot[i]), 0.6));
        for _ in 0..1000 {
            let mut within = |most: Real| most * (2.0 * random.rand_float() - 1.0);
            let size = 0.035 + within(0.03);
            let mut vector = || Vec3::new(within(size), within(size), within(size));
            let pose = Pose::from_parts(vector(), Quat::from_scaled_axis(vector()));
            let found = Question::new(&*slot_mesh.0, &*tail_mesh.0, pose).fresh(&dispatcher);
            for wall in &walls {
                let truth = DefaultQueryDispatcher.contact(&pose, &*wall.0, &*tail_hull.0, 0.0);
                let Some(truth) = truth.unwrap().filter(|truth| truth.dist < -0.008) else {
                    continue;
                };
                count += 1;
                lost += usize::from(!found.iter().any(|manifold| {
                    manifold.local_n1.dot(truth.normal1) > 0.5
                        && distance(manifold) < 0.3 * truth.dist
                }));
            }
        }
    }
    assert!(count > 500, "{count} overlaps");
    // Stock loses none of these.
    assert!(lost <= 1, "{lost} of {count}");
}

/// An edge of a door leaf is in an edge of its jamb, farther sideways than into it. Would catch
/// contacts that push the leaf aside: a fast leaf went through.
#[test]
fn edges_in_edges_push_the_shorter_way() {
    let (leaf, jamb) = (Vec3::new(0.5, 1.0, 0.04), Vec3::new(0.1, 1.1, 0.1));
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(17);
    let (mut lost, mut wrong) = (0, 0);
    for case in 0..600 {
        let mut number = |least: f32, most: f32| least + (most - least) * random.rand_float();
        let cells = 1 + case % 5;
        let turn =
            Quat::from_rotation_y(-number(0.0, 0.2)) * Quat::from_rotation_z(number(-0.02, 0.02));
        let tip = turn * Vec3::new(leaf.x, 0.0, -leaf.z);
        let (aside, deep) = (number(0.09, 0.12), number(0.01, 0.07));
        let lift = if case % 2 == 0 { 0.0 } else { number(-0.08, 0.08) };
        let at = Vec3::new(aside - jamb.x - tip.x, lift, jamb.z - deep - tip.z);
        let pose = Pose::from_parts(at, turn);
        let truth =
            DefaultQueryDispatcher.contact(&pose, &Cuboid::new(jamb), &Cuboid::new(leaf), 0.0);
        let truth = truth.unwrap().expect("the edges cross");
        let [jamb, leaf] = [jamb, leaf].map(|half| mesh::cuboid(half, cells).shape());
        let found = Question::new(&*jamb.0, &*leaf.0, pose).fresh(&dispatcher);
        let found: Vec<_> =
            found.iter().map(|it| (it.local_n1.dot(truth.normal1), distance(it))).collect();
        let has_right = found.iter().any(|&(along, dist)| along > 0.9 && dist < 0.5 * truth.dist);
        let has_wrong = found.iter().any(|&(along, dist)| along < 0.5 && dist < truth.dist - 0.01);
        lost += usize::from(!has_right);
        wrong += usize::from(has_wrong);
    }
    println!("{lost} and {wrong} of 600");
    assert!(lost <= 2 && wrong <= 12, "{lost} and {wrong} of 600");
}
