//! A mesh against convex shapes and compounds of them, stock Parry beside SBBK: what queries cost,
//! and whether a contact is lost or added.
//!
//! The mesh comes towards a shape of each kind along random directions and is stopped at five places
//! around the first touch; the pair is asked there for the first time, and in slow and faster motion
//! through these places. Which triangles must have a contact is told by Parry's routine, run afresh on
//! every triangle of the mesh and every part of the shape. Stock makes its contacts by it, SBBK those of
//! some shapes only: where Parry's depths are not exact, SBBK's differ from them.

mod errors;
mod kinds;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;

use self::errors::{Expected, Posed};
use self::kinds::{Kind, Upright, kinds};
use super::motion::{Approach, Mode, Place, mode_notes};
use super::pair::{Contest, DIRECT_NOTE, Sequence};
use super::{Progress, StudyError, shape};
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, ErrorCount};
use crate::report::{Panel, Results, Row, TIME_NOTE, TableSpec, number, sides};
use crate::scene::random;

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

/// How far beyond the first touch the mesh is stopped, in prediction distances: about to touch,
/// touching, and somewhat deeper than a body at rest is.
const ADVANCES: [Real; 5] = [-0.95, -0.5, 0.0, 0.5, 2.0];
const SHAPES: &str = "convex: queries, µs";
const COMPOUNDS: &str = "compounds: queries, µs";

impl ConvexPlan {
    /// The head of 968 triangles, two units across, Rapier's prediction distance; within a minute on
    /// two cores.
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
pub fn convex(plan: &ConvexPlan, progress: &Progress) -> Result<Results, StudyError> {
    let mesh = shape(&plan.mesh)?;
    let contest = Contest::new([&mesh]);
    let kinds = kinds();
    progress.phase("convex shapes and compounds", kinds.len());
    let mut rows: Vec<Row> = Vec::new();
    for (seed, kind) in (0..).zip(&kinds) {
        let mut random = Rand32::new(seed);
        let places = (0..plan.approach_count).flat_map(|_| {
            let approach = approach(&contest, &mesh, kind, &mut random);
            ADVANCES.map(|advance| approach.place(advance * plan.prediction))
        });
        let places: Vec<Place> = places.collect();
        for mode in Mode::ALL {
            rows.extend(measure(plan, &contest, &mesh, kind, &places, mode));
        }
        progress.step();
    }
    progress.finish();
    let ConvexPlan { mesh, prediction, .. } = plan;
    let tables = [("convex shapes", SHAPES), ("compounds", COMPOUNDS)].map(|(kinds, study)| {
        let mut notes = mode_notes();
        notes.extend([
            "every other place or motion is asked with the mesh first".to_owned(),
            TIME_NOTE.to_owned(),
            "errors: lost + added + wrong depth, of the true contacts in all answers, against Parry's \
             routine run afresh on every triangle (and part); added is what Parry's own distance \
             denies, too; 1 % of the prediction distance may go either way, depths are wrong from \
             5 % on"
                .to_owned(),
            DIRECT_NOTE.to_owned(),
        ]);
        let spec = TableSpec {
            title: format!(
                "A mesh against {kinds}: {} of {} triangles, prediction distance {prediction}; \
                 microseconds a query",
                mesh.name,
                mesh.triangle_count()
            ),
            study,
            keys: &["mode", "shape"],
            total: Some(1),
            columns: [vec![number("places or motions", "place_count").of("sbbk")], sides()].concat(),
            notes,
        };
        spec.of(&rows)
    });
    let panels = Mode::ALL.map(|mode| {
        let is_shown = move |row: &&Row| row.is("mode", mode);
        Panel::time_against_error(format!("Queries, {mode}"), rows.iter().filter(is_shown))
    });
    let environment = Environment::detect();
    Ok(Results { environment, rows, tables: tables.into(), panels: panels.into() })
}

/// A random way of the mesh to the shape.
fn approach(contest: &Contest, mesh: &SharedShape, kind: &Kind, random: &mut Rand32) -> Approach {
    let shapes = [&kind.shape, mesh];
    let Some(upright) = kind.floor else {
        return Approach::random(contest.sbbk(), shapes, random);
    };
    let rotation = match upright {
        Upright::Yes => Quat::IDENTITY,
        Upright::No => random::rotation(random),
    };
    let [x, z] = [(); 2].map(|()| 20.0 * random.rand_float() - 10.0);
    Approach::along(Vec3::Y, rotation, Vec3::new(x, 0.0, z), contest.sbbk(), shapes)
        .expect("what comes from above to a floor touches it")
}

/// Times and errors of both with one kind of shape.
fn measure(
    plan: &ConvexPlan,
    contest: &Contest,
    mesh: &SharedShape,
    kind: &Kind,
    places: &[Place],
    mode: Mode,
) -> impl Iterator<Item = Row> {
    let sequence = |(index, place): (usize, &Place)| {
        let poses = mode.poses(mesh, place, plan.prediction).into_iter();
        let (shapes, poses): (_, Vec<Pose3>) = if is_mesh_first(index) {
            ([mesh, &kind.shape], poses.map(|pose| pose.inverse()).collect())
        } else {
            ([&kind.shape, mesh], poses.collect())
        };
        Sequence { shapes, poses, prediction: plan.prediction }
    };
    let sequences: Vec<Sequence> = places.iter().enumerate().map(sequence).collect();
    let times = contest.race(plan.repeats, &sequences);
    let errors = judge(contest, mesh, kind, &sequences);
    let parts = kind.shape.as_compound().map(|compound| compound.shapes().len());
    let study = if parts.is_some() { COMPOUNDS } else { SHAPES };
    let sides = Contest::BACKENDS.into_iter().zip(times).zip(errors);
    sides.map(move |((backend, time), errors)| {
        Row::new(study, backend)
            .key("mesh", &*plan.mesh.name)
            .key("shape", kind.name)
            .key("mode", mode.to_string())
            .with("part_count", parts)
            .with("place_count", places.len())
            .with("time", time)
            .with("errors", errors)
    })
}

/// Judges all answers of both.
fn judge(
    contest: &Contest,
    mesh: &SharedShape,
    kind: &Kind,
    sequences: &[Sequence],
) -> [ErrorCount; 2] {
    let mut errors = [ErrorCount::default(); 2];
    for (index, sequence) in sequences.iter().enumerate() {
        let is_mesh_first = is_mesh_first(index);
        let expected = sequence.poses.iter().map(|&pos12| {
            let posed = Posed { mesh, shape: &kind.shape, pos12, is_mesh_first };
            Expected::new(posed, sequence.prediction)
        });
        let expected: Vec<Expected> = expected.collect();
        let subshapes = |manifold: &ContactManifold| {
            let (one, two) = (manifold.subshape1, manifold.subshape2);
            if is_mesh_first { (one, two) } else { (two, one) }
        };
        for (dispatcher, errors) in contest.dispatchers.iter().zip(&mut errors) {
            sequence.walk(dispatcher, |step, manifolds| {
                *errors += expected[step].judge(manifolds, subshapes);
            });
        }
    }
    errors
}

fn is_mesh_first(index: usize) -> bool {
    index.is_multiple_of(2)
}
