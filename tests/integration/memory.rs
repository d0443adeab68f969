use crate::prelude::*;
use allocation_counter::measure;
use std::time::{Duration, Instant};

/// The smallest mesh there is; another one for each number.
fn one_triangle(number: usize) -> TriMesh {
    let corner = Vec3::new(1.0 + number as f32, 0.0, 0.0);
    TriMesh::new(vec![Vec3::ZERO, corner, Vec3::Y], vec![[0, 1, 2]]).unwrap()
}

/// Would catch a limit that counts less than the trees take, tiny ones above all.
#[test]
fn idle_trees_take_what_is_counted() {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let tiny: Vec<TriMesh> = (0..1000).map(one_triangle).collect();
    let small: Vec<TriMesh> = (1..50).map(|i| mesh::ball(i as f32, 3).trimesh(flags)).collect();
    let large = vec![shape(&mesh::ball(1.0, 30))];
    for (name, meshes) in [("tiny", tiny), ("small", small), ("large", large)] {
        let dispatcher = SbbkDispatcher::default();
        let taken =
            measure(|| meshes.iter().for_each(|mesh| drop(dispatcher.prepare(mesh).unwrap())));
        let stats = dispatcher.stats();
        assert_eq!(stats.internals.idle_trees, stats.trees);
        let share = stats.tree_bytes as f64 / taken.bytes_current as f64;
        assert!((0.8..1.2).contains(&share), "{name}: {share} of {taken:?}");
    }
}

/// Would catch a limit that is not kept.
#[test]
fn idle_trees_stay_below_their_limit() {
    let dispatcher = with(|config| config.idle_tree_bytes = 100_000);
    for number in 0..1000 {
        drop(dispatcher.prepare(&one_triangle(number)).unwrap());
        assert!(dispatcher.stats().tree_bytes <= 100_000);
    }
    let stats = dispatcher.stats();
    assert!(stats.tree_bytes > 80_000, "{stats:?}");
    dispatcher.release_idle_trees();
    assert_eq!(dispatcher.stats().tree_bytes, 0);
}

/// Would catch a linear search of the idle trees under a lock.
#[test]
fn many_idle_trees_cost_no_time() {
    const BATCH: usize = 500;
    let dispatcher = with(|config| config.idle_tree_bytes = usize::MAX);
    let time_batch = |batch: usize| -> Duration {
        let meshes: Vec<TriMesh> = (batch * BATCH..(batch + 1) * BATCH).map(one_triangle).collect();
        let start = Instant::now();
        for mesh in &meshes {
            drop(dispatcher.prepare(mesh).unwrap());
            drop(dispatcher.prepare(mesh).unwrap());
        }
        start.elapsed()
    };
    let times: Vec<Duration> = (0..100).map(time_batch).collect();
    let fastest = |times: &[Duration]| *times.iter().min().unwrap();
    let [few, many] = [fastest(&times[..8]), fastest(&times[80..])];
    assert_eq!(dispatcher.stats().internals.idle_trees, 100 * BATCH);
    assert!(many < 8 * few, "{few:?} among few, {many:?} among many");
}
