//! The same true pairs of triangles through both contact generators.

use std::hint::black_box;
use std::time::{Duration, Instant};

use glamx::{DPose3, Pose3};
use rapier3d::math::Real;
use rapier3d::parry::shape::Triangle;
use rayon::prelude::*;
use sbbk_core::truth::{self, TruthPair};
use serde::Serialize;

use super::super::Progress;
use super::case::PosedCase;
use super::contest::{Contest, Memory, race};
use super::errors::ContactErrors;
use super::generator::{Generator, Parrys, Sbbks};
use super::motion::{FAST, SLOW, STEP_COUNT};
use super::plan::SHORT_REPEATS;
use super::side::{Measured, Side};
use super::speed::motions;
use crate::metrics::sample_indices;

/// Contact pairs of one mesh through both generators.
#[derive(Clone, Debug, Serialize)]
pub struct GeneratorRow {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// Pairs of triangles, fresh and in slow motion.
    pub slow_pairs: usize,
    /// Those of them that touch or cross in the middle of the motion.
    pub slow_crossing: usize,
    /// Pairs of triangles in faster motion.
    pub fast_pairs: usize,
    /// Those of them that touch or cross in the middle of the motion.
    pub fast_crossing: usize,
    /// Parry's generator and SBBK's; times are nanoseconds a pair. Fresh: a new manifold for each pair, allocated and
    /// freed; else it is kept.
    pub sides: [Side<ContactErrors>; 2],
}

/// At most this many pairs of each motion: enough for a mean, and the truth of each is worked out
/// at every step.
const PAIR_LIMIT: usize = 100;
/// Pairs nearer to the prediction distance than this share of it are left out: rounding decides
/// whether they are in contact.
const BAND: f64 = 0.01;

/// Pairs of triangles that are within the prediction distance at all of some poses.
struct Moving {
    poses: Vec<Pose3>,
    pairs: Vec<[Triangle; 2]>,
    prediction: Real,
}

/// Asks a generator about all pairs; the time of the queries that count.
type Sweep = fn(&[Moving]) -> Duration;

/// Measures the contacts of one case.
pub(super) fn generators(
    posed: &PosedCase,
    contest: &Contest,
    progress: &Progress,
) -> GeneratorRow {
    let [slow, fast] = [SLOW, FAST].map(|share| moving(posed, contest, share));
    progress.step();
    let middle: Vec<Moving> = slow.iter().map(Moving::at_middle).collect();
    let fresh: [Sweep; 2] = [fresh_sweep::<Parrys>, fresh_sweep::<Sbbks>];
    let steady: [Sweep; 2] = [steady_sweep::<Parrys>, steady_sweep::<Sbbks>];
    let measured = [
        measure(fresh, &middle, 1),
        measure(steady, &slow, STEP_COUNT),
        measure(steady, &fast, STEP_COUNT),
    ];
    progress.step();
    GeneratorRow {
        mesh: posed.case.mesh.clone(),
        triangle_count: posed.case.triangle_count,
        slow_pairs: pair_count(&slow),
        slow_crossing: slow.iter().map(Moving::crossing_count).sum(),
        fast_pairs: pair_count(&fast),
        fast_crossing: fast.iter().map(Moving::crossing_count).sum(),
        sides: Side::both(measured),
    }
}

/// Times and errors of both generators; each sweep asks about each pair `queries` times.
fn measure(sweeps: [Sweep; 2], all: &[Moving], queries: usize) -> [Measured<ContactErrors>; 2] {
    let count = queries * pair_count(all);
    let times = race(&sweeps, SHORT_REPEATS, 1e9 / count as f64, |sweep| sweep(all));
    Measured::both(times, [judge::<Parrys>(all), judge::<Sbbks>(all)])
}

fn pair_count(all: &[Moving]) -> usize {
    all.iter().map(|moving| moving.pairs.len()).sum()
}

