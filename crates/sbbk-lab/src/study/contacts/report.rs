//! All of it in one go.

use serde::Serialize;

use super::super::{Progress, StudyError};
use super::contest::Contest;
use super::exactness::{ExactnessRow, exactness};
use super::plan::ContactsPlan;
use super::speed::{SpeedRow, speed};
use super::triangles::{GeneratorRow, generators};
use crate::metrics::Environment;

/// All that [`contacts`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Contacts {
    /// Machine and build.
    pub environment: Environment,
    /// Right and wrong answers, case by case.
    pub exactness: Vec<ExactnessRow>,
    /// Times of the cases of [`SPEED_CASE`].
    pub speed: Vec<SpeedRow>,
    /// The contact generators alone, in the same cases.
    pub generators: Vec<GeneratorRow>,
}

/// Size and prediction distance, in units, of the cases whose speed is measured: Rapier's default
/// distance, and meshes of the size that it is made for.
pub const SPEED_CASE: [f32; 2] = [2.0, 0.02];

/// Measures all that `plan` asks for.
///
/// Errors: a mesh has no triangles.
pub fn contacts(plan: &ContactsPlan, progress: &Progress) -> Result<Contacts, StudyError> {
    let shapes = plan.shapes()?;
    let contest = Contest::new(shapes.iter());
    let cases = plan.posed(&shapes, &contest, progress);
    let exactness = exactness(&cases, &contest, plan.case_repeats, progress);
    let is_speed_case = |row: &ExactnessRow| [row.case.size, row.case.prediction] == SPEED_CASE;
    let chosen = cases.iter().zip(&exactness).filter(|(_, row)| is_speed_case(row));
    let chosen: Vec<_> = chosen.collect();
    progress.phase("speed", 5 * chosen.len());
    let (mut speed_rows, mut generator_rows) = (Vec::new(), Vec::new());
    for (posed, row) in chosen {
        let repeats = plan.repeats(posed.case.triangle_count);
        speed_rows.push(speed(posed, row, &contest, repeats, progress));
        generator_rows.push(generators(posed, &contest, progress));
    }
    progress.finish();
    Ok(Contacts {
        environment: Environment::detect(),
        exactness,
        speed: speed_rows,
        generators: generator_rows,
    })
}
