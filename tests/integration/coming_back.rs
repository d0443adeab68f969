use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use glamx::Vec3;
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::{ClosestPoints, ContactManifold, QueryDispatcher};
use rapier3d::parry::shape::SharedShape;
use rapier3d::pipeline::PhysicsWorld;
use rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder};
use sbbk_core::traverse::Placement;
use sbbk_testkit::mesh;
use sbbk_testkit::world::fingerprint;

use crate::kinds::kinds;
use crate::support::{
    Manifold, Pair, Question, assert_bits, bits, counting_patches, direction, every, nudge,
    rotation, sequence, shape,
};

/// Calls `check` with a pair of each kind in contact, in both orders, and another pose in contact.
fn for_each_pair(mut check: impl FnMut(&str, &Question, Pose)) {
    for (seed, kind) in (0..).zip(kinds()) {
        let mut random = Rand32::new(seed);
        let [pose, other] = [(); 2].map(|()| kind.pose(&mut random, -0.01));
        for flipped in [false, true] {
            let name = format!("{}, flipped: {flipped}", kind.name);
            check(&name, &kind.question(pose).flipped(flipped), other);
        }
    }
}

fn fresh(question: &Question, pose: Pose) -> Vec<Manifold> {
    question.at(pose).fresh(&SbbkDispatcher::default())
}

/// Would catch an old pose taken for the present one: a body that is reset, or goes to and fro.
#[test]
fn a_pair_that_comes_back_to_an_equal_pose_touches_as_before() {
    for_each_pair(|name, question, other| {
        let dispatcher = SbbkDispatcher::default();
        let expected = fresh(question, question.pose);
        assert!(!expected.is_empty(), "{name}: no contacts");
        let off = Pose::translation(1e-4, 0.0, 0.0) * question.pose;
        let far = Pose::translation(0.0, 1e4, 0.0);
        for between in [other, off, far, Pose::translation(Real::NAN, 0.0, 0.0)] {
            let mut pair: Pair = Pair::default();
            let there = fresh(question, between);
            for _ in 0..3 {
                pair.ask(&dispatcher, question);
                assert_bits(&pair.manifolds, &expected, name);
                pair.ask(&dispatcher, &question.at(between));
                assert_bits(&pair.manifolds, &there, name);
            }
        }
    });
}

/// Would catch manifolds that come twice, out of order, not at all, or without the poses of parts.
#[test]
fn a_host_may_remove_copy_reorder_or_empty_manifolds() {
    for_each_pair(|name, question, _| {
        let dispatcher = SbbkDispatcher::default();
        let mut random = Rand32::new(1);
        let mut pair: Pair = Pair::default();
        for round in 0..15 {
            let pose = nudge(&mut random, 1e-4) * question.pose;
            pair.ask(&dispatcher, &question.at(pose));
            let last = nudge(&mut random, 1e-5) * pose;
            pair.ask(&dispatcher, &question.at(last));
            match round % 5 {
                0 => _ = pair.manifolds.pop(),
                1 => drop(pair.manifolds.remove(0)),
                2 => pair.manifolds.extend(pair.manifolds.first().cloned()),
                3 => pair.manifolds.reverse(),
                _ => pair.manifolds.iter_mut().for_each(|manifold| {
                    *manifold = Manifold::with_data(manifold.subshape1, manifold.subshape2, ());
                }),
            }
            // At an equal pose, a list of the same length counts as unchanged.
            let again = (round % 5 < 3).then_some(last);
            let next = [0.0, 0.0, 1e-5].map(|step| nudge(&mut random, step) * pose);
            for next in again.into_iter().chain(next) {
                pair.ask(&dispatcher, &question.at(next));
                assert_bits(&pair.manifolds, &fresh(question, next), &format!("{name}, {round}"));
            }
        }
    });
}

/// Data of a host that panics when the countdown is over.
#[derive(Clone)]
struct Fragile;

static COUNTDOWN: AtomicUsize = AtomicUsize::new(usize::MAX);

impl Default for Fragile {
    fn default() -> Self {
        let left = COUNTDOWN.load(Ordering::Relaxed);
        assert!(left > 0, "the host panics");
        COUNTDOWN.store(left - 1, Ordering::Relaxed);
        Self
    }
}

/// The manifolds with the data of another host.
fn plain(manifolds: &[ContactManifold<Fragile, ()>]) -> Vec<Vec<u32>> {
    manifolds.iter().map(bits).collect()
}

