use crate::prelude::*;

/// Would catch a pair at rest that is worked on: same pose, same prediction distance, nothing to
/// do.
#[test]
fn nothing_is_done_where_nothing_moved() {
    let head = shape(&mesh::monkey_head_with(6));
    let dispatcher = every();
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
        let [dispatcher, unaware] = [(); 2].map(|()| having(contact_set));
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
