//! A mesh against convex shapes and compounds, stock Parry beside SBBK: times of queries, and wrong
//! contacts by brute force in f64.
//!
//! The mesh approaches a shape of each kind along random directions and is stopped about the first
//! touch and deep in the shape. Queries there are first ones, or in slow and fast motion.

use crate::prelude::*;

use super::PREDICTION;
use super::kinds::{Kind, kinds};
use super::motion::{Approach, Mode, Place};
use super::pair::{self, SIDES};

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct ConvexPlan {
    pub mesh: Mesh,
    /// Approaches to each shape, of five places about the first touch and two deep ones each.
    pub approach_count: usize,
    /// Repeats of each measurement.
    pub repeats: usize,
}

/// Places about the first touch: how far beyond it the mesh is stopped, in prediction distances.
const ADVANCES: [Real; 5] = [-0.95, -0.5, 0.0, 0.5, 2.0];
/// Deep places, as shares of the length of the mesh.
const DEEP: [Real; 2] = [0.05, 0.15];
/// Motion that is faster than prediction distances allow for.
const FASTEST: Mode = Mode::Steady(3.0);
/// Queries of a motion for one that is judged.
const JUDGED: usize = 4;
const MODES: [Mode; 4] = [Mode::Fresh, Mode::SLOW, Mode::FAST, FASTEST];

const SHAPES: &str = "convex: queries, µs";
const COMPOUNDS: &str = "compounds: queries, µs";

impl ConvexPlan {
    /// The head of 968 triangles, two units across, at Rapier's prediction distance; two minutes.
    pub fn standard() -> Self {
        Self { mesh: mesh::monkey_head(), approach_count: 3, repeats: 9 }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { approach_count: 1, repeats: 3, ..Self::standard() }
    }
}

/// Measures every kind of shape.
pub fn convex(plan: &ConvexPlan, progress: &Progress) -> Results {
    let kinds = kinds(1.0);
    progress.phase("convex shapes and compounds", kinds.len());
    let rows = (0..).zip(&kinds).flat_map(|(seed, kind)| {
        progress.step();
        measure(plan, kind, seed)
    });
    Results::new("convex", rows.collect())
}

fn measure(plan: &ConvexPlan, kind: &Kind, seed: u64) -> Vec<Row> {
    let mesh = plan.mesh.shape();
    let sides = SIDES.map(|backend| backend.per_triangle([&mesh]));
    let length = plan.mesh.bounds().extents().max_element();
    let about = ADVANCES.map(|advance| advance * PREDICTION);
    let deep = DEEP.map(|share| share * length);
    let mut random = Rand32::new(seed);
    let approaches: Vec<_> =
        (0..plan.approach_count).map(|_| approach(&sides[1], &mesh, kind, &mut random)).collect();
    let study = if kind.shape.as_compound().is_some() { COMPOUNDS } else { SHAPES };
    let mut rows: Vec<Row> = Vec::new();
    for (depth, advances) in [("touching", &about[..]), ("deep", &deep)] {
        let places: Vec<Place> = advances
            .iter()
            .flat_map(|&advance| approaches.iter().map(move |way| way.place(advance)))
            .collect();
        for mode in MODES {
            let sequences = sequences([&kind.shape, &mesh], &places, mode);
            let errors = Sequence::errors(&sequences, &sides, |step| step.is_multiple_of(JUDGED));
            let row = Row::new(study, "").key("shape", kind.name).key("depth", depth);
            let row = row.key("mode", mode);
            rows.extend(pair::rows(&sides, &row, plan.repeats, &sequences, &errors));
        }
    }
    rows
}

fn approach(
    dispatcher: &SharedDispatcher,
    mesh: &SharedShape,
    kind: &Kind,
    random: &mut Rand32,
) -> Approach {
    let shapes = [&kind.shape, mesh];
    let Some(turn) = kind.floor else {
        return Approach::random(dispatcher, shapes, random);
    };
    let rotation = turn(random);
    let [x, z] = [(); 2].map(|()| 20.0 * random.rand_float() - 10.0);
    Approach::along(Vec3::Y, rotation, Vec3::new(x, 0.0, z), dispatcher, shapes)
        .expect("a way from above to a floor touches it")
}

/// Queries at some places, every other time with the mesh first.
fn sequences(shapes: [&SharedShape; 2], places: &[Place], mode: Mode) -> Vec<Sequence> {
    let sequence = |(index, place): (usize, &Place)| {
        let mut sequence = mode.sequence(shapes, place, PREDICTION);
        if index.is_multiple_of(2) {
            sequence.shapes.reverse();
            sequence.poses.iter_mut().for_each(|pose| *pose = pose.inverse());
        }
        sequence
    };
    places.iter().enumerate().map(sequence).collect()
}
