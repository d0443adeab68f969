use std::time::{Duration, Instant};

use allocation_counter::measure;
use glamx::Vec3;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::math::Pose;
use rapier3d::parry::query::QueryDispatcher;
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use crate::support::{shape, shape_with};

fn beside() -> Pose {
    Pose::translation(3.0, 0.1, 0.2)
}

/// The smallest mesh there is; another one for each number.
fn one_triangle(number: usize) -> TriMesh {
    let corner = Vec3::new(1.0 + number as f32, 0.0, 0.0);
    TriMesh::new(vec![Vec3::ZERO, corner, Vec3::Y], vec![[0, 1, 2]]).unwrap()
}

/// Would catch trees that outlive their dispatcher in the memory of threads that asked it.
#[test]
fn a_dropped_dispatcher_leaves_nothing_behind() {
    let (head, ball) = (shape(&mesh::monkey_head()), shape(&mesh::ball(1.0, 6)));
    let ask = || {
        let dispatcher = SbbkDispatcher::default();
        dispatcher.distance(&beside(), &head, &ball).unwrap();
        dispatcher.intersection_test(&beside(), &head, &ball).unwrap();
    };
    // The buffers of the search stay with the thread.
    ask();
    let left = measure(ask);
    assert!(left.bytes_max > 100_000, "{left:?}");
    // A place for each tree, without the tree.
    assert!(left.bytes_current < 4096, "{left:?}");
}

/// Would catch trees of queries without manifolds that nothing can drop, or that each query builds.
#[test]
fn trees_of_queries_without_manifolds_are_idle_and_can_be_released() {
    let (head, ball) = (shape(&mesh::monkey_head()), shape(&mesh::ball(1.0, 6)));
    let dispatcher = SbbkDispatcher::default();
    let ask = || dispatcher.distance(&beside(), &head, &ball).unwrap();
    let first = ask();
    for _ in 0..3 {
        assert_eq!(ask(), first);
    }
    let stats = dispatcher.stats();
    assert_eq!([stats.trees, stats.idle_trees, stats.tree_builds as usize], [2, 2, 2]);
    let released = measure(|| dispatcher.release_idle_trees()).bytes_current;
    assert!(-released > stats.tree_bytes as i64 / 2, "{released} of {}", stats.tree_bytes);
    assert_eq!(dispatcher.stats().trees, 0);
    assert_eq!(ask(), first);
    assert_eq!(dispatcher.stats().tree_builds, 4);
}

/// Would catch a limit that counts less than the trees take, tiny ones above all.
#[test]
fn idle_trees_take_what_is_counted() {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let tiny: Vec<TriMesh> = (0..1000).map(one_triangle).collect();
    let small: Vec<TriMesh> =
        (1..50).map(|i| shape_with(&mesh::ball(i as f32, 3), flags)).collect();
    let large = vec![shape(&mesh::ball(1.0, 30))];
    let probe = one_triangle(0);
    for (name, meshes) in [("tiny", tiny), ("small", small), ("large", large)] {
        for has_queries in [false, true] {
            let dispatcher = SbbkDispatcher::default();
            // Buffers of the thread.
            SbbkDispatcher::default().distance(&beside(), &meshes[0], &probe).unwrap();
            let taken = measure(|| {
                for mesh in &meshes {
                    dispatcher.prepare(mesh).unwrap();
                    if has_queries {
                        dispatcher.distance(&beside(), mesh, &probe).unwrap();
                    }
                }
            });
            let stats = dispatcher.stats();
            assert_eq!(stats.idle_trees, stats.trees);
            let share = stats.tree_bytes as f64 / taken.bytes_current as f64;
            assert!((0.8..1.2).contains(&share), "{name}: {share} of {taken:?}");
        }
    }
}

/// Would catch a limit that is not kept.
#[test]
fn idle_trees_stay_below_their_limit() {
    let mut config = SbbkConfig::default();
    config.idle_tree_bytes = 100_000;
    let dispatcher = SbbkDispatcher::new(config);
    for number in 0..1000 {
        dispatcher.prepare(&one_triangle(number)).unwrap();
        assert!(dispatcher.stats().tree_bytes <= 100_000);
    }
    let stats = dispatcher.stats();
    assert!(stats.tree_bytes > 80_000, "{stats:?}");
    dispatcher.release_idle_trees();
    assert_eq!(dispatcher.stats().tree_bytes, 0);
}

/// Would catch a list of idle trees that is searched from end to end, under the lock of all
/// threads: the time of a mesh that comes and goes must not grow with the number of idle ones.
#[test]
fn many_idle_trees_cost_no_time() {
    const BATCH: usize = 500;
    let dispatcher = {
        let mut config = SbbkConfig::default();
        config.idle_tree_bytes = usize::MAX;
        SbbkDispatcher::new(config)
    };
    let time_batch = |batch: usize| -> Duration {
        let meshes: Vec<TriMesh> = (batch * BATCH..(batch + 1) * BATCH).map(one_triangle).collect();
        let start = Instant::now();
        for mesh in &meshes {
            dispatcher.prepare(mesh).unwrap();
            dispatcher.prepare(mesh).unwrap();
        }
        start.elapsed()
    };
    let times: Vec<Duration> = (0..100).map(time_batch).collect();
    let fastest = |times: &[Duration]| *times.iter().min().unwrap();
    let [few, many] = [fastest(&times[..8]), fastest(&times[80..])];
    assert_eq!(dispatcher.stats().idle_trees, 100 * BATCH);
    assert!(many < 8 * few, "{few:?} among few, {many:?} among many");
}
