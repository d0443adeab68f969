use allocation_counter::measure;
use oorandom::Rand32;
use rapier_integration::{SbbkDispatcher, SbbkStats};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use crate::support::{
    Pair, Question, counting, counting_patches, nudge, shape, shape_with, touching,
};

/// Poses of a body that shakes about its place, over and over.
const POSES: usize = 20;
/// Rounds before allocations are counted: all buffers have reached their size.
const WARM_UP: usize = 20;

/// A pair that stays in contact and moves by at most `stride` from query to query; with Rapier's
/// own manifold data. The stats of the counted queries. Panics when one of them allocates.
fn steady(meshes: [&TriMesh; 2], stride: Real) -> SbbkStats {
    steady_with(&counting(), meshes, stride)
}

fn steady_with(dispatcher: &SbbkDispatcher, meshes: [&TriMesh; 2], stride: Real) -> SbbkStats {
    let mut random = Rand32::new(1);
    let pos12 = touching(&mut random, meshes, 0.01);
    let poses: Vec<Pose> = (0..POSES).map(|_| nudge(&mut random, 0.5 * stride) * pos12).collect();
    let mut pair = Pair::<ContactManifoldData, ContactData>::default();
    let mut ask = |pose: usize| {
        let query = Question::new(meshes[0], meshes[1], poses[pose % POSES]);
        pair.ask(dispatcher, &query).manifolds.len()
    };
    for pose in 0..WARM_UP * POSES {
        ask(pose);
    }
    let before = dispatcher.stats();
    for pose in 0..10 * POSES {
        let mut contact_count = 0;
        let allocated = measure(|| contact_count = ask(pose));
        assert!(contact_count > 0, "the pair must stay in contact");
        assert_eq!(allocated.count_total, 0, "query {pose}: {allocated:?}");
    }
    let after = dispatcher.stats();
    let mut stats = SbbkStats::default();
    stats.queries = after.queries - before.queries;
    stats.reused_queries = after.reused_queries - before.reused_queries;
    stats.descended_queries = after.descended_queries - before.descended_queries;
    stats
}

/// Would catch a counter that counts nothing.
#[test]
fn the_first_query_allocates() {
    let ball = shape(&mesh::ball(1.0, 4));
    let dispatcher = SbbkDispatcher::default();
    let mut pair: Pair = Pair::default();
    let query = Question::new(&ball, &ball, Pose::translation(1.6, 0.0, 0.0));
    assert!(measure(|| _ = pair.ask(&dispatcher, &query)).count_total > 10);
}

/// Would catch manifolds, points or lists made anew for a body at rest, which jitters by
/// micrometres: candidates are kept.
#[test]
fn a_body_at_rest_allocates_nothing() {
    let head = shape(&mesh::monkey_head());
    let stats = steady([&head, &head], 1e-4);
    assert!(stats.reused_queries > 9 * stats.queries / 10, "{stats:?}");
}

/// The same where a descent runs each time, since the body moves by more than half the prediction
/// distance.
#[test]
fn a_moving_body_allocates_nothing() {
    let head = shape(&mesh::monkey_head_with(6));
    let stats = steady([&head, &head], 2.5e-2);
    assert!(stats.descended_queries > stats.queries / 2, "{stats:?}");
}

/// Would catch buffers that are given back and made again where a body shakes so much that tens of
/// contacts come and go from query to query.
#[test]
fn contacts_that_come_and_go_allocate_nothing() {
    let head = shape(&mesh::monkey_head());
    let stats = steady([&head, &head], 3e-2);
    assert!(stats.descended_queries > stats.queries / 2, "{stats:?}");
}

/// Would catch normal constraints that are built or boxed for each pair.
#[test]
fn constrained_normals_allocate_nothing() {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let head = shape_with(&mesh::monkey_head(), flags);
    let floor = shape_with(&mesh::ball(3.0, 10), flags);
    let stats = steady([&floor, &head], 1e-3);
    assert!(stats.reused_queries > stats.queries / 4, "{stats:?}");
}

/// Would catch patches that are divided up in new memory, or whose manifolds are made anew.
#[test]
fn patches_allocate_nothing() {
    let dispatcher = counting_patches();
    for flags in [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES] {
        let head = shape_with(&mesh::monkey_head(), flags);
        for stride in [1e-4, 2.5e-2] {
            steady_with(&dispatcher, [&head, &head], stride);
        }
    }
}
