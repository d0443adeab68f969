use std::collections::BTreeMap;
use std::f32::consts::FRAC_PI_2;

use allocation_counter::measure;
use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher,
};
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder};
use sbbk_lab::mesh;

use crate::support::{
    Dispatcher, Manifold, Pair, counting, direction, distance, nudge, rotation, shape_with,
};

/// A convex shape of each kind, about `size` across.
fn shapes(size: Real) -> Vec<(&'static str, SharedShape)> {
    let half = 0.5 * size;
    let [a, b, c] = [
        Vec3::new(-half, 0.0, 0.1 * size),
        Vec3::new(half, 0.2 * size, 0.0),
        Vec3::new(0.0, -0.3 * size, half),
    ];
    let mut random = Rand32::new(77);
    let cloud: Vec<Vec3> = (0..30).map(|_| half * direction(&mut random)).collect();
    let hull = |points: &[Vec3]| SharedShape::convex_hull(points).expect("a cloud has a hull");
    let round_hull = SharedShape::round_convex_hull(&cloud, 0.1 * size).expect("as above");
    vec![
        ("ball", SharedShape::ball(half)),
        ("cuboid", SharedShape::cuboid(half, 0.7 * half, 0.5 * half)),
        ("capsule", SharedShape::capsule_y(half, 0.4 * half)),
        ("skew capsule", SharedShape::capsule(a, b, 0.3 * half)),
        ("segment", SharedShape::segment(a, b)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("cylinder", SharedShape::cylinder(half, 0.6 * half)),
        ("cone", SharedShape::cone(half, 0.6 * half)),
        ("hull", hull(&cloud)),
        ("round cuboid", SharedShape::round_cuboid(half, 0.7 * half, 0.5 * half, 0.1 * size)),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.1 * size)),
        ("round cylinder", SharedShape::round_cylinder(half, 0.6 * half, 0.1 * size)),
        ("round cone", SharedShape::round_cone(half, 0.6 * half, 0.1 * size)),
        ("round hull", round_hull),
        ("half-space", SharedShape::halfspace(Vec3::new(0.36, 0.8, -0.48))),
    ]
}

/// A large flat floor, whose box holds the whole mesh as soon as it is turned.
fn floor() -> SharedShape {
    SharedShape::cuboid(50.0, 0.25, 50.0)
}

/// What is asked: the contacts of a mesh and a convex shape.
#[derive(Clone, Copy)]
struct Question<'a> {
    mesh: &'a TriMesh,
    shape: &'a SharedShape,
    /// The pose of the shape in the frame of the mesh.
    pose: Pose,
    prediction: Real,
    /// Whether the shape comes first.
    flipped: bool,
}

impl Question<'_> {
    /// The pose of the second shape in the frame of the first.
    fn pos12(&self) -> Pose {
        if self.flipped { self.pose.inverse() } else { self.pose }
    }

    fn ask<'p, M, C>(
        &self,
        dispatcher: &impl Dispatcher<M, C>,
        pair: &'p mut Pair<M, C>,
    ) -> &'p mut Pair<M, C> {
        let Pair { manifolds, workspace } = &mut *pair;
        let (mesh, shape) = (self.mesh, &*self.shape.0);
        let pos12 = self.pos12();
        let answer = if self.flipped {
            dispatcher.contact_manifolds(&pos12, shape, mesh, self.prediction, manifolds, workspace)
        } else {
            dispatcher.contact_manifolds(&pos12, mesh, shape, self.prediction, manifolds, workspace)
        };
        answer.expect("a mesh and a convex shape are supported");
        pair
    }

    fn fresh(&self, dispatcher: &impl Dispatcher<(), ()>) -> Vec<Manifold> {
        std::mem::take(&mut self.ask(dispatcher, &mut Pair::default()).manifolds)
    }

    fn triangle_of<M, C>(&self, manifold: &ContactManifold<M, C>) -> u32 {
        let [mesh, other] = if self.flipped {
            [manifold.subshape2, manifold.subshape1]
        } else {
            [manifold.subshape1, manifold.subshape2]
        };
        assert_eq!(other, 0, "the convex shape has no subshapes");
        mesh
    }

    /// Distance of a triangle and the shape, by Parry.
    fn apart(&self, triangle: u32) -> Real {
        let triangle = self.mesh.triangle(triangle);
        let distance = DefaultQueryDispatcher.distance(&self.pose, &triangle, &*self.shape.0);
        distance.expect("Parry knows the distance of all these shapes to triangles").distance
    }

    /// Parry's routine on each triangle of the mesh, called as stock calls it; manifolds with points.
    fn brute_force(&self) -> BTreeMap<u32, Manifold> {
        let all = (0..self.mesh.indices().len() as u32).filter_map(|index| {
            let subshapes = if self.flipped { [0, index] } else { [index, 0] };
            let mut manifold = Manifold::with_data(subshapes[0], subshapes[1], ());
            let triangle = self.mesh.triangle(index);
            let cone = self.mesh.triangle_normal_constraints(index);
            let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
            let (shape, parry) = (&*self.shape.0, DefaultQueryDispatcher);
            let (pos12, within) = (self.pos12(), self.prediction);
            let answer = if self.flipped {
                let pose = pos12.inverse().inverse();
                parry.contact_manifold_convex_convex(
                    &pose,
                    shape,
                    &triangle,
                    None,
                    cone,
                    within,
                    &mut manifold,
                )
            } else {
                parry.contact_manifold_convex_convex(
                    &pos12,
                    &triangle,
                    shape,
                    cone,
                    None,
                    within,
                    &mut manifold,
                )
            };
            answer.expect("Parry knows contacts of all these shapes with triangles");
            (!manifold.points.is_empty()).then_some((index, manifold))
        });
        all.collect()
    }
}

