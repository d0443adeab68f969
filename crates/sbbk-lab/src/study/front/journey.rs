//! Coherent motion with teleports, through the whole dispatcher: stock beside SBBK.

use std::time::{Duration, Instant};

use glamx::Pose3;
use oorandom::Rand32;
use rapier3d::geometry::{ContactManifold, TrackedContact};
use rayon::prelude::*;
use serde::Serialize;

use super::super::contacts::{CONTESTANTS, ContactErrors, Contest, Memory};
use super::motion::FrontMotion;
use super::plan::{PREDICTION, Posed};
use crate::backend::{Backend, Question, SharedDispatcher};
use crate::metrics::{Judge, Summary};

/// One mesh against itself, in slow motion through one place after the other, without a pause.
#[derive(Clone, Debug, Serialize)]
pub struct JourneyRow {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// Queries.
    pub query_count: usize,
    /// How many of them were far from the one before.
    pub teleport_count: usize,
    /// Stock and SBBK.
    pub sides: [JourneySide; 2],
    /// Manifolds of SBBK that differ from those of a fresh query in any bit of their triangles, points, distances or
    /// normals, over all queries.
    pub differing: usize,
}

/// One dispatcher.
#[derive(Clone, Debug, Serialize)]
pub struct JourneySide {
    /// Who answered.
    pub backend: Backend,
    /// Microseconds a query, over the repeats.
    pub time: Summary,
    /// Errors at the end of the motion through each place.
    pub errors: ContactErrors,
}

/// Measures one mesh.
pub(super) fn journey(posed: &Posed, repeats: usize) -> JourneyRow {
    let mut random = Rand32::new(posed.triangle_count as u64);
    let slow = FrontMotion::Slow;
    let motion = |place| slow.poses(&posed.shape, place, PREDICTION, &mut random);
    let motions: Vec<Vec<Pose3>> = posed.places.iter().map(motion).collect();
    let contest = Contest::new([&posed.shape].into_iter());
    let query_count = motions.iter().map(Vec::len).sum();
    let times = contest.race(repeats, query_count, |dispatcher| {
        let mut memory = Memory::default();
        let start = Instant::now();
        for pose in motions.iter().flatten() {
            memory.ask(dispatcher, &posed.shape, pose, PREDICTION);
        }
        start.elapsed().max(Duration::from_nanos(1))
    });
    let errors = contest.dispatchers.each_ref().map(|side| judge(posed, &motions, side));
    JourneyRow {
        mesh: posed.name.clone(),
        triangle_count: posed.triangle_count,
        query_count,
        teleport_count: motions.len() - 1,
        sides: [0, 1].map(|i| JourneySide {
            backend: CONTESTANTS[i],
            time: times[i],
            errors: errors[i],
        }),
        differing: differing(posed, &motions, contest.sbbk()),
    }
}

fn judge(posed: &Posed, motions: &[Vec<Pose3>], dispatcher: &SharedDispatcher) -> ContactErrors {
    let mut memory = Memory::default();
    let mut answers = Vec::new();
    for poses in motions {
        for pose in poses {
            memory.ask(dispatcher, &posed.shape, pose, PREDICTION);
        }
        let last = poses.last().expect("a motion has poses");
        let question = Question::new(last, [&*posed.shape; 2], PREDICTION);
        answers.push((question, memory.manifolds.clone()));
    }
    let judge = Judge::new([&posed.shape]);
    let errors: Vec<ContactErrors> = answers
        .par_iter()
        .with_max_len(1)
        .map(|(question, manifolds)| {
            ContactErrors::of(&judge.truth(question), *question, manifolds)
        })
        .collect();
    errors.into_iter().sum()
}

fn differing(posed: &Posed, motions: &[Vec<Pose3>], dispatcher: &SharedDispatcher) -> usize {
    let mut memory = Memory::default();
    let differing = motions.iter().flatten().map(|pose| {
        memory.ask(dispatcher, &posed.shape, pose, PREDICTION);
        let mut fresh = Memory::default();
        fresh.ask(dispatcher, &posed.shape, pose, PREDICTION);
        let (kept, fresh) = (&memory.manifolds, &fresh.manifolds);
        let pairs = kept.iter().zip(fresh);
        kept.len().abs_diff(fresh.len()) + pairs.filter(|(a, b)| !is_same(a, b)).count()
    });
    differing.sum()
}

fn is_same(a: &ContactManifold, b: &ContactManifold) -> bool {
    fn geometry<C>(p: &TrackedContact<C>) -> impl PartialEq + use<C> {
        (p.local_p1, p.local_p2, p.dist, p.fid1, p.fid2)
    }
    [a.subshape1, a.subshape2] == [b.subshape1, b.subshape2]
        && [a.local_n1, a.local_n2] == [b.local_n1, b.local_n2]
        && a.points.iter().map(geometry).eq(b.points.iter().map(geometry))
}
