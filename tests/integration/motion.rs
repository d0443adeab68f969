use oorandom::Rand32;
use rapier_integration::ContactSet;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::TriMesh;
use sbbk_testkit::mesh;

use crate::support::{
    Pair, Question, assert_same, counting, counting_of, every, having, nudge, sequence, shape,
    touching,
};

/// Lengths of a step in units and radians, from far below any slack to beyond it.
const STRIDES: [Real; 6] = [0.0, 1e-6, 1e-4, 1e-3, 5e-3, 3e-2];
const PREDICTIONS: [Real; 5] = [0.0, 0.001, 0.01, 0.02, 0.06];

/// Would catch a pair at rest that is worked on: same pose, same prediction distance, nothing to
/// do.
#[test]
fn nothing_is_done_where_nothing_moved() {
    let head = shape(&mesh::monkey_head_with(6));
    let dispatcher = counting();
    let mut pair: Pair = Pair::default();
    let query = Question::new(&head, &head, touching(&mut Rand32::new(8), [&head, &head], 0.02));
    for _ in 0..10 {
        pair.ask(&dispatcher, &query);
    }
    let stats = dispatcher.stats();
    assert_eq!(
        [stats.queries, stats.internals.unchanged_queries, stats.descended_queries],
        [10, 9, 1]
    );
    assert_same(&pair.manifolds, &query.fresh(&dispatcher), 0.0);
    // The host may have touched the manifolds.
    pair.manifolds.remove(0);
    pair.ask(&dispatcher, &query);
    assert_same(&pair.manifolds, &query.fresh(&dispatcher), 0.0);
}

/// Would catch slack that is used up and not noticed: a long way in equal steps, each far shorter
/// than the slack.
#[test]
fn many_short_steps_are_a_long_way() {
    let head = shape(&mesh::monkey_head());
    let start = touching(&mut Rand32::new(9), [&head, &head], 0.0);
    let towards = -start.translation.normalize();
    for (contact_set, least_sets) in [(ContactSet::Surfaces, 20), (ContactSet::Triangles, 100)] {
        let (dispatcher, unaware) = (counting_of(contact_set), having(contact_set));
        let mut pair: Pair = Pair::default();
        let mut sets = Vec::new();
        for step in 0..600 {
            let shift = Pose::from_translation(towards * (2e-4 * step as Real));
            let query = Question::new(&head, &head, shift * start);
            pair.ask(&dispatcher, &query);
            let expected = query.fresh(&unaware);
            assert_same(&pair.manifolds, &expected, 0.0);
            sets.push(sequence(&expected));
        }
        sets.dedup();
        assert!(sets.len() > least_sets, "{} different {contact_set:?}", sets.len());
        let stats = dispatcher.stats();
        assert!(stats.internals.reused_queries > 400 && stats.descended_queries > 10, "{stats:?}");
    }
}

/// Action of a host between two queries of a pair.
#[derive(Clone, Copy)]
enum Meddling {
    /// Moves the pair, or changes the prediction distance.
    Moves,
    /// For one query another dispatcher is installed: stock, or an SBBK that knows no tree.
    AsksStock,
    AsksAnother,
    /// A vertex of the second mesh is moved, and the workspace dropped, as Rapier does.
    Edits,
    /// The workspace is dropped for another reason.
    TakesWorkspace,
}

const MEDDLING: [Meddling; 4] =
    [Meddling::AsksStock, Meddling::AsksAnother, Meddling::Edits, Meddling::TakesWorkspace];

/// Would catch anything that outlives the event that should have ended it.
///
/// Would catch anything that outlives the event that should have ended it.
#[test]
fn thousands_of_histories_end_alike() {
    let ring = shape(&mesh::torus(1.0, 0.4, 12, 8));
    let ball = shape(&mesh::ball(0.5, 3));
    let (kept, another) = (counting(), every());
    let unaware = every();
    let mut manifold_count = 0;
    for seed in 0..2500 {
        let mut random = Rand32::new(seed);
        let mut edited = ball.clone();
        let mut pos12 = touching(&mut random, [&ring, &ball], 0.02);
        let mut prediction = 0.02;
        let mut pair: Pair = Pair::default();
        for _ in 0..12 {
            let meddling = match random.rand_range(0..8) {
                0 => MEDDLING[random.rand_range(0..4) as usize],
                _ => Meddling::Moves,
            };
            if let Meddling::Edits = meddling {
                let mut vertices = edited.vertices().to_vec();
                let vertex = random.rand_range(0..vertices.len() as u32) as usize;
                vertices[vertex] *= 1.0 + 0.1 * random.rand_float();
                edited = TriMesh::new(vertices, edited.indices().to_vec()).unwrap();
                pair.workspace = None;
            }
            let query = Question::new(&ring, &edited, pos12).within(prediction);
            match meddling {
                Meddling::AsksStock => _ = pair.ask(&DefaultQueryDispatcher, &query),
                Meddling::AsksAnother => _ = pair.ask(&another, &query),
                Meddling::TakesWorkspace => pair.workspace = None,
                Meddling::Moves | Meddling::Edits => {}
            }
            pair.ask(&kept, &query);
            let expected = query.fresh(&unaware);
            assert_same(&pair.manifolds, &expected, 0.0);
            manifold_count += expected.len();
            match random.rand_range(0..10) {
                0 => pos12 = touching(&mut random, [&ring, &ball], 0.03),
                1 => prediction = PREDICTIONS[random.rand_range(0..5) as usize],
                _ => {
                    let stride = STRIDES[random.rand_range(0..6) as usize];
                    pos12 = nudge(&mut random, stride) * pos12;
                }
            }
        }
    }
    let stats = kept.stats();
    assert!(
        stats.internals.reused_queries > 3000 && stats.internals.unchanged_queries > 1000,
        "{stats:?}"
    );
    assert!(manifold_count > 100_000, "{manifold_count} contacts in all");
}