/// All of a manifold that a user can see. Bits, but a zero has no sign.
fn bits(manifold: &Manifold) -> Vec<u32> {
    let mut bits = Vec::new();
    let mut push = |x: f32| bits.push((x + 0.0).to_bits());
    for normal in [manifold.local_n1, manifold.local_n2] {
        normal.to_array().into_iter().for_each(&mut push);
    }
    for point in &manifold.points {
        for p in [point.local_p1, point.local_p2] {
            p.to_array().into_iter().for_each(&mut push);
        }
        push(point.dist);
    }
    let features = manifold.points.iter().flat_map(|point| [point.fid1.0, point.fid2.0]);
    bits.extend(features.collect::<Vec<_>>());
    bits
}

fn touches(manifold: &Manifold, prediction: Real) -> bool {
    manifold.points.iter().any(|point| point.dist <= prediction)
}

/// Panics unless a fresh answer is that of Parry's routine on all triangles, bit for bit: each manifold of ours is
/// one of brute force, and each of brute force that has a point within the prediction distance is one of ours. The
/// number of contacts.
fn check_fresh(name: &str, dispatcher: &SbbkDispatcher, question: &Question) -> usize {
    let found = question.fresh(dispatcher);
    let all = question.brute_force();
    let by_triangle: BTreeMap<u32, &Manifold> =
        found.iter().map(|manifold| (question.triangle_of(manifold), manifold)).collect();
    assert_eq!(by_triangle.len(), found.len(), "{name}: two manifolds of one triangle");
    for (triangle, manifold) in &by_triangle {
        let expected =
            all.get(triangle).unwrap_or_else(|| panic!("{name}: {triangle} is invented"));
        assert_eq!(bits(manifold), bits(expected), "{name}: {triangle}");
    }
    let mut count = 0;
    for (triangle, expected) in &all {
        if touches(expected, question.prediction) {
            count += 1;
            assert!(
                by_triangle.contains_key(triangle),
                "{name}: {triangle} is lost, {:?} {}",
                expected.points,
                question.prediction
            );
        }
    }
    count
}

/// The same for stock's dispatcher: its manifolds with a point within the prediction distance are ours.
fn check_against_stock(name: &str, dispatcher: &SbbkDispatcher, question: &Question) {
    let touching = |manifolds: Vec<Manifold>| -> BTreeMap<u32, Vec<u32>> {
        let near = manifolds.into_iter().filter(|m| touches(m, question.prediction));
        near.map(|m| (question.triangle_of(&m), bits(&m))).collect()
    };
    let stock = touching(question.fresh(&DefaultQueryDispatcher));
    assert_eq!(touching(question.fresh(dispatcher)), stock, "{name}");
}

/// A pose at which a shape is about a triangle of the mesh: just apart, touching, inside.
fn pose(random: &mut Rand32, mesh: &TriMesh, size: Real) -> Pose3 {
    let triangle = mesh.triangle(random.rand_range(0..mesh.indices().len() as u32));
    let turn = rotation(random);
    let away = direction(random) * (0.5 + 0.2 * random.rand_float()) * size;
    Pose3::from_parts(triangle.center() + away, turn)
}

