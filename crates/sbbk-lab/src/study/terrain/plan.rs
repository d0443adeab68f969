//! All of it in one go.

use std::convert::Infallible;
use std::time::Duration;

use glamx::Pose3;
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use serde::Serialize;

use super::fall::{Fall, falls};
use super::places::{motion, place};
use super::way::Way;
use crate::backend::Backend;
use crate::mesh;
use crate::metrics::{Environment, ErrorCount, Judge, Summary};
use crate::scene::{Ground, HeadsOnTerrain, SceneError};
use crate::study::contacts::Contest;
use crate::study::turns::in_turn;
use crate::study::{Progress, StudyError};

/// Rapier's, in units.
pub(super) const PREDICTION: Real = 0.02;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct TerrainPlan {
    /// Cells along the sides of the terrains.
    pub cells: Vec<u32>,
    /// Places on each.
    pub place_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
    /// Steps of the heads that fall.
    pub fall_steps: usize,
}

impl TerrainPlan {
    /// From a thousand cells to a million; half a minute on two cores.
    pub fn standard() -> Self {
        Self { cells: vec![32, 100, 316, 1000], place_count: 12, repeats: 15, fall_steps: 300 }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { cells: vec![32, 100], place_count: 4, repeats: 3, fall_steps: 300 }
    }
}

/// All that [`terrain`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Terrain {
    /// Machine and build.
    pub environment: Environment,
    /// By terrain, and who answered for what.
    pub rows: Vec<TerrainRow>,
    /// Heads that fall on a terrain.
    pub falls: Vec<Fall>,
}

/// One terrain, one way to answer.
#[derive(Clone, Debug, Serialize)]
pub struct TerrainRow {
    /// Cells along the side.
    pub cells: u32,
    /// Who answered.
    pub backend: Backend,
    /// What the terrain was.
    pub ground: Ground,
    /// Microseconds of a first query, by repeat; trees are built.
    pub fresh: Summary,
    /// Microseconds of a query in slow motion, by repeat.
    pub steady: Summary,
    /// Contacts lost, added and wrong, of all answers.
    pub errors: ErrorCount,
    /// Cells whose heights a first query reads, on the mean; for fields.
    pub cells_read: Option<f64>,
}

/// Measures all that `plan` asks for.
///
/// Errors: none but those of a mesh without triangles, which these are not.
pub fn terrain(plan: &TerrainPlan, progress: &Progress) -> Result<Terrain, StudyError> {
    progress.phase("terrains", plan.cells.len());
    let mut rows = Vec::new();
    for &cells in &plan.cells {
        rows.extend(of_size(plan, cells)?);
        progress.step();
    }
    let falls = falls(plan.fall_steps, progress)?;
    progress.finish();
    Ok(Terrain { environment: Environment::detect(), rows, falls })
}

fn of_size(plan: &TerrainPlan, cells: u32) -> Result<Vec<TerrainRow>, StudyError> {
    let shared = |mesh: &mesh::Mesh| {
        mesh.shared_shape().map_err(|cause| SceneError { mesh: mesh.name.clone(), cause })
    };
    let head = shared(&mesh::monkey_head().centred().scaled_to(2.0))?;
    let ground = shared(&HeadsOnTerrain::terrain(cells))?;
    let field = SharedShape::new(HeadsOnTerrain::field(cells));
    let contest = Contest::new([&head, &ground].into_iter());
    let [stock, sbbk] = &contest.dispatchers;
    let way = |(backend, dispatcher), ground, shape| Way { backend, dispatcher, ground, shape };
    let ways = [
        way((Backend::Stock, stock), Ground::Mesh, &ground),
        way((Backend::Sbbk, sbbk), Ground::Mesh, &ground),
        way((Backend::Sbbk, sbbk), Ground::HeightField, &field),
    ];
    let mut random = Rand32::new(u64::from(cells));
    let places = (0..plan.place_count).map(|_| place(&mut random, &head, &ground, cells));
    let motions: Vec<Vec<Pose3>> = places.map(motion).collect();
    let fresh = times(plan, &ways, |way| way.fresh(&head, &motions));
    let steady = times(plan, &ways, |way| way.steady(&head, &motions));
    let judge = Judge::new([&ground, &head]);
    let rows = ways.iter().zip(fresh).zip(steady).map(|((way, fresh), steady)| TerrainRow {
        cells,
        backend: way.backend,
        ground: way.ground,
        fresh,
        steady,
        errors: way.errors(&judge, (&ground, &head), cells, &motions),
        cells_read: way.cells_read(&head, &motions),
    });
    Ok(rows.collect())
}

/// Microseconds a query, by way.
fn times(
    plan: &TerrainPlan,
    ways: &[Way<'_>; 3],
    sweep: impl Fn(&Way<'_>) -> (Duration, usize),
) -> Vec<Summary> {
    let Ok(times) = in_turn(ways, plan.repeats.max(1), |way, _| {
        let (time, count) = sweep(way);
        Ok::<_, Infallible>(1e6 * time.as_secs_f64() / count as f64)
    });
    times.into_iter().filter_map(Summary::of).collect()
}
