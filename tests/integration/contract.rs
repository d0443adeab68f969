use crate::prelude::*;
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::parry::query::ContactManifold;
use std::collections::HashSet;
use std::sync::Arc;

/// Marks of manifolds and points tell which of them survive.
type MarkedPair = Pair<u32, u32>;
type MarkedManifold = ContactManifold<u32, u32>;

impl MarkedPair {
    /// Gives each manifold and each point another mark; mark 0 is left for new ones. Returns the
    /// marked manifolds.
    fn mark(&mut self) -> Vec<MarkedManifold> {
        let mut next = 1..;
        for manifold in &mut self.manifolds {
            manifold.data = next.next().unwrap();
            manifold.points.iter_mut().for_each(|point| point.data = next.next().unwrap());
        }
        self.manifolds.clone()
    }

    /// Panics unless manifolds have their marks by their triangles, and points by their features.
    /// Returns the number of known and of new points.
    fn check_marks(&self, before: &[MarkedManifold]) -> [usize; 2] {
        let fids = |point: &TrackedContact<u32>| [point.fid1, point.fid2];
        let (before, mut counts) = (by_triangles(before), [0; 2]);
        for manifold in &self.manifolds {
            let old = before.get(&triangles(manifold));
            assert_eq!(manifold.data, old.map_or(0, |old| old.data));
            for point in &manifold.points {
                let known = old.and_then(|old| old.points.iter().find(|p| fids(p) == fids(point)));
                assert_eq!(point.data, known.map_or(0, |point| point.data));
                counts[usize::from(known.is_none())] += 1;
            }
        }
        counts
    }
}

/// Meshes whose triangles are large against Parry's tolerances, the first with the smaller box:
/// about their origins, 2.6 and 4 units across, triangles of about 0.5 units.
fn rings() -> [TriMesh; 2] {
    [shape(&mesh::torus(1.0, 0.3, 12, 6)), shape(&mesh::torus(1.4, 0.6, 16, 9))]
}

/// Would catch a pair with manifolds and no workspace: Rapier would keep pointers to manifolds that
/// are gone.
#[test]
fn there_is_a_workspace_wherever_there_are_or_were_manifolds() {
    let [one, two] = rings();
    let query = Question::new(&one, &two, touching(&mut Rand32::new(1), [&one, &two], 0.05));
    let [far, nowhere] = [100.0, Real::NAN].map(|x| Pose::translation(x, 0.0, 0.0));
    for first in [far, nowhere, query.pose] {
        let mut pair: Pair = Pair::default();
        for pos12 in [first, far, query.pose, query.pose, nowhere, far] {
            let had_some = !pair.manifolds.is_empty();
            pair.ask(&SbbkDispatcher::default(), &query.at(pos12));
            assert_eq!(pair.manifolds.is_empty(), pos12 != query.pose);
            assert!(pair.workspace.is_some() || !had_some && pair.manifolds.is_empty());
            if !pair.manifolds.is_empty() {
                // Rapier does this if a shape was edited.
                pair.workspace = None;
                pair.ask(&SbbkDispatcher::default(), &query.at(far));
                assert!(pair.workspace.is_some() && pair.manifolds.is_empty());
            }
        }
    }
}

/// Would catch an order that depends on earlier queries, and empty manifolds.
#[test]
fn manifolds_come_in_the_order_of_subshapes_and_none_is_empty() {
    let [one, two] = rings();
    let mut random = Rand32::new(2);
    let dispatcher = per_triangle();
    let mut manifold_count = 0;
    for _ in 0..30 {
        let query = Question::new(&one, &two, touching(&mut random, [&one, &two], 0.1));
        for query in [query, query.flipped(true)] {
            let mut pair: Pair = Pair::default();
            for _ in 0..3 {
                let query = query.at(nudge(&mut random, 0.005) * query.pose);
                let found = &pair.ask(&dispatcher, &query).manifolds;
                assert!(found.iter().all(|manifold| !manifold.points.is_empty()));
                let touching = by_triangles(found).into_keys();
                assert_eq!(sequence(found), touching.collect::<Vec<_>>());
                manifold_count += found.len();
            }
        }
    }
    assert!(manifold_count > 1000, "{manifold_count}");
}

/// Would catch impulses lost when a dispatcher takes over a running world or a restored snapshot.
#[test]
fn with_a_foreign_workspace_manifolds_keep_their_data() {
    let [one, two] = rings();
    let query = Question::new(&one, &two, touching(&mut Rand32::new(5), [&one, &two], 0.1));
    let mut pair = MarkedPair::default();
    let before = pair.ask(&DefaultQueryDispatcher, &query).mark();
    pair.ask(&every(), &query);
    assert_same(&pair.manifolds, &query.fresh(&every()), 0.0);
    let [kept, _] = pair.check_marks(&before);
    assert!(kept > 0, "no point has the feature ids that stock gives");
    assert!(pair.manifolds.iter().all(|manifold| manifold.data != 0), "stock has it");
}

/// Would catch impulses lost or given to another point while bodies move.
#[test]
fn points_keep_their_data_by_their_features() {
    let [one, two] = rings();
    let mut random = Rand32::new(6);
    let dispatcher = every();
    let mut query = Question::new(&one, &two, touching(&mut random, [&one, &two], 0.05));
    let mut pair = MarkedPair::default();
    pair.ask(&dispatcher, &query);
    let [mut kept, mut new] = [0, 0];
    for _ in 0..300 {
        let before = pair.mark();
        query.pose = nudge(&mut random, 0.003) * query.pose;
        let counts = pair.ask(&dispatcher, &query).check_marks(&before);
        [kept, new] = [kept + counts[0], new + counts[1]];
        for manifold in &pair.manifolds {
            let distinct: HashSet<_> =
                manifold.points.iter().map(|p| [p.fid1.0, p.fid2.0]).collect();
            assert_eq!(distinct.len(), manifold.points.len(), "two points of the same features");
        }
    }
    assert!(kept > 20 * new && new > 10, "{kept} points kept, {new} new");
}

/// Would catch a dispatcher that serves Rapier's types only.
#[test]
fn manifolds_may_have_any_data() {
    #[derive(Clone, Default)]
    struct Name(String);
    let [one, two] = rings();
    let query = Question::new(&one, &two, touching(&mut Rand32::new(9), [&one, &two], 0.05));
    let dispatcher = SbbkDispatcher::default();
    let expected: Vec<Manifold> = query.fresh(&dispatcher);
    let mut named = Pair::<Name, f64>::default();
    named.ask(&dispatcher, &query).manifolds[0].data = Name("first".into());
    named.ask(&dispatcher, &query.at(Pose::translation(1e-6, 0.0, 0.0) * query.pose));
    assert_eq!(named.manifolds[0].data.0, "first");
    named.ask(&dispatcher, &query);
    assert_same(&named.manifolds, &expected, 1e-6);

    // Rapier holds its dispatcher like this.
    let shared: Arc<dyn PersistentQueryDispatcher<ContactManifoldData, ContactData>> =
        Arc::new(dispatcher);
    let (mut manifolds, mut workspace) = (Vec::new(), None);
    shared
        .contact_manifolds(&query.pose, &one, &two, 0.02, &mut manifolds, &mut workspace)
        .unwrap();
    assert_same(&manifolds, &expected, 0.0);
}