/// A pose with a turn by multiples of 90 degrees and a shift by multiples of a sixteenth.
fn lattice_pose(random: &mut Rand32) -> Pose3 {
    let mut quarter =
        |axis| Quat::from_axis_angle(axis, FRAC_PI_2 * random.rand_range(0..4) as Real);
    let turn = quarter(Vec3::X) * quarter(Vec3::Y) * quarter(Vec3::Z);
    let [x, y, z] = [(); 3].map(|()| random.rand_range(0..33) as Real / 16.0 - 1.0);
    Pose3::from_parts(Vec3::new(x, y, z), turn)
}

const PREDICTIONS: [Real; 4] = [0.0, 0.002, 0.02, 0.2];

/// Would catch a triangle that the descent or the leaf test drops, one that is kept though Parry sees no contact, and any
/// other pose, order, constraint or argument than stock passes.
#[test]
fn fresh_contacts_are_those_of_parrys_routine_on_all_triangles() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(1);
    let [head, constrained] = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES]
        .map(|flags| shape_with(&mesh::monkey_head(), flags));
    for size in [0.1, 0.6, 3.0] {
        for (name, shape) in shapes(size) {
            let mut count = 0;
            for (i, prediction) in PREDICTIONS.into_iter().cycle().take(16).enumerate() {
                let mesh = if i % 8 < 4 { &head } else { &constrained };
                let is_lattice = i >= 12;
                let pose = if is_lattice {
                    lattice_pose(&mut random)
                } else {
                    pose(&mut random, mesh, size)
                };
                for flipped in [false, true] {
                    let question = Question { mesh, shape: &shape, pose, prediction, flipped };
                    count += check_fresh(name, &dispatcher, &question);
                    check_against_stock(name, &dispatcher, &question);
                }
            }
            assert!(count > 10, "{name} of {size}: {count} contacts");
        }
    }
}

/// Would catch rounding that grows with the floor and is not allowed for, and a floor that is cut off too early.
#[test]
fn a_huge_floor_loses_no_contact() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(2);
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let mut count = 0;
    for half in [50.0, 2000.0] {
        let shape = SharedShape::cuboid(half, 0.25, half);
        for i in 0..60 {
            let turn = if i % 4 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
            let [x, z] = [(); 2].map(|()| 1.8 * half * (random.rand_float() - 0.5));
            let at = Vec3::new(x, 0.25 + 0.9 * random.rand_float(), z);
            // The head in the frame of the floor, and back.
            let pose = Pose3::from_parts(at, turn).inverse();
            let prediction = PREDICTIONS[i % 4];
            for flipped in [false, true] {
                let question = Question { mesh: &head, shape: &shape, pose, prediction, flipped };
                count += check_fresh("floor", &dispatcher, &question);
            }
        }
    }
    assert!(count > 1000, "{count} contacts");
}

/// Points and whole manifolds that Parry keeps from step to step it only moves along, while they drift by up to a
/// thousandth of a unit and a degree: distances this close to the prediction distance may go either way.
const BAND: Real = 2e-3;
/// How far a kept depth may be off for the same reason: a degree over a unit.
const DEPTH: Real = 2e-2;

/// A pair in motion: small steps, at times a jump, another prediction distance, or a workspace taken away.
fn walk(name: &str, shape: &SharedShape, size: Real, flipped: bool, seed: u64) -> [u64; 4] {
    let dispatcher = counting();
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let mut random = Rand32::new(seed);
    let mut question = Question {
        mesh: &head,
        shape,
        pose: pose(&mut random, &head, size),
        prediction: 0.02,
        flipped,
    };
    let mut pair: Pair = Pair::default();
    let mut stride = 1e-3;
    // Parry's GJK sees or does not see contacts by where it begins: here where stock begins.
    let mut stock: Pair = Pair::default();
    let (mut contact_count, mut unseen_count) = (0, 0);
    for _ in 0..400 {
        match random.rand_range(0..100) {
            0..=2 => question.pose = pose(&mut random, &head, size),
            3..=5 => question.prediction = PREDICTIONS[random.rand_range(0..4) as usize],
            6 => (pair.workspace, stock.workspace) = (None, None),
            7 => stride = [0.0, 1e-5, 1e-3, 1e-2][random.rand_range(0..4) as usize],
            _ => question.pose = nudge(&mut random, stride) * question.pose,
        }
        question.ask(&dispatcher, &mut pair);
        question.ask(&DefaultQueryDispatcher, &mut stock);
        let wider = Question { prediction: question.prediction + BAND, ..question };
        let all = wider.brute_force();
        let mut found = BTreeMap::new();
        for manifold in pair.manifolds.iter().filter(|m| touches(m, question.prediction)) {
            let triangle = question.triangle_of(manifold);
            assert!(
                found.insert(triangle, distance(manifold)).is_none(),
                "{name}: {triangle} twice"
            );
        }
        for (triangle, near) in &found {
            let expected = all.get(triangle).map(distance);
            // Parry's GJK does not see every contact of a cylinder: its distance is another way to ask.
            let is_unseen = expected.is_none() && question.apart(*triangle) <= wider.prediction;
            let off = expected.map_or(Real::INFINITY, |expected| (near - expected).abs());
            assert!(
                is_unseen || off <= DEPTH,
                "{name}: {triangle} is {near} deep, fresh {expected:?}"
            );
        }
        let has = |manifold: &Manifold, triangle| {
            question.triangle_of(manifold) == triangle && touches(manifold, question.prediction)
        };
        for (&triangle, expected) in &all {
            let is_in = distance(expected) < question.prediction - BAND;
            contact_count += usize::from(is_in);
            if is_in && !found.contains_key(&triangle) {
                let is_stocks = stock.manifolds.iter().any(|manifold| has(manifold, triangle));
                assert!(!is_stocks, "{name}: {triangle} is lost");
                unseen_count += 1;
            }
        }
    }
    assert!(100 * unseen_count <= contact_count, "{name}: {unseen_count} of {contact_count}");
    let stats = dispatcher.stats();
    [stats.queries, stats.unchanged_queries, stats.reused_queries, stats.descended_queries]
}

