use crate::prelude::*;
use rapier_integration::SbbkStats;
use std::sync::Barrier;

/// Two of them touch when a bit more than a radius apart.
fn ball() -> TriMesh {
    shape(&mesh::ball(1.0, 6))
}

fn near() -> Pose {
    Pose::translation(1.6, 0.3, 0.2)
}

/// Asks about two meshes that touch: twice, as the first query of a pair looks for no trees. The
/// state of the pair must be kept by the caller.
fn touch(dispatcher: &SbbkDispatcher, mesh1: &TriMesh, mesh2: &TriMesh) -> Pair {
    let mut pair = Pair::default();
    ask_twice(&mut pair, dispatcher, &Question::new(mesh1, mesh2, near()));
    assert!(!pair.manifolds.is_empty());
    pair
}

/// Asks at a pose and a little beside: an equal pose needs no second search.
fn ask_twice(pair: &mut Pair, dispatcher: &SbbkDispatcher, query: &Question) {
    pair.ask(dispatcher, &query.at(query.pose.append_translation(Vector::splat(1e-4))));
    pair.ask(dispatcher, query);
}

/// Counts of trees, idle trees, builds and hits.
fn counts(dispatcher: &SbbkDispatcher) -> [u64; 4] {
    let SbbkStats { trees, internals, .. } = dispatcher.stats();
    [trees as u64, internals.idle_trees as u64, internals.tree_builds, internals.tree_hits]
}

/// Would catch 2000 trees, or 2000 builds, for a pile restored from a snapshot, where each collider
/// has its own copy of the mesh. Identities by address would cause them. Clones of a dispatcher
/// would, too, if each built trees of its own.
#[test]
fn two_thousand_copies_share_one_tree() {
    let dispatcher = SbbkDispatcher::default();
    let mesh = ball();
    let copy = |i| if i % 2 == 0 { mesh.clone() } else { rebuilt(&mesh, mesh.flags()) };
    let copies: Vec<TriMesh> = (0..2000).map(copy).collect();
    let pairs: Vec<Pair> =
        copies.windows(2).map(|two| touch(&dispatcher.clone(), &two[0], &two[1])).collect();
    assert_eq!(counts(&dispatcher), [1, 0, 1, 2 * 1998]);
    let bytes = dispatcher.stats().tree_bytes;
    drop(pairs);
    assert_eq!(counts(&dispatcher), [1, 1, 1, 2 * 1998]);
    assert!(bytes > 0 && dispatcher.stats().tree_bytes == bytes);
}

/// Would catch a tree used for another size of the same mesh, and a second one of a mesh whose
/// contact normals are constrained.
#[test]
fn another_scale_is_another_mesh_and_another_flag_is_none() {
    let dispatcher = SbbkDispatcher::default();
    let mesh = ball();
    let larger = mesh.clone().scaled(Vector::splat(1.25));
    let fixed = mesh::ball(1.0, 6).trimesh(TriMeshFlags::FIX_INTERNAL_EDGES);
    assert_eq!((mesh.vertices(), mesh.indices()), (fixed.vertices(), fixed.indices()));
    for (other, trees) in [(&larger, 2), (&fixed, 2)] {
        let pair = touch(&dispatcher, &mesh, other);
        assert_eq!(dispatcher.stats().trees, trees);
        let expected = Question::new(&mesh, other, near()).fresh(&SbbkDispatcher::default());
        assert_same(&pair.manifolds, &expected, 0.0);
    }
}

/// Would catch trees built for pairs that never come close: a world is full of them.
#[test]
fn meshes_far_apart_need_no_tree() {
    let dispatcher = SbbkDispatcher::default();
    let mesh = ball();
    let far = Question::new(&mesh, &mesh, Pose::translation(2.1, 0.0, 0.0));
    let mut pair: Pair = Pair::default();
    ask_twice(&mut pair, &dispatcher, &far);
    assert_eq!(counts(&dispatcher), [0, 0, 0, 0]);
    pair.ask(&dispatcher, &far.at(near()));
    assert_eq!(counts(&dispatcher), [0, 0, 0, 0], "it may leave again");
    ask_twice(&mut pair, &dispatcher, &far.at(near()));
    assert_eq!(counts(&dispatcher), [1, 0, 1, 0]);
}

/// Would catch memory that is never given back, and a tree in use that is.
#[test]
fn idle_trees_go_when_there_is_no_room() {
    let mesh = ball();
    let none_idle = with(|config| config.idle_tree_bytes = 0);
    let pairs = [touch(&none_idle, &mesh, &mesh), touch(&none_idle, &mesh, &mesh)];
    let [one, other] = pairs;
    drop(one);
    assert_eq!(counts(&none_idle), [1, 0, 1, 2]);
    drop(other);
    assert_eq!(counts(&none_idle), [0, 0, 1, 2]);
    assert_eq!(none_idle.stats().tree_bytes, 0);
}

/// Would catch a release that takes trees from living pairs, or leaves some behind.
#[test]
fn releasing_idle_trees_leaves_those_in_use() {
    let dispatcher = SbbkDispatcher::default();
    let (mesh, other) = (ball(), shape(&mesh::ball(1.1, 6)));
    let mut pair = touch(&dispatcher, &mesh, &mesh);
    drop(touch(&dispatcher, &other, &other));
    assert_eq!(counts(&dispatcher)[..2], [2, 1]);
    dispatcher.release_idle_trees();
    assert_eq!(counts(&dispatcher)[..2], [1, 0]);
    let query = Question::new(&mesh, &mesh, Pose::translation(1.7, 0.2, 0.1));
    pair.ask(&dispatcher, &query);
    assert_same(&pair.manifolds, &query.fresh(&SbbkDispatcher::default()), 0.0);
    drop(pair);
    dispatcher.release_idle_trees();
    assert_eq!(counts(&dispatcher)[..2], [0, 0]);
}

