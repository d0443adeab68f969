use std::collections::BTreeMap;

use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_lab::mesh;

use crate::support::{Dispatcher, Manifold, Pair, Query, assert_same, fresh, shape, shape_with};

/// A ball with one vertex that is not a number.
fn broken_ball() -> TriMesh {
    let mut ball = mesh::ball(1.0, 4);
    let lowest = (0..ball.vertex_count())
        .min_by(|&i, &j| ball.vertices[i].y.total_cmp(&ball.vertices[j].y))
        .unwrap();
    ball.vertices[lowest].x = Real::NAN;
    shape(&ball)
}

/// A ball above another: the lowest vertex of the lower one is out of the way.
fn above(height: Real) -> Pose {
    Pose::translation(0.1, height, 0.05)
}

/// Would catch a panic, silence, or an answer that is not stock's where a mesh cannot have a tree.
#[test]
fn a_mesh_that_is_not_finite_is_answered_by_stock_and_counted() {
    let dispatcher = SbbkDispatcher::default();
    let (broken, whole) = (broken_ball(), shape(&mesh::ball(1.0, 4)));
    let reason = dispatcher.prepare(&broken).unwrap_err().to_string();
    assert!(reason.contains("is not finite") && reason.contains("NaN"), "{reason}");
    assert!(dispatcher.prepare(&whole).is_ok());
    assert_eq!(dispatcher.stats().unsupported_queries, 0);
    let query = Query::new(&broken, &whole, above(1.9));
    for (count, query) in [query, query.swapped()].iter().enumerate() {
        let expected: Vec<Manifold> = fresh(&DefaultQueryDispatcher, query);
        assert!(expected.iter().any(|manifold| !manifold.points.is_empty()));
        assert_same(&fresh(&dispatcher, query), &expected, 0.0);
        assert_eq!(dispatcher.stats().unsupported_queries, 1 + count as u64);
    }
    assert_eq!(dispatcher.stats().trees, usize::from(dispatcher.stats().idle_trees > 0));
}

/// What a host stores with each contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Impulse(u32);

/// Asks about a ball that sinks slowly, where each contact point counts the queries it has lived
/// through: for each query how many points have which age.
fn ages(
    dispatcher: &impl Dispatcher<(), Impulse>,
    meshes: [&TriMesh; 2],
) -> Vec<BTreeMap<u32, usize>> {
    let mut pair = Pair::<(), Impulse>::default();
    let ages = |step: u16| {
        let height = 1.9 - 1e-4 * Real::from(step);
        pair.ask(dispatcher, &Query::new(meshes[0], meshes[1], above(height)));
        let mut ages = BTreeMap::new();
        for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
            point.data.0 += 1;
            *ages.entry(point.data.0).or_default() += 1;
        }
        ages
    };
    (0..5).map(ages).collect()
}

/// Would catch contacts of such a mesh that lose their impulses in every step, so that bodies on it
/// jitter or sink where they rest under stock Rapier.
#[test]
fn contacts_answered_by_stock_keep_their_data() {
    let (broken, whole) = (broken_ball(), shape(&mesh::ball(1.0, 4)));
    let expected = ages(&DefaultQueryDispatcher, [&broken, &whole]);
    assert!(expected[4][&5] > 0);
    assert_eq!(ages(&SbbkDispatcher::default(), [&broken, &whole]), expected);
}

/// Would catch a state that a mesh which became rigid, or whole, cannot leave.
#[test]
fn a_pair_changes_hands() {
    let dispatcher = SbbkDispatcher::default();
    let (broken, whole) = (broken_ball(), shape(&mesh::ball(1.0, 4)));
    let soft = shape_with(&mesh::ball(1.0, 4), TriMeshFlags::DEFORMABLE);
    let mut pair: Pair = Pair::default();
    // A host that changes a shape and keeps the workspace is right only where SBBK answers before
    // or after: between two meshes that are Parry's, Parry itself would reuse its points.
    for mesh in [&whole, &broken, &whole, &soft, &whole, &broken, &whole, &soft, &whole] {
        let query = Query::new(mesh, &whole, above(1.9));
        pair.ask(&dispatcher, &query);
        assert_same(&pair.manifolds, &fresh(&dispatcher, &query), 1e-5);
    }
    assert_eq!(dispatcher.stats().unsupported_queries, 4);
}
