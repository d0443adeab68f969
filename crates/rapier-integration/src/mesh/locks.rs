//! Which queries wait for the cache.

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use parry3d::math::Vector;
use parry3d::shape::{Ball, TriMesh, TriMeshFlags};
use sbbk_core::tree::BuildOptions;

use super::{KnownMesh, TreeCache};

/// Would catch a query that takes the lock of all threads though it has its trees, or needs none;
/// and one that begins to once a mesh is unsupported.
#[test]
fn pairs_that_have_their_trees_take_no_lock() {
    let cache = Arc::new(TreeCache::new(BuildOptions::default(), 1 << 20));
    let (vertices, triangles) = Ball::new(1.0).to_trimesh(12, 6);
    let broken_vertices = vertices.iter().map(|&vertex| vertex / vertex.y.min(0.0)).collect();
    let broken = TriMesh::new(broken_vertices, triangles.clone()).expect("it has triangles");
    let soft = TriMesh::with_flags(vertices.clone(), triangles.clone(), TriMeshFlags::DEFORMABLE)
        .expect("it has triangles");
    let mesh = TriMesh::new(vertices, triangles).expect("it has triangles");
    assert!(broken.vertices().iter().any(|vertex| *vertex != Vector::ZERO && !vertex.is_finite()));
    let mut known = KnownMesh::default();
    // The first query does not look for it.
    for has_tree in [false, true] {
        known.update(&cache.look_at(&mesh).expect("it is finite"));
        let found = known.look_up(&mesh, 0, &cache).expect("it is rigid");
        assert_eq!(found.tree.is_some(), has_tree);
    }

    let held = cache.lock();
    let (done, is_done) = channel();
    let same = Arc::clone(&cache);
    thread::spawn(move || {
        for _ in 0..20 {
            assert!(same.look_at(&broken).is_none() && same.look_at(&soft).is_some());
            known.update(&same.look_at(&mesh).expect("it is finite"));
            assert!(known.look_up(&mesh, 0, &same).is_some_and(|known| known.tree.is_some()));
        }
        // To drop what is known takes the lock.
        let _ = done.send(known);
    });
    let known = is_done.recv_timeout(Duration::from_secs(60));
    drop(held);
    assert!(known.is_ok(), "a query waits for the cache");
}