/// Would catch candidates that are kept too long, bounds of distance that are too high, axes that do not hold at another
/// pose, manifolds given to another triangle, and anything else that depends on where the pair was before. Proves
/// that candidates were kept.
#[test]
fn motion_loses_no_contact() {
    let floor = ("floor", floor());
    for (seed, (name, shape)) in shapes(0.6).into_iter().chain([floor]).enumerate() {
        for flipped in [false, true] {
            let [all, unchanged, reused, descended] = walk(name, &shape, 0.6, flipped, seed as u64);
            assert_eq!(all, 400);
            assert!(
                reused >= 20 && descended > 10,
                "{name}: {reused} reused, {descended} descended"
            );
            assert!(unchanged + reused + descended <= all);
        }
    }
}

/// A pose at which a shape is `gap` away from the mesh, found by going towards it.
fn near_pose(random: &mut Rand32, mesh: &TriMesh, shape: &SharedShape, gap: Real) -> Pose3 {
    let turn = rotation(random);
    let away = direction(random);
    let at = |way: Real| Pose3::from_parts(way * away, turn);
    let distance =
        |way| DefaultQueryDispatcher.distance(&at(way), mesh, &*shape.0).unwrap().distance;
    let mut way = 4.0;
    for _ in 0..100 {
        way -= distance(way) - gap;
    }
    at(way)
}

/// Would catch a manifold, a list of points or of candidates that is made anew in each step, in Parry's routines too. The
/// shapes do not overlap: Parry's EPA allocates.
#[test]
fn steady_contact_allocates_nothing() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::FIX_INTERNAL_EDGES);
    let dispatcher = counting();
    for (name, shape) in shapes(0.6).into_iter().chain([("floor", floor())]) {
        let mut random = Rand32::new(5);
        let question = |pose, flipped| Question {
            mesh: &head,
            shape: &shape,
            pose,
            prediction: 0.02,
            flipped,
        };
        for (flipped, stride) in [(false, 1e-4), (true, 1e-3), (false, 6e-3)] {
            let starts = (0..200).map(|_| near_pose(&mut random, &head, &shape, 0.012));
            let is_good = |&pose: &Pose| {
                let found = question(pose, flipped).fresh(&dispatcher);
                found.len() > 1 && found.iter().all(|manifold| distance(manifold) > 0.011)
            };
            let start = { starts }.find(is_good).expect("most ways end near the mesh");
            let poses: Vec<Pose> = (0..20).map(|_| nudge(&mut random, stride) * start).collect();
            let mut pair = Pair::<ContactManifoldData, ContactData>::default();
            for &pose in poses.iter().cycle().take(20 * 25) {
                question(pose, flipped).ask(&dispatcher, &mut pair);
            }
            for &pose in poses.iter().cycle().take(20 * 4) {
                let question = question(pose, flipped);
                let allocated = measure(|| _ = question.ask(&dispatcher, &mut pair));
                assert_eq!(allocated.count_total, 0, "{name}, {stride}: {allocated:?}");
            }
        }
    }
}

