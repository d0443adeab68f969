use super::{anew, assert_same_set, furniture};
use crate::heightfield::terrain::Terrain;
use crate::prelude::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;

/// Event of a pair between two queries.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// Nothing.
    Rest,
    /// All vertices move by up to this in any direction from where they were made.
    Noise(Real),
    /// All vertices go to a lattice of this spacing.
    Snap(Real),
    /// The mesh moves by up to this.
    Move(Real),
    /// Both.
    NoiseAndMove(Real, Real),
    /// The host loses the state of the pair.
    Lose,
    /// Another dispatcher answers in between.
    Stock,
    /// The host copies the mesh, as it must to edit a shared one.
    Copy,
}

fn event() -> impl Strategy<Value = Event> {
    let noise = prop_oneof![Just(1e-6), Just(1e-3), Just(0.03), Just(0.3)];
    let shift = prop_oneof![Just(1e-5), Just(1e-3), Just(0.05)];
    prop_oneof![
        1 => Just(Event::Rest),
        4 => noise.clone().prop_map(Event::Noise),
        1 => prop_oneof![Just(0.25), Just(0.125)].prop_map(Event::Snap),
        2 => shift.clone().prop_map(Event::Move),
        2 => (noise, shift).prop_map(|(noise, shift)| Event::NoiseAndMove(noise, shift)),
        1 => Just(Event::Lose),
        1 => Just(Event::Stock),
        1 => Just(Event::Copy),
    ]
}

/// A pair and what becomes of it.
#[derive(Clone, Debug)]
struct History {
    seed: u64,
    flags: TriMeshFlags,
    flipped: bool,
    is_lattice: bool,
    events: Vec<Event>,
}

fn history() -> impl Strategy<Value = History> {
    let flags = prop_oneof![
        Just(TriMeshFlags::empty()),
        Just(TriMeshFlags::FIX_INTERNAL_EDGES),
        Just(TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED),
    ];
    let events = prop::collection::vec(event(), 12);
    (any::<u64>(), flags, any::<[bool; 2]>(), events).prop_map(|(seed, flags, bools, events)| {
        let [flipped, is_lattice] = bools;
        History { seed, flags, flipped, is_lattice, events }
    })
}

/// A mesh under way through a history.
struct Walk {
    random: Rand32,
    mesh: TriMesh,
    rest: Vec<Vec3>,
    pose: Pose,
}

impl Walk {
    fn new(history: &History) -> Self {
        let mut random = Rand32::new(history.seed);
        let solids = [mesh::ball(0.6, 4), mesh::torus(0.5, 0.2, 10, 6), mesh::monkey_head_with(5)];
        let solid = solids[random.rand_range(0..3) as usize].clone();
        let solid = solid.centred().scaled_to(1.2);
        let mesh = solid.trimesh(history.flags | TriMeshFlags::DEFORMABLE);
        let turn = if history.is_lattice { Quat::IDENTITY } else { rotation(&mut random) };
        let rest = mesh.vertices().to_vec();
        Self { random, mesh, rest, pose: Pose::from_parts(Vec3::Y * 0.5, turn) }
    }

    fn shift(&mut self, size: Real) -> Vec3 {
        size * Vec3::from_array([(); 3].map(|()| 2.0 * self.random.rand_float() - 1.0))
    }

    fn move_by(&mut self, size: Real) {
        let shift = self.shift(size);
        self.pose.translation += shift;
    }

    fn add_noise(&mut self, size: Real) {
        let moved: Vec<Vec3> =
            (0..self.rest.len()).map(|i| self.rest[i] + self.shift(size)).collect();
        self.mesh.set_vertices(&moved);
    }

    /// Does what concerns the mesh and its pose.
    fn take(&mut self, event: Event) {
        match event {
            Event::Rest | Event::Lose | Event::Stock => {}
            // A mesh built anew with fixed edges would merge the vertices that meet.
            Event::Snap(size) if self.mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES) => {
                self.add_noise(size);
            }
            Event::Snap(size) => {
                let to_lattice = |&vertex: &Vec3| (vertex / size).round() * size;
                let moved: Vec<Vec3> = self.rest.iter().map(to_lattice).collect();
                self.mesh.set_vertices(&moved);
            }
            Event::Noise(size) => self.add_noise(size),
            Event::Move(size) => self.move_by(size),
            Event::NoiseAndMove(noise, shift) => {
                self.add_noise(noise);
                self.move_by(shift);
            }
            Event::Copy => self.mesh = self.mesh.clone(),
        }
    }
}

/// Runs a history and returns the number of contacts. Panics unless a new dispatcher gives the same
/// bits in the same order, and a rigid mesh built anew in any order.
fn run(history: &History, other: &dyn Shape) -> usize {
    let (dispatcher, mut contacts) = (every(), 0);
    let mut walk = Walk::new(history);
    let mut pair: Pair = Pair::default();
    for &event in &history.events {
        walk.take(event);
        let Walk { mesh, pose, .. } = &walk;
        let question = Question::new(other, mesh, *pose).flipped(history.flipped);
        match event {
            Event::Lose => pair.workspace = None,
            Event::Stock => _ = pair.ask(&DefaultQueryDispatcher, &question),
            _ => {}
        }
        let found = &pair.ask(&dispatcher, &question).manifolds;
        assert_same(found, &question.fresh(&SbbkDispatcher::default()), 0.0);
        assert_same_set(found, &anew(&question));
        contacts += found.len();
    }
    let stats = dispatcher.stats();
    assert_eq!((stats.unsupported_queries, stats.trees), (0, 0), "{stats:?}");
    assert_eq!(stats.internals.reused_queries + stats.internals.unchanged_queries, 0, "{stats:?}");
    contacts
}

/// A shape of each kind of pair.
fn others(history: &History) -> [SharedShape; 8] {
    let random = &mut Rand32::new(history.seed);
    let terrain = if history.is_lattice {
        Terrain::lattice(random)
    } else {
        Terrain::random(random, [16, 14], Vec3::new(4.0, 0.5, 4.0))
    };
    [
        SharedShape::new(terrain.field),
        SharedShape::new(furniture(SharedShape::cuboid(0.5, 0.1, 0.1))),
        mesh::torus(1.0, 0.4, 24, 12).shape(),
        SharedShape::ball(0.5),
        SharedShape::cuboid(3.0, 0.2, 3.0),
        SharedShape::capsule_y(0.5, 0.3),
        SharedShape::cylinder(0.5, 0.4),
        SharedShape::halfspace(Vec3::Y),
    ]
}

/// Would catch lost or invented contacts, and candidates, features or cones of earlier vertices.
#[test]
fn contacts_are_those_of_a_rigid_mesh_built_anew_after_any_history() {
    for kind in 0..8 {
        let contacts = Cell::new(0);
        let case = |history: History| {
            contacts.set(contacts.get() + run(&history, &*others(&history)[kind]));
            Ok(())
        };
        let config = Config { failure_persistence: None, ..Config::with_cases(150) };
        TestRunner::new(config).run(&history(), case).unwrap();
        assert!(contacts.get() >= 10_000, "only {} contacts with shape {kind}", contacts.get());
    }
}
