//! Promises that hold for a pair of every kind: see [`kinds`].

use crate::kinds::{Kind, kinds, mesh_pairs};
use crate::prelude::*;
use allocation_counter::measure;
use rapier3d::geometry::{ContactData, ContactManifoldData};

const PREDICTIONS: [Real; 4] = [0.0, 0.002, 0.02, 0.2];
/// Lengths of a step in units and radians, from far below any slack to beyond it.
const STRIDES: [Real; 5] = [0.0, 1e-5, 1e-3, 1e-2, 3e-2];

/// Moves a pair at random, with jumps, ways back, lost workspaces, other dispatchers, poses far
/// away or NaN, and a host that changes the list. A dispatcher without memory must give the same
/// bits.
fn walk(
    question: &mut Question,
    kind: &Kind,
    random: &mut Rand32,
    steps: usize,
    [dispatcher, unaware]: [&SbbkDispatcher; 2],
) -> usize {
    let mut pair: Pair = Pair::default();
    let (mut stride, mut contacts, mut before) = (1e-3, 0, question.pose);
    for step in 0..steps {
        let pick = random.rand_range(0..5) as usize;
        let last = question.pose;
        match random.rand_range(0..100) {
            0..=2 => question.pose = kind.pose(random, -0.02),
            3..=5 => question.prediction = PREDICTIONS[pick % 4],
            6 => pair.workspace = None,
            7..=9 => stride = STRIDES[pick],
            10 => question.pose.translation.y += 50.0,
            11 => question.pose.translation.z = Real::NAN,
            12 => _ = pair.ask(&every(), question),
            13 => _ = pair.ask(&DefaultQueryDispatcher, question),
            14..=17 => std::mem::swap(&mut question.pose, &mut before),
            18..=25 => question.pose = meddle(&mut pair.manifolds, pick, random) * last,
            _ => question.pose = nudge(random, stride) * last,
        }
        pair.ask(dispatcher, question);
        let expected = question.fresh(unaware);
        assert_bits(&pair.manifolds, &expected, &format!("{}, step {step}", kind.name));
        contacts += expected.len();
        let at = question.pose.translation;
        if !(at.is_finite() && at.length() < 20.0) {
            question.pose = last;
        }
    }
    contacts
}

/// Removes, copies, reorders or empties manifolds, as a host may. Returns how a pair then moves: at
/// an equal pose, a list of the same length counts as unchanged.
fn meddle(manifolds: &mut Vec<Manifold>, pick: usize, random: &mut Rand32) -> Pose {
    match pick {
        0 => _ = manifolds.pop(),
        1 => drop(manifolds.drain(..manifolds.len().min(1))),
        2 => manifolds.extend(manifolds.first().cloned()),
        3 => manifolds.reverse(),
        _ => manifolds.iter_mut().for_each(|manifold| {
            *manifold = Manifold::with_data(manifold.subshape1, manifold.subshape2, ());
        }),
    }
    let may_rest = pick < 3 && random.rand_range(0..2) == 0;
    if may_rest { Pose::IDENTITY } else { nudge(random, 1e-5) }
}

/// Would catch candidates kept too long, an old pose taken for the present one, and bounds of
/// distance that are too high. Would also catch manifolds that come twice, out of order, or of
/// another subshape.
#[test]
fn the_answer_does_not_depend_on_the_motion_before() {
    let pairs = mesh_pairs();
    let kinds = kinds().iter().map(|kind| (kind, 400)).chain(pairs.iter().map(|pair| (pair, 1200)));
    for (seed, (kind, steps)) in (0..).zip(kinds) {
        let (name, dispatcher, patches) = (&kind.name, every(), counting_patches());
        let mut random = Rand32::new(seed);
        let mut question = kind.question(kind.pose(&mut random, 0.0)).flipped(seed % 2 == 1);
        let contacts = walk(&mut question, kind, &mut random, steps, [&dispatcher, &every()]);
        question.is_flipped = !question.is_flipped;
        let unaware = SbbkDispatcher::default();
        walk(&mut question, kind, &mut random, steps / 4, [&patches, &unaware]);
        let stats = dispatcher.stats();
        assert_eq!(stats.queries, steps as u64, "{name}");
        assert!(contacts > steps / 2, "{name}: {contacts} contacts");
        assert!(stats.descended_queries > 10, "{name}: {stats:?}");
        assert!((stats.internals.unchanged_queries > 0) != kind.is_soft, "{name}: {stats:?}");
        assert!((stats.internals.walks > 50) || name != "large mesh", "{name}: {stats:?}");
        assert!((stats.internals.reused_queries >= 20) != kind.is_soft, "{name}: {stats:?}");
    }
}