/// The contacts of both meshes in the middle of each motion that last throughout it.
fn moving(posed: &PosedCase, contest: &Contest, share: Real) -> Vec<Moving> {
    let PosedCase { case, shape, .. } = posed;
    let mesh = shape.as_trimesh().expect("cases are about meshes");
    let contacts = motions(posed, share).into_par_iter().with_max_len(1).map(|poses| {
        let mut memory = Memory::default();
        memory.ask(contest.sbbk(), shape, &poses[STEP_COUNT / 2], case.prediction);
        let is_lasting = |pair: &[Triangle; 2]| {
            let within = (1.0 - BAND) * f64::from(case.prediction);
            poses.iter().all(|pose| truth(pair, pose).distance <= within)
        };
        let manifolds = &memory.manifolds;
        let sampled = sample_indices(manifolds.len(), PAIR_LIMIT).into_iter();
        let indices = sampled.map(|i| [manifolds[i].subshape1, manifolds[i].subshape2]);
        let pairs = indices.map(|pair| pair.map(|triangle| mesh.triangle(triangle)));
        Moving { pairs: pairs.filter(is_lasting).collect(), poses, prediction: case.prediction }
    });
    contacts.collect()
}

impl Moving {
    /// The same pairs at the pose in the middle only.
    fn at_middle(&self) -> Self {
        Self { poses: vec![self.middle()], pairs: self.pairs.clone(), ..*self }
    }

    fn middle(&self) -> Pose3 {
        self.poses[self.poses.len() / 2]
    }

    fn crossing_count(&self) -> usize {
        self.pairs.iter().filter(|pair| truth(pair, &self.middle()).distance <= 0.0).count()
    }
}

fn truth(pair: &[Triangle; 2], pos12: &Pose3) -> TruthPair {
    let pose = DPose3::from(*pos12);
    let [corners1, corners2] =
        pair.map(|triangle| [triangle.a, triangle.b, triangle.c].map(|corner| corner.as_dvec3()));
    let contact = truth::contact(&corners1, &corners2.map(|corner| pose * corner));
    TruthPair {
        triangle1: 0,
        triangle2: 0,
        distance: contact.distance,
        normal: contact.normal,
        normal_is_unique: contact.normal_is_unique,
    }
}

/// A new generator for each pair, at the first pose.
fn fresh_sweep<G: Generator>(all: &[Moving]) -> Duration {
    let start = Instant::now();
    for Moving { poses, pairs, prediction } in all {
        for pair in pairs {
            let mut generator = G::default();
            generator.update(&poses[0], pair, *prediction);
            black_box(generator.manifold());
        }
    }
    start.elapsed()
}

/// A generator for each pair that goes through all poses; the first one is not timed.
fn steady_sweep<G: Generator>(all: &[Moving]) -> Duration {
    let mut time = Duration::ZERO;
    for Moving { poses, pairs, prediction } in all {
        let mut generators: Vec<G> = pairs.iter().map(|_| G::default()).collect();
        let mut update_all = |pose: &Pose3| {
            for (generator, pair) in generators.iter_mut().zip(pairs) {
                generator.update(pose, pair, *prediction);
                black_box(generator.manifold());
            }
        };
        update_all(&poses[0]);
        let start = Instant::now();
        poses[1..].iter().for_each(update_all);
        time += start.elapsed();
    }
    time
}

/// Errors at the last pose, each pair having gone through those before.
fn judge<G: Generator>(all: &[Moving]) -> ContactErrors {
    let pairs = all.iter().flat_map(|moving| moving.pairs.iter().map(move |pair| (moving, pair)));
    let errors = pairs.map(|(Moving { poses, prediction, .. }, pair)| {
        let mut generator = G::default();
        poses.iter().for_each(|pose| generator.update(pose, pair, *prediction));
        let truth = truth(pair, &poses[poses.len() - 1]);
        ContactErrors::of_pair(&truth, generator.manifold(), *prediction)
    });
    errors.sum()
}