/// Would catch a tree of a living pair dropped with a clone of the pair (Rapier's narrow phase is
/// `Clone`).
#[test]
fn a_cloned_pair_keeps_its_trees() {
    let dispatcher = with(|config| config.idle_tree_bytes = 0);
    let mesh = ball();
    let mut pair = touch(&dispatcher, &mesh, &mesh);
    drop(pair.clone());
    assert_eq!(counts(&dispatcher)[..2], [1, 0]);
    let clone = pair.clone();
    let query = Question::new(&mesh, &mesh, Pose::translation(1.7, 0.2, 0.1));
    pair.ask(&dispatcher, &query);
    drop(pair);
    assert_eq!(counts(&dispatcher)[..2], [1, 0]);
    drop(clone);
    assert_eq!(counts(&dispatcher), [0, 0, 1, 0]);
}

/// Would catch a tree built by several threads, one used half built, or a deadlock.
#[test]
fn threads_build_one_tree_and_agree() {
    const THREADS: usize = 8;
    let head = shape(&mesh::monkey_head());
    let torus = shape(&mesh::torus(1.0, 0.4, 24, 12));
    let query = Question::new(&head, &torus, Pose::translation(1.2, 0.5, 0.3));
    let expected = query.fresh(&SbbkDispatcher::default());
    assert!(!expected.is_empty());
    for _ in 0..10 {
        let dispatcher = SbbkDispatcher::default();
        let together = Barrier::new(THREADS);
        let ask = || {
            together.wait();
            let mut pair: Pair = Pair::default();
            ask_twice(&mut pair, &dispatcher, &query);
            // No pair ends before all have begun.
            together.wait();
            pair.manifolds
        };
        std::thread::scope(|scope| {
            let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(ask)).collect();
            for thread in threads {
                assert_same(&thread.join().unwrap(), &expected, 0.0);
            }
        });
        assert_eq!(counts(&dispatcher)[..3], [2, 2, 2]);
    }
}

/// Would catch users counted wrongly when pairs come and go on many threads: a tree lost, or one
/// that stays.
#[test]
fn threads_come_and_go() {
    let mesh = ball();
    let dispatcher = with(|config| config.idle_tree_bytes = 0);
    let expected = Question::new(&mesh, &mesh, near()).fresh(&SbbkDispatcher::default());
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..200 {
                    let pair = touch(&dispatcher, &mesh, &mesh);
                    assert_same(&pair.manifolds, &expected, 0.0);
                }
            });
        }
    });
    assert_eq!(counts(&dispatcher)[..2], [0, 0]);
    assert_eq!(dispatcher.stats().pairs, 8 * 200);
}

/// Panics unless both meshes, equal in vertices and triangles, get the contacts from a shared
/// dispatcher that each gets alone. The number of questions whose answers differ between them.
fn check_shared(meshes: [&TriMesh; 2], other: &TriMesh, depths: &[f32]) -> usize {
    let [one, two] = meshes;
    assert_eq!((one.vertices(), one.indices()), (two.vertices(), two.indices()));
    let mut random = Rand32::new(1);
    let mut unlike = 0;
    for [first, second] in [[one, two], [two, one]] {
        let shared = per_triangle();
        let _kept = shared.prepare(first).unwrap();
        for &depth in depths {
            let query = Question::new(second, other, touching(&mut random, [second, other], depth));
            let alone = |mesh| {
                let query = Question { shapes: [mesh, other], ..query };
                query.fresh(&per_triangle())
            };
            let expected = alone(second);
            assert_same(&query.fresh(&shared), &expected, 0.0);
            let normals = |mesh| alone(mesh).iter().map(|m| m.local_n1).collect::<Vec<_>>();
            let is_like =
                sequence(&alone(first)) == sequence(&expected) && normals(first) == normals(second);
            unlike += usize::from(!is_like);
        }
    }
    unlike
}

/// The triangles in the order of Parry's hierarchy.
fn leaves(mesh: &TriMesh) -> Vec<u32> {
    mesh.bvh().leaves(|_| true).collect()
}

/// Would catch cones of one mesh used for another with equal triangles: scaling turns pseudo-
/// normals differently than a rebuild.
#[test]
fn scaled_meshes_keep_their_own_normals() {
    let other = shape(&mesh::ball(0.5, 4));
    let depths = [0.0, 0.05, 0.2].repeat(4);
    for flags in [TriMeshFlags::FIX_INTERNAL_EDGES, TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED] {
        for lab_mesh in [mesh::cuboid(Vector::new(2.0, 0.3, 2.0), 2), mesh::terrain(6.0, 8, 1.0)] {
            let scaled = lab_mesh.trimesh(flags).scaled(Vector::new(1.0, 0.2, 1.0));
            let built = rebuilt(&scaled, flags);
            assert_eq!(leaves(&scaled), leaves(&built), "nothing but the normals differs");
            let unlike = check_shared([&scaled, &built], &other, &depths);
            assert!(unlike > 3, "only {unlike} of 24 tell the meshes apart");
        }
    }
}