/// Soft bodies need each contact's triangle. Would catch patches or surfaces of a mesh that may
/// deform, wrong cones, and contacts that the flag alone changes.
#[test]
fn meshes_that_may_deform_have_every_contact_of_their_triangles() {
    let all = TriMeshFlags::all() - TriMeshFlags::DEFORMABLE;
    let dispatchers = [every(), SbbkDispatcher::default()];
    for (seed, kind) in (0..).zip(kinds().iter().filter(|kind| !kind.is_soft)) {
        let mut random = Rand32::new(seed);
        let (mut pose, mut count) = (kind.pose(&mut random, -0.02), 0);
        for (i, flags) in [TriMeshFlags::empty(), all].repeat(5).into_iter().enumerate() {
            pose = nudge(&mut random, 0.02) * pose;
            let ask = |flags: [TriMeshFlags; 2], dispatcher: &SbbkDispatcher| {
                let [one, two] = [0, 1].map(|side| flagged(&kind.shapes[side], flags[side]));
                Question::new(&*one, &*two, pose).flipped(i % 4 < 2).fresh(dispatcher)
            };
            let expected = ask([flags; 2], &per_triangle());
            let soft = flags | TriMeshFlags::DEFORMABLE;
            for of in [[soft, flags], [flags, soft], [soft, soft]] {
                let is_soft =
                    [0, 1].map(|i| of[i] == soft && kind.shapes[i].as_trimesh().is_some());
                if is_soft != [false; 2] {
                    let found = ask(of, &dispatchers[i % 2]);
                    assert_bits(&found, &expected, &format!("{}, {of:?}", kind.name));
                }
            }
            count += expected.len();
        }
        assert!(count > 10, "{}: {count} contacts", kind.name);
    }
}

/// The shape; if it is a mesh, with other flags.
fn flagged(shape: &SharedShape, flags: TriMeshFlags) -> SharedShape {
    let mesh = shape.as_trimesh().map(|mesh| SharedShape::new(rebuilt(mesh, flags)));
    mesh.unwrap_or_else(|| shape.clone())
}

/// Would catch a panic, and contacts at poses that are not finite.
#[test]
fn poses_that_are_not_finite_have_no_contacts() {
    let dispatcher = every();
    for (seed, kind) in (0..).zip(kinds()) {
        let start = kind.pose(&mut Rand32::new(seed), -0.02);
        for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            let shift = Pose::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
            let turn = Pose::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
            for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
                let question = kind.question(start).flipped(flipped);
                let mut pair: Pair = Pair::default();
                assert!(!pair.ask(&dispatcher, &question).manifolds.is_empty(), "{}", kind.name);
                pair.ask(&dispatcher, &question.at(pose));
                // A half-space reaches to infinity on one side.
                let is_in = kind.name == "half-space" && broken.is_infinite();
                assert!(pair.manifolds.is_empty() || is_in, "{}, {pose:?}", kind.name);
                assert!(question.at(pose).fresh(&dispatcher).is_empty() || is_in);
                assert!(question.within(Real::NAN).fresh(&dispatcher).is_empty());
            }
        }
    }
}

/// Would catch lost data of a host where a dispatcher takes over a running world. Rapier takes the
/// workspace away if a shape may have changed. Then manifolds must not stay.
#[test]
fn manifolds_keep_their_data_with_a_foreign_workspace_but_not_without_one() {
    let dispatcher = per_triangle();
    let mut kept = 0;
    for (seed, kind) in (0..).zip(kinds()) {
        let pose = kind.pose(&mut Rand32::new(seed), -0.02);
        for flipped in [false, true] {
            let question = kind.question(pose).flipped(flipped);
            let expected = question.fresh(&dispatcher);
            let ask_another = |pair: &mut Pair<u32>, is_stock: bool| {
                let [g1, g2] = question.host_shapes();
                let (pos12, Pair { manifolds, workspace }) = (question.pos12(), pair);
                let stock: &dyn PersistentQueryDispatcher<_, _> = &DefaultQueryDispatcher;
                let another: &dyn PersistentQueryDispatcher<_, _> = &per_triangle();
                let another = if is_stock { stock } else { another };
                another.contact_manifolds(&pos12, g1, g2, 0.02, manifolds, workspace)
            };
            for is_stock in [false, true] {
                let mut pair = Pair::<u32>::default();
                // Stock has nothing for meshes and height fields.
                if ask_another(&mut pair, is_stock).is_err() {
                    continue;
                }
                (1..).zip(&mut pair.manifolds).for_each(|(mark, manifold)| manifold.data = mark);
                let before: BTreeMap<_, _> =
                    pair.manifolds.iter().map(|m| (triangles(m), m.data)).collect();
                for manifold in &pair.ask(&dispatcher, &question).manifolds {
                    let data = before.get(&triangles(manifold)).copied();
                    assert_eq!(manifold.data, data.unwrap_or(0), "{}, {is_stock}", kind.name);
                    kept += usize::from(data.is_some());
                }
                assert_same(&pair.manifolds, &expected, 0.0);
                pair.workspace = None;
                pair.ask(&dispatcher, &question);
                assert!(pair.manifolds.iter().all(|manifold| manifold.data == 0), "{}", kind.name);
                assert_same(&pair.manifolds, &expected, 0.0);
            }
        }
    }
    assert!(kept > 1000, "{kept} manifolds");
}

