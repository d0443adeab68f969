//! The same true pairs of triangles through both contact generators.

use std::hint::black_box;
use std::time::Duration;

use glamx::{DPose3, Pose3};
use rapier_integration::TriangleContacts;
use rapier3d::geometry::{ContactData, ContactManifold};
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::Triangle;
use rayon::prelude::*;
use sbbk_core::truth::{self, TruthPair};

use super::{Case, MOTION_LIMIT, PAIRS, SHORT_REPEATS};
use crate::backend::Memory;
use crate::metrics::{ContactErrors, Sequence, Truth, sample_indices};
use crate::report::Row;
use crate::study::motion::{Mode, STEP_COUNT};
use crate::study::pair::Contest;
use crate::study::turns::{race, timed};

/// At most this many pairs of each motion: enough for a mean, and the truth of each is worked out
/// at every step.
const PAIR_LIMIT: usize = 100;
/// Pairs nearer to the prediction distance than this share of it are left out: rounding decides
/// whether they are in contact.
const BAND: f64 = 0.01;

/// Brings the manifold of a pair of triangles up to date.
trait Generator: Default {
    fn update(&mut self, pos12: &Pose3, pair: &[Triangle; 2], prediction: Real)
    -> &ContactManifold;
}

/// The call that stock Parry makes for each pair of triangles.
#[derive(Default)]
struct Parrys(ContactManifold);

/// SBBK's, with its features kept as the dispatcher keeps them.
#[derive(Default)]
struct Sbbks(TriangleContacts<ContactData>, ContactManifold);

impl Generator for Parrys {
    fn update(
        &mut self,
        pos12: &Pose3,
        pair: &[Triangle; 2],
        prediction: Real,
    ) -> &ContactManifold {
        let [one, two] = pair;
        DefaultQueryDispatcher
            .contact_manifold_convex_convex(pos12, one, two, None, None, prediction, &mut self.0)
            .expect("Parry answers for two triangles");
        &self.0
    }
}

impl Generator for Sbbks {
    fn update(
        &mut self,
        pos12: &Pose3,
        pair: &[Triangle; 2],
        prediction: Real,
    ) -> &ContactManifold {
        let Self(contacts, manifold) = self;
        contacts.update(pos12, pair.each_ref(), [None; 2], prediction, manifold);
        manifold
    }
}

/// Pairs of triangles that are within the prediction distance at all of some poses.
struct Moving {
    poses: Vec<Pose3>,
    pairs: Vec<[Triangle; 2]>,
    prediction: Real,
}

/// One of both generators.
struct Side {
    sweep: fn(&[Moving]) -> Duration,
    judge: fn(&[Moving]) -> ContactErrors,
}

/// Times and errors of both, in each mode.
pub(super) fn generators(case: &Case, contest: &Contest) -> Vec<Row> {
    let sides = [
        Side { sweep: sweep::<Parrys>, judge: judge::<Parrys> },
        Side { sweep: sweep::<Sbbks>, judge: judge::<Sbbks> },
    ];
    let rows = Mode::ALL.into_iter().flat_map(|mode| {
        let all = match mode {
            // The pairs of slow motion, in its middle.
            Mode::Fresh => {
                moving(case, contest, Mode::SLOW).into_iter().map(Moving::at_middle).collect()
            }
            _ => moving(case, contest, mode),
        };
        let pair_count: usize = all.iter().map(|moving| moving.pairs.len()).sum();
        let crossing: usize = all.iter().map(Moving::crossing_count).sum();
        let query_count = pair_count * if mode == Mode::Fresh { 1 } else { STEP_COUNT };
        let scale = 1e9 / query_count.max(1) as f64;
        let times = race(&sides, SHORT_REPEATS, scale, |side| (side.sweep)(&all));
        let answered = Contest::BACKENDS.into_iter().zip(&sides).zip(times);
        let rows = answered.map(|((backend, side), time)| {
            case.row(PAIRS, backend)
                .key("mode", mode.to_string())
                .with("pair_count", pair_count)
                .with("crossing", crossing)
                .with("time", time)
                .with("errors", (side.judge)(&all))
        });
        rows.collect::<Vec<_>>()
    });
    rows.collect()
}

/// The contacts of both meshes in the middle of each motion that last throughout it.
fn moving(case: &Case, contest: &Contest, mode: Mode) -> Vec<Moving> {
    let mesh = case.shape.as_trimesh().expect("cases are about meshes");
    let within = (1.0 - BAND) * f64::from(case.prediction);
    let contacts = case.sequences(mode, MOTION_LIMIT).into_par_iter().with_max_len(1);
    let contacts = contacts.map(|sequence| {
        let mut memory = Memory::default();
        sequence.ask(&mut memory, contest.sbbk(), STEP_COUNT / 2);
        let Sequence { poses, prediction, .. } = sequence;
        let manifolds = &memory.manifolds;
        let sampled = sample_indices(manifolds.len(), PAIR_LIMIT).into_iter();
        let indices = sampled.map(|i| [manifolds[i].subshape1, manifolds[i].subshape2]);
        let pairs = indices.map(|pair| pair.map(|triangle| mesh.triangle(triangle)));
        let is_lasting =
            |pair: &[Triangle; 2]| poses.iter().all(|pose| truth(pair, pose).distance <= within);
        let pairs = pairs.filter(is_lasting).collect();
        Moving { poses, pairs, prediction }
    });
    contacts.collect()
}

impl Moving {
    /// The same pairs at the pose in the middle only.
    fn at_middle(self) -> Self {
        Self { poses: vec![self.middle()], ..self }
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

/// Time of all pairs: with a new generator, where there is one pose; else with one that goes
/// through all poses, the first of which is not timed.
fn sweep<G: Generator>(all: &[Moving]) -> Duration {
    let times = all.iter().map(|Moving { poses, pairs, prediction }| {
        let update = |generator: &mut G, pose: &Pose3, pair: &[Triangle; 2]| {
            black_box(generator.update(pose, pair, *prediction));
        };
        if let [pose] = &poses[..] {
            return timed(|| pairs.iter().for_each(|p| update(&mut G::default(), pose, p))).0;
        }
        let mut generators: Vec<G> = pairs.iter().map(|_| G::default()).collect();
        let mut update_all =
            |pose| generators.iter_mut().zip(pairs).for_each(|(g, pair)| update(g, pose, pair));
        update_all(&poses[0]);
        timed(|| poses[1..].iter().for_each(update_all)).0
    });
    times.sum()
}

/// Errors at the last pose, each pair having gone through those before.
fn judge<G: Generator>(all: &[Moving]) -> ContactErrors {
    let pairs = all.iter().flat_map(|moving| moving.pairs.iter().map(move |pair| (moving, pair)));
    let errors = pairs.map(|(Moving { poses, prediction, .. }, pair)| {
        let mut generator = G::default();
        let [before @ .., last] = &poses[..] else { return ContactErrors::default() };
        for pose in before {
            generator.update(pose, pair, *prediction);
        }
        let manifold = generator.update(last, pair, *prediction);
        let truth = Truth::of_triangles([truth(pair, last)], *prediction);
        truth.judge_manifolds(std::slice::from_ref(manifold))
    });
    errors.sum()
}
