use oorandom::Rand32;
use rapier_integration::ContactSet;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use crate::support::{
    Pair, Question, assert_same, counting, counting_of, every, having, nudge, reach, sequence,
    shape, shape_with, touching,
};

/// How far a step may go, in units and radians: far below any slack, about as much, and farther
/// than any.
const STRIDES: [Real; 6] = [0.0, 1e-6, 1e-4, 1e-3, 5e-3, 3e-2];
const PREDICTIONS: [Real; 5] = [0.0, 0.001, 0.01, 0.02, 0.06];

/// A pair of meshes that moves at random: mostly in small steps, as bodies do, and sometimes not.
struct Walk<'a> {
    random: Rand32,
    query: Question<'a>,
    stride: Real,
}

/// What else a step does than to move the pair.
#[derive(PartialEq)]
enum Event {
    None,
    WorkspaceTaken,
}

impl<'a> Walk<'a> {
    fn new(seed: u64, meshes: [&'a TriMesh; 2]) -> Self {
        let mut random = Rand32::new(seed);
        let pos12 = touching(&mut random, meshes, 0.02);
        Self { random, query: Question::new(meshes[0], meshes[1], pos12), stride: STRIDES[2] }
    }

    fn pick(&mut self, from: &[Real]) -> Real {
        from[self.random.rand_range(0..from.len() as u32) as usize]
    }

    fn step(&mut self) -> Event {
        let stride = self.stride;
        match self.random.rand_range(0..200) {
            0..=3 => self.query.pose = touching(&mut self.random, self.query.meshes(), 0.03),
            4..=9 => self.stride = self.pick(&STRIDES),
            10..=15 => self.query.prediction = self.pick(&PREDICTIONS),
            16 => self.query.pose.translation *= 3.0,
            17 => self.query.pose.translation.x = Real::NAN,
            18 => return Event::WorkspaceTaken,
            _ => self.query.pose = nudge(&mut self.random, stride) * self.query.pose,
        }
        // From far away, or nowhere, the next step comes back.
        let limit = self.query.meshes().map(reach).iter().sum::<Real>();
        let is_near = self.query.pose.translation.length() < limit;
        if !is_near && self.random.rand_float() < 0.5 {
            self.query.pose = touching(&mut self.random, self.query.meshes(), 0.01);
        }
        Event::None
    }
}

/// Walks, and compares each answer with that of a dispatcher which knows nothing.
///
/// Would catch candidates kept too long (a missed contact), contacts that are not brought up to
/// date, and anything else that depends on where the pair was before. Proves that candidates were
/// kept.
fn walk(seed: u64, steps: usize, meshes: [&TriMesh; 2]) {
    let kept = counting();
    let unaware = every();
    // Holds the trees of the fresh queries.
    let mut hold: Pair = Pair::default();
    let mut walk = Walk::new(seed, meshes);
    hold.ask(&unaware, &walk.query);
    let mut pair: Pair = Pair::default();
    let mut manifold_count = 0;
    for _ in 0..steps {
        if walk.step() == Event::WorkspaceTaken {
            pair.workspace = None;
        }
        pair.ask(&kept, &walk.query);
        let expected = walk.query.fresh(&unaware);
        assert_same(&pair.manifolds, &expected, 0.0);
        manifold_count += expected.len();
    }
    let stats = kept.stats();
    assert_eq!(stats.queries, steps as u64);
    assert!(stats.internals.reused_queries > stats.queries / 4, "{stats:?}");
    assert!(stats.internals.unchanged_queries > stats.queries / 50, "{stats:?}");
    assert!(stats.descended_queries > stats.queries / 20, "{stats:?}");
    assert!(manifold_count > 5 * steps, "{manifold_count} contacts in all");
    assert_eq!(unaware.stats().queries, 0, "counted without being asked to");
}

#[test]
fn heads_walk() {
    let head = shape(&mesh::monkey_head());
    walk(1, 3000, [&head, &head]);
}

/// Hollow, of very different sizes, in both orders: bounds that hold for one mesh and not for the
/// other.
#[test]
fn a_ring_walks_about_a_ball() {
    let ring = shape(&mesh::torus(3.0, 0.3, 40, 8));
    let ball = shape(&mesh::ball(0.5, 5));
    walk(2, 3000, [&ring, &ball]);
    walk(3, 3000, [&ball, &ring]);
}

/// Meshes far from their own origins: a turn moves them by much more than the angle.
#[test]
fn distant_origins_walk() {
    let away =
        |x: Real| mesh::monkey_head_with(6).mapped(move |v| v + glamx::Vec3::new(x, 0.0, 0.0));
    let [one, two] = [0.0, 0.7].map(|x| shape(&away(x)));
    walk(4, 3000, [&one, &two]);
}

/// Contacts that normal constraints reject are candidates all the same.
#[test]
fn constrained_heads_walk() {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    let [one, two] = [6, 8].map(|detail| shape_with(&mesh::monkey_head_with(detail), flags));
    walk(5, 3000, [&one, &two]);
}

/// Small triangles: the slack is much larger than they are.
#[test]
fn fine_balls_walk() {
    let ball = shape(&mesh::ball(0.3, 16));
    walk(6, 1500, [&ball, &ball]);
}

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

/// What a host does between two queries of a pair.
#[derive(Clone, Copy)]
enum Meddling {
    /// It moves the pair, by far or by little, or asks with another prediction distance.
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

/// Thousands of short sequences, each of another kind: after whatever happened, the answer is that
/// of a dispatcher which knows nothing, bit for bit.
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