/// Would catch a query that a type of the host cut short and that counts as answered.
#[test]
fn a_query_cut_short_by_a_panic_is_asked_again() {
    for_each_pair(|name, question, other| {
        let dispatcher = SbbkDispatcher::default();
        let [before, expected] = [other, question.pose]
            .map(|pose| fresh(question, pose).iter().map(bits).collect::<Vec<_>>());
        let apart = Pose::translation(0.0, 1.5, 0.0) * other;
        for countdown in 0..5 {
            for known in [None, Some(apart), Some(other)] {
                let mut pair = Pair::<Fragile, ()>::default();
                if let Some(last) = known {
                    pair.ask(&dispatcher, &question.at(other));
                    pair.ask(&dispatcher, &question.at(last));
                }
                COUNTDOWN.store(countdown, Ordering::Relaxed);
                let is_cut_short =
                    catch_unwind(AssertUnwindSafe(|| _ = pair.ask(&dispatcher, question)));
                COUNTDOWN.store(usize::MAX, Ordering::Relaxed);
                let must_be = countdown == 0 && known.is_none();
                assert!(is_cut_short.is_err() || !must_be, "{name}: nothing was cut short");
                if known == Some(other) {
                    pair.ask(&dispatcher, &question.at(other));
                    assert!(plain(&pair.manifolds) == before, "{name}: {countdown}");
                }
                for _ in 0..2 {
                    pair.ask(&dispatcher, question);
                    assert!(plain(&pair.manifolds) == expected, "{name}: {countdown}");
                }
            }
        }
    });
}

/// Would catch overflow that loses contacts of a smaller prediction distance.
#[test]
fn no_prediction_distance_is_too_large() {
    for_each_pair(|name, question, _| {
        let near = sequence(&question.fresh(&every()));
        for prediction in [1e3, 1e9, 2e19, 1e30, Real::MAX] {
            let (mut pair, question) = (Pair::<(), ()>::default(), question.within(prediction));
            for _ in 0..2 {
                let found = sequence(&pair.ask(&every(), &question).manifolds);
                let lost = near.iter().filter(|near| !found.contains(near)).count();
                assert_eq!(lost, 0, "{name} within {prediction}");
            }
        }
    });
}

/// Would catch boxes of whole shapes that rounding makes too small in the first query of a pair.
#[test]
fn first_queries_see_as_far_as_later_ones() {
    let cube = mesh::cuboid(Vec3::ONE, 1);
    let plate = (Pose::IDENTITY, SharedShape::cuboid(1.0, 1.0, 1.0));
    let grounds = [
        cube.shape(),
        SharedShape::cuboid(1.0, 1.0, 1.0),
        SharedShape::cylinder(1.0, 1.0),
        SharedShape::compound(vec![plate]),
    ];
    let (mut random, mut found) = (Rand32::new(1), [0; 4]);
    for _ in 0..200 {
        let offset = 1e4 * (1.0 + random.rand_float());
        let far = shape(&cube.clone().mapped(|x| x + offset * Vec3::Y));
        let pose = Pose::translation(0.1, 2.02 - offset, 0.2);
        let lowest = far.vertices().iter().map(|x| x.y).fold(Real::INFINITY, Real::min);
        let gap = (f64::from(lowest) + f64::from(pose.translation.y) - 1.0) as Real;
        for (ground, found) in grounds.iter().zip(&mut found) {
            for is_mesh_first in [false, true] {
                let prediction = gap.next_up();
                let question =
                    Question::new(&**ground, &far, pose).within(prediction).flipped(is_mesh_first);
                let mut pair: Pair = Pair::default();
                let dispatcher = SbbkDispatcher::default();
                pair.ask(&dispatcher, &question.at(Pose::translation(-0.1, -0.1, 0.0) * pose));
                pair.ask(&dispatcher, &question.at(pose));
                assert_bits(&pair.manifolds, &fresh(&question, pose), &format!("{offset}"));
                *found += pair.manifolds.len();
            }
        }
    }
    assert!(found.iter().all(|&found| found > 100), "{found:?} contacts");
}

