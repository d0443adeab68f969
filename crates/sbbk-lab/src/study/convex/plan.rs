//! All of it in one go.

use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use serde::Serialize;

use super::kinds::{Kind, kinds};
use super::places::places;
use super::race::Course;
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, ErrorCount};
use crate::scene::SceneError;
use crate::study::contacts::{Contest, FAST, Place, SLOW, STEP_COUNT, Side, motion};
use crate::study::{Progress, StudyError};

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ConvexPlan {
    /// The mesh, asked against every kind of shape.
    pub mesh: Mesh,
    /// The prediction distance, in units.
    pub prediction: Real,
    /// Approaches to each shape, of five places each.
    pub approach_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
}

/// All that [`convex`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Convex {
    /// Machine and build.
    pub environment: Environment,
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// The prediction distance, in units.
    pub prediction: Real,
    /// The shapes.
    pub rows: Vec<ConvexRow>,
}

/// The mesh against one shape.
#[derive(Clone, Debug, Serialize)]
pub struct ConvexRow {
    /// Name of the shape's kind.
    pub kind: &'static str,
    /// Convex parts, if it is a compound.
    pub part_count: Option<usize>,
    /// Poses of the first queries, and motions through them.
    pub place_count: usize,
    /// Stock and SBBK.
    pub sides: [Side<ErrorCount>; 2],
}

impl ConvexPlan {
    /// The head of 968 triangles, two units across, Rapier's prediction distance; within a minute on two cores.
    pub fn standard() -> Self {
        Self { mesh: mesh::monkey_head(), prediction: 0.02, approach_count: 6, repeats: 25 }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { approach_count: 2, repeats: 5, ..Self::standard() }
    }
}

/// Measures all that `plan` asks for.
///
/// Errors: the mesh has no triangles.
pub fn convex(plan: &ConvexPlan, progress: &Progress) -> Result<Convex, StudyError> {
    let named = |cause| SceneError { mesh: plan.mesh.name.clone(), cause };
    let shape = plan.mesh.shared_shape().map_err(named)?;
    let contest = Contest::new([&shape].into_iter());
    let kinds = kinds();
    progress.phase("convex shapes and compounds", kinds.len());
    let rows = kinds.iter().enumerate().map(|(index, kind)| {
        let row = row(plan, &shape, kind, index as u64, &contest);
        progress.step();
        row
    });
    let rows = rows.collect();
    progress.finish();
    Ok(Convex {
        environment: Environment::detect(),
        mesh: plan.mesh.name.clone(),
        triangle_count: plan.mesh.triangle_count(),
        prediction: plan.prediction,
        rows,
    })
}

fn row(
    plan: &ConvexPlan,
    mesh: &SharedShape,
    kind: &Kind,
    seed: u64,
    contest: &Contest,
) -> ConvexRow {
    let &ConvexPlan { prediction, approach_count, repeats, .. } = plan;
    let mut random = Rand32::new(seed);
    let places: Vec<Place> =
        (0..approach_count).flat_map(|_| places(mesh, kind, prediction, &mut random)).collect();
    let measure = |sequences| {
        let shape = &kind.shape;
        Course { mesh, shape, prediction, sequences }.measure(contest, repeats)
    };
    let fresh = measure(places.iter().map(|place| vec![place.pos12]).collect());
    let [slow, fast] = [SLOW, FAST].map(|share| {
        let motions =
            places.iter().map(|place| motion(mesh, place, share * prediction, STEP_COUNT));
        measure(motions.collect())
    });
    ConvexRow {
        kind: kind.name,
        part_count: kind.shape.as_compound().map(|compound| compound.shapes().len()),
        place_count: places.len(),
        sides: Side::both([fresh, slow, fast]),
    }
}
