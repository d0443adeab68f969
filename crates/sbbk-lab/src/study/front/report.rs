//! All of it in one go.

use std::convert::Infallible;
use std::time::{Duration, Instant};

use glamx::Pose3;
use oorandom::Rand32;
use sbbk_core::traverse::DescentCounts;
use serde::Serialize;

use super::super::turns::in_turn;
use super::super::{Progress, StudyError};
use super::journey::{JourneyRow, journey};
use super::motion::{FrontMotion, STEP_COUNT};
use super::plan::{FrontPlan, PREDICTION, Posed};
use super::search::Search;
use super::variant::Variant;
use crate::metrics::{Environment, Summary};

/// All that [`front`] found.
#[derive(Clone, Debug, Serialize)]
pub struct FrontStudy {
    /// Machine and build.
    pub environment: Environment,
    /// Motion by motion, mesh by mesh.
    pub rows: Vec<FrontRow>,
    /// The dispatcher and stock, mesh by mesh.
    pub journeys: Vec<JourneyRow>,
}

/// One mesh against itself in one kind of motion.
#[derive(Clone, Debug, Serialize)]
pub struct FrontRow {
    /// How the pair moves.
    pub motion: FrontMotion,
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// Queries of all motions together.
    pub query_count: usize,
    /// In the order of [`Variant::ALL`].
    pub variants: Vec<VariantRow>,
}

/// One variant. Counts and times are those of one query, on average.
#[derive(Clone, Debug, Serialize)]
pub struct VariantRow {
    /// Which.
    pub variant: Variant,
    /// Pairs of nodes tested.
    pub node_tests: f64,
    /// Pairs of leaves handed to the leaf test.
    pub leaf_pairs: f64,
    /// Share of the queries that were answered from a front that was there; NaN without a front.
    pub reused: f64,
    /// Microseconds of the traversal, over the repeats.
    pub traversal: Summary,
    /// Microseconds of the whole query, over the repeats.
    pub query: Summary,
    /// Pairs of triangles within the prediction distance.
    pub pairs: f64,
    /// Pairs in which all answers together differ from those of fresh descents.
    pub differing: usize,
}

/// Measures all that `plan` asks for.
///
/// Errors: a mesh has no triangles.
pub fn front(plan: &FrontPlan, progress: &Progress) -> Result<FrontStudy, StudyError> {
    let meshes = plan.posed()?;
    progress.phase("front", meshes.len() * (FrontMotion::ALL.len() + 1));
    let mut rows = Vec::new();
    for motion in FrontMotion::ALL {
        for posed in &meshes {
            rows.push(measure(motion, posed, plan.repeats));
            progress.step();
        }
    }
    let journeys = meshes.iter().map(|posed| {
        progress.step();
        journey(posed, plan.repeats)
    });
    let journeys = journeys.collect();
    progress.finish();
    Ok(FrontStudy { environment: Environment::detect(), rows, journeys })
}

fn measure(motion: FrontMotion, posed: &Posed, repeats: usize) -> FrontRow {
    let mut random = Rand32::new(posed.triangle_count as u64);
    let motions = posed.places.iter();
    let motions = motions.map(|place| motion.poses(&posed.shape, place, PREDICTION, &mut random));
    let motions: Vec<Vec<Pose3>> = motions.collect();
    let query_count = motions.len() * (STEP_COUNT + 1);
    let traversal = race(posed, &motions, repeats, |search, pose| {
        search.traverse(&posed.tree, pose, PREDICTION, ());
    });
    let query = race(posed, &motions, repeats, |search, pose| {
        search.query(&posed.tree, pose, PREDICTION, ());
    });
    let fresh = answers(posed, &motions, Variant::Fresh);
    let variants = Variant::ALL.into_iter().enumerate().map(|(i, variant)| {
        let found = answers(posed, &motions, variant);
        let counts = count(posed, &motions, variant);
        let share = |count: u64| count as f64 / query_count as f64;
        VariantRow {
            variant,
            node_tests: share(counts.0.aabb_tests),
            leaf_pairs: share(counts.0.leaf_pairs),
            reused: counts.1.map_or(f64::NAN, share),
            traversal: traversal[i],
            query: query[i],
            pairs: share(found.iter().map(|pairs| pairs.len() as u64).sum()),
            differing: found.iter().zip(&fresh).map(|(a, b)| differing(a, b)).sum(),
        }
    });
    FrontRow {
        motion,
        mesh: posed.name.clone(),
        triangle_count: posed.triangle_count,
        query_count,
        variants: variants.collect(),
    }
}

/// Microseconds a query, of all variants in turn.
fn race(
    posed: &Posed,
    motions: &[Vec<Pose3>],
    repeats: usize,
    ask: impl Fn(&mut Search, &Pose3),
) -> Vec<Summary> {
    let query_count = motions.iter().map(Vec::len).sum::<usize>();
    debug_assert_eq!(motions.len(), posed.places.len());
    let Ok(times) = in_turn(&Variant::ALL, repeats.max(1), |&variant, _| {
        let mut time = Duration::ZERO;
        for poses in motions {
            let mut search = Search::new(variant);
            let start = Instant::now();
            poses.iter().for_each(|pose| ask(&mut search, pose));
            time += start.elapsed();
        }
        Ok::<_, Infallible>(1e6 * time.as_secs_f64() / query_count as f64)
    });
    times.into_iter().flat_map(Summary::of).collect()
}

/// The sorted pairs of triangles of each query.
fn answers(posed: &Posed, motions: &[Vec<Pose3>], variant: Variant) -> Vec<Vec<(u32, u32)>> {
    let mut answers = Vec::new();
    for poses in motions {
        let mut search = Search::new(variant);
        for pose in poses {
            search.query(&posed.tree, pose, PREDICTION, ());
            let mut pairs = search.pairs.clone();
            pairs.sort_unstable();
            answers.push(pairs);
        }
    }
    answers
}

/// The work of all traversals, and how many were answered from a front.
fn count(posed: &Posed, motions: &[Vec<Pose3>], variant: Variant) -> (DescentCounts, Option<u64>) {
    let mut counts = DescentCounts::default();
    let mut reused = None;
    for poses in motions {
        let mut search = Search::new(variant);
        for pose in poses {
            let before = counts.leaf_pairs;
            search.traverse(&posed.tree, pose, PREDICTION, &mut counts);
            // A reused list of leaves is handed out again.
            counts.leaf_pairs = before + search.leaf_pairs.len() as u64;
        }
        if let Some(front) = search.front() {
            *reused.get_or_insert(0) += front.stats().reused;
        }
    }
    (counts, reused)
}

/// Number of pairs in one sorted list only.
fn differing(a: &[(u32, u32)], b: &[(u32, u32)]) -> usize {
    let missing = |from: &[(u32, u32)], other: &[(u32, u32)]| {
        from.iter().filter(|pair| other.binary_search(pair).is_err()).count()
    };
    missing(a, b) + missing(b, a)
}