/// Would catch a panic in a descent or in Parry's routine, and contacts at poses that are none.
#[test]
fn poses_that_are_none_have_no_contacts() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let dispatcher = SbbkDispatcher::default();
    for (name, shape) in shapes(0.6) {
        for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            let shift = Pose3::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
            let turn = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
            for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
                let mut question = Question {
                    mesh: &head,
                    shape: &shape,
                    pose: Pose3::IDENTITY,
                    prediction: 0.02,
                    flipped,
                };
                let mut pair: Pair = Pair::default();
                // With a tree and kept contacts, and as a first query.
                question.ask(&dispatcher, &mut pair);
                question.pose = pose;
                // A half-space reaches to infinity on one side.
                let is_in = name == "half-space" && broken.is_infinite();
                let count = question.ask(&dispatcher, &mut pair).manifolds.len();
                assert!(count == 0 || is_in, "{name}, {pose:?}: {count} contacts");
                question.fresh(&dispatcher);
            }
        }
    }
    let (_, ball) = shapes(0.6).remove(0);
    let pose = Pose3::IDENTITY;
    let question =
        Question { mesh: &head, shape: &ball, pose, prediction: Real::NAN, flipped: false };
    assert_eq!(question.fresh(&dispatcher).len(), 0);
}

/// Would catch candidates of a shape that is no longer there, where a host keeps the workspace of a pair over an edit.
#[test]
fn another_shape_with_the_same_workspace_is_noticed() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let dispatcher = counting();
    let mut random = Rand32::new(6);
    let pose = pose(&mut random, &head, 0.6);
    let mut pair: Pair = Pair::default();
    for (name, shape) in shapes(0.6).into_iter().chain(shapes(0.7)) {
        let question =
            Question { mesh: &head, shape: &shape, pose, prediction: 0.02, flipped: false };
        for _ in 0..2 {
            let found = question.ask(&dispatcher, &mut pair);
            let found: Vec<_> = found.manifolds.iter().map(bits).collect();
            let expected: Vec<_> = question.fresh(&dispatcher).iter().map(bits).collect();
            assert_eq!(found, expected, "{name}");
        }
    }
    let stats = dispatcher.stats();
    assert_eq!(stats.unchanged_queries, 30, "{stats:?}");
}

/// Would catch manifolds of stock's that are taken for ours, or dropped with their data where the shapes are the same.
#[test]
fn stock_can_hand_over_a_pair() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(7);
    for (name, shape) in shapes(0.6) {
        let pose = pose(&mut random, &head, 0.5);
        let question =
            Question { mesh: &head, shape: &shape, pose, prediction: 0.05, flipped: true };
        let mut pair: Pair<(), u32> = Pair::default();
        question.ask(&DefaultQueryDispatcher, &mut pair);
        let points = pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points);
        points.enumerate().for_each(|(index, point)| point.data = index as u32 + 1);
        question.ask(&dispatcher, &mut pair);
        let expected: Vec<_> = question.fresh(&dispatcher).iter().map(|m| m.subshape2).collect();
        let found: Vec<_> = pair.manifolds.iter().map(|m| m.subshape2).collect();
        assert_eq!(found, expected, "{name}");
        let mut points = pair.manifolds.iter().flat_map(|manifold| &manifold.points);
        assert!(points.all(|point| point.data > 0), "{name}: data is lost");
    }
}

/// A head that falls on a floor and comes to rest: where it is, step by step.
fn fall(floor: SharedShape, dispatcher: Option<SbbkDispatcher>) -> Vec<Pose> {
    let mut world = PhysicsWorld::new();
    if let Some(dispatcher) = dispatcher {
        world.narrow_phase.set_query_dispatcher(dispatcher);
    }
    let fixed = world.bodies.insert(RigidBodyBuilder::fixed());
    let floor = ColliderBuilder::new(floor).build();
    world.colliders.insert_with_parent(floor, fixed, &mut world.bodies);
    let start = RigidBodyBuilder::dynamic().translation(Vec3::new(0.3, 1.6, -0.2));
    let start = start.angular_damping(2.0).build();
    let body = world.bodies.insert(start);
    let head =
        ColliderBuilder::new(mesh::monkey_head().shared_shape().unwrap()).density(1.0).build();
    world.colliders.insert_with_parent(head, body, &mut world.bodies);
    let step = |_| {
        world.step();
        *world.bodies[body].position()
    };
    (0..600).map(step).collect()
}

/// Would catch contacts that flicker, sink in or do not hold a body at rest: ten seconds on a floor, beside stock. A
/// head rolls to where it likes, which is chaos; so heights and speeds are compared, not places.
#[test]
fn a_head_rests_on_a_floor_as_with_stock() {
    for shape in [SharedShape::cuboid(50.0, 0.25, 50.0), SharedShape::halfspace(Vec3::Y)] {
        let dispatcher = counting();
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