/// Would catch candidates of a shape that is no longer there, if a host keeps the workspace.
#[test]
fn another_shape_with_the_same_workspace_is_noticed() {
    let dispatcher = every();
    let pose = Pose::translation(0.9, 0.1, 0.0);
    let (mut pair, mut touching) = (Pair::default(), 0);
    let pairs = mesh_pairs();
    for kind in kinds().iter().chain(&pairs).chain(kinds().iter().rev()) {
        let question = kind.question(pose);
        for _ in 0..2 {
            let expected = question.fresh(&every());
            assert_bits(&pair.ask(&dispatcher, &question).manifolds, &expected, &kind.name);
            touching += usize::from(!expected.is_empty());
        }
    }
    assert!(touching > 60, "{touching} queries with contacts");
}

/// Counts the allocations of a pair that shakes about a place by `stride` (units and radians),
/// after its buffers have reached their size.
fn allocations(dispatcher: &SbbkDispatcher, question: &Question, stride: Real) -> u64 {
    let mut random = Rand32::new(1);
    let shake = |_| nudge(&mut random, 0.5 * stride) * question.pose;
    let poses: Vec<Pose> = (0..20).map(shake).collect();
    let mut pair = Pair::<ContactManifoldData, ContactData>::default();
    for &pose in poses.iter().cycle().take(20 * 40) {
        pair.ask(dispatcher, &question.at(pose));
    }
    assert!(!pair.manifolds.is_empty(), "the pair must stay in contact");
    let steady = poses.iter().cycle().take(20 * 5);
    steady.map(|&pose| measure(|| _ = pair.ask(dispatcher, &question.at(pose))).count_total).sum()
}

/// Would catch manifolds, points, candidates or lists that are allocated in each step, at rest or
/// in motion.
#[test]
fn steady_contact_allocates_nothing() {
    for (seed, kind) in (0..).zip(kinds()) {
        let mut random = Rand32::new(seed);
        let pose = kind.pose(&mut random, -0.03);
        for (detail, dispatcher) in [("every", every()), ("patches", counting_patches())] {
            // The last case has less slack than its steps are long.
            for (flipped, stride, prediction) in
                [(false, 1e-4, 0.02), (true, 1e-3, 0.02), (false, 2.5e-2, 0.002)]
            {
                let question = kind.question(pose).within(prediction).flipped(flipped);
                let count = allocations(&dispatcher, &question, stride);
                assert_eq!(count, 0, "{}, {detail}, steps of {stride}", kind.name);
            }
            let stats = dispatcher.stats();
            assert!(stats.descended_queries > 100, "{}: {stats:?}", kind.name);
        }
    }
}

/// Would catch memory of a thread that many light pairs make it drop between two queries of a heavy
/// one.
#[test]
#[cfg_attr(feature = "parallel", ignore = "heavy pairs are split, and the pool allocates")]
fn light_pairs_make_no_heavy_pair_allocate() {
    let (floor, light) = (shape(&mesh::floor(4.0, 12)), shape(&mesh::cuboid(Vec3::ONE, 1)));
    let heavy = Question::new(&floor, &floor, Pose::IDENTITY);
    let light = Question::new(&light, &light, Pose::IDENTITY);
    let (dispatcher, mut pairs) = (per_triangle(), [(); 2].map(|()| Pair::<(), ()>::default()));
    let mut step = |number: usize| {
        let at = |y: Real, i: usize| Pose::from_translation((y - 1e-6 * (i % 8) as Real) * Vec3::Y);
        pairs[0].ask(&dispatcher, &heavy.at(at(0.01, number)));
        (0..100).for_each(|i| _ = pairs[1].ask(&dispatcher, &light.at(at(2.01, i))));
        pairs[0].manifolds.len()
    };
    assert!((0..20).map(&mut step).all(|count| count > 1400));
    let count = measure(|| (0..10).for_each(|number| _ = step(number))).count_total;
    assert_eq!(count, 0);
}

/// Would catch a counter of allocations that counts nothing.
#[test]
fn the_first_query_allocates() {
    let kind = &kinds()[0];
    let question = kind.question(kind.pose(&mut Rand32::new(1), -0.02));
    let (mut pair, dispatcher) = (Pair::<(), ()>::default(), SbbkDispatcher::default());
    assert!(measure(|| _ = pair.ask(&dispatcher, &question)).count_total > 10);
    assert!(pair.manifolds.iter().any(|manifold| distance(manifold) < 0.0));
}