/// Would catch boxes that the rounding of a turn makes too small. Each mesh is exactly the
/// prediction distance away.
#[test]
fn turned_meshes_far_from_their_origin_are_seen() {
    let cube = mesh::cuboid(Vec3::ONE, 1);
    let slab = Vec3::new(5.0, 1.0, 5.0);
    let cuboid = SharedShape::cuboid(slab.x, slab.y, slab.z);
    let grounds = [
        mesh::cuboid(slab, 1).shape(),
        cuboid.clone(),
        SharedShape::cylinder(1.0, 5.0),
        SharedShape::compound(vec![(Pose::IDENTITY, cuboid)]),
    ];
    let dispatcher = SbbkDispatcher::default();
    let (mut random, mut found) = (Rand32::new(1), 0);
    for _ in 0..400 {
        let offset = 1e4 * (1.0 + random.rand_float()) * direction(&mut random);
        let far = shape(&cube.clone().mapped(|x| x + offset));
        let turn = rotation(&mut random);
        let reach =
            [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (turn * axis).y.abs()).iter().sum::<Real>();
        let pose = Pose::from_parts(Vec3::new(0.1, 1.02 + reach, 0.2) - turn * offset, turn);
        for is_mesh_first in [false, true] {
            let placement = if is_mesh_first {
                Placement::new(&pose.inverse()).inverted()
            } else {
                Placement::new(&pose)
            };
            let heights = far.vertices().iter().map(|&x| placement.to_frame1(x, Vec3::ZERO).y);
            let gap = (heights.fold(f64::INFINITY, f64::min) - 1.0) as Real;
            if gap < 1e-4 {
                continue;
            }
            for ground in &grounds {
                // A frame may be longer than the other by the rounding of its quaternion.
                let prediction = 1.000_01 * gap;
                let question =
                    Question::new(&**ground, &far, pose).within(prediction).flipped(is_mesh_first);
                assert!(!fresh(&question, pose).is_empty(), "{gap} apart, {is_mesh_first}");
                found += 1;
                if ground.as_composite_shape().is_none() {
                    let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
                    let nearest = dispatcher.closest_points(&pos12, g1, g2, prediction).unwrap();
                    assert!(nearest != ClosestPoints::Disjoint, "{gap} apart, {is_mesh_first}");
                }
            }
        }
    }
    assert!(found > 2000, "{found} contacts");
}

/// Bodies as meshes and convex bodies of every kind on a mesh ground, all lengths times `unit`.
fn mixed_world(unit: Real, has_soft_ccd: bool) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.contact_recycling = false;
    world.integration_parameters.length_unit = unit;
    world.gravity *= unit;
    let ground = mesh::terrain(8.0 * unit, 16, 0.3 * unit).shape();
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(ground));
    let head = mesh::monkey_head_with(6).mapped(|vertex| 0.3 * unit * vertex);
    let cloud: Vec<Vec3> = head.vertices.iter().step_by(7).copied().collect();
    let [half, thin] = [0.25 * unit, 0.1 * unit];
    let dumbbell = [-half, half].map(|x| (Pose::translation(x, 0.0, 0.0), SharedShape::ball(half)));
    let shapes = [
        head.shape(),
        SharedShape::ball(half),
        SharedShape::cuboid(half, thin, half),
        SharedShape::capsule_y(half, thin),
        SharedShape::cylinder(thin, half),
        SharedShape::cone(half, half),
        SharedShape::convex_hull(&cloud).expect("a head has a hull"),
        SharedShape::round_cylinder(thin, half, 0.3 * thin),
        SharedShape::round_cuboid(half, thin, thin, 0.3 * thin),
        SharedShape::compound(dumbbell.to_vec()),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let (row, column) = ((i / 4) as Real, (i % 4) as Real);
        let place = unit * Vec3::new(1.1 * column - 1.6, 0.9, 1.1 * row - 1.2);
        let ccd = if has_soft_ccd { 0.5 * unit } else { 0.0 };
        let body = RigidBodyBuilder::dynamic().translation(place).soft_ccd_prediction(ccd);
        let body = body.rotation(Vec3::new(0.2 * i as Real, 0.5, 0.1)).can_sleep(false);
        world.insert(body, ColliderBuilder::new(shape).density(1.0));
    }
    world
}

/// Would catch contacts that depend on memory of the steps before. The other world gets a new
/// dispatcher in each step.
#[test]
fn convex_worlds_forget_everything_and_go_on_alike() {
    for unit in [0.01, 0.1, 1.0, 100.0] {
        for has_soft_ccd in [false, true] {
            let dispatcher = counting_patches();
            let mut remembering = mixed_world(unit, has_soft_ccd);
            remembering.narrow_phase.set_query_dispatcher(dispatcher.clone());
            let mut forgetting = mixed_world(unit, has_soft_ccd);
            for step in 0..150 {
                forgetting.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
                remembering.step();
                forgetting.step();
                let [one, two] = [&remembering, &forgetting].map(fingerprint);
                assert!(one == two, "units of {unit}, soft CCD {has_soft_ccd}, step {step}");
            }
            let touching = remembering.contact_pairs().filter(|p| p.has_any_active_contact());
            assert!(touching.count() >= 8, "units of {unit}: bodies do not touch the ground");
            assert!(dispatcher.stats().internals.reused_queries > 100, "nothing was remembered");
        }
    }
}
