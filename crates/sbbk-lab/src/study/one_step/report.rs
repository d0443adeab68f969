//! A table and a picture of single steps.

use super::{LEAD, OneStepPlan};
use crate::report::{Panel, Row, Scale, Table, TableSpec, number, time};

pub(super) const STUDY: &str = "one step";

pub(super) fn table(plan: &OneStepPlan, rows: &[Row]) -> Table {
    TableSpec::new(
        "One step: velocities beside those of a converged step with every contact",
        STUDY,
        &["scene", "substeps", "backend"],
        [
            number("error, median", "error.median"),
            number("largest", "error.max"),
            number("points of the solver", "points.median"),
            time("solver, ms", "solver"),
            time("broad + narrow, ms", "collision_detection"),
            time("step, ms", "step"),
        ],
    )
    .note(format!(
        "error: the difference from the reference over its contact impulse, in the norm of \
                 kinetic energy, at the steps {:?} of a run on {}",
        plan.moments, plan.reference
    ))
    .note(format!(
        "reference: contacts of {}, none recycled or clustered, {} substeps; what its own \
                 variants differ by is in the first lines",
        plan.reference, plan.reference_substeps
    ))
    .note(format!(
        "times: min / median over the steps and the {LEAD} before each, in which bodies are \
                 put where they were in the run"
    ))
    .of(rows)
}

/// Error against time of the step and of the solver alone.
pub(super) fn panels(plan: &OneStepPlan, rows: &[Row]) -> Vec<Panel> {
    let panel = |(title, label, path): (&str, &'static str, &'static str)| {
        let labels = [label, "error, as a share of the contact impulse"];
        let panel = Panel::new(title, labels, Scale::Logarithmic);
        let point = |row: &Row| Some([row.number(path), row.number("error.median")]);
        panel.backends(&plan.backends, rows.iter(), true, point)
    };
    let wanted = [
        ("One step: whole steps", "ms a step", "step.median"),
        ("One step: solver alone", "ms a step, solver", "solver.median"),
    ];
    wanted.map(panel).into()
}
