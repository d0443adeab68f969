//! A table and a picture of single steps.

use super::{LEAD, OneStepPlan};
use crate::backend::Backend;
use crate::report::{Row, Table, TableSpec, number, time};

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

pub(super) fn verdict(plan: &OneStepPlan, rows: &[Row]) -> String {
    let substeps = plan.substeps.iter().copied().find(|&count| count >= 4).unwrap_or(1) as u64;
    let of = |backend: Backend, path| {
        let is_shown = |row: &&Row| row.is("backend", backend) && row.count("substeps") == substeps;
        rows.iter().find(is_shown).map_or(f64::NAN, |row| row.number(path))
    };
    let [stock, sbbk] =
        [Backend::Stock, Backend::Sbbk].map(|b| [of(b, "error.median"), of(b, "step.median")]);
    format!(
        "at {substeps} substeps the velocities after one step err by {:.2} of the contact impulse \
         (stock {:.2}); a step takes {:.1} ms (stock {:.1})",
        sbbk[0], stock[0], sbbk[1], stock[1]
    )
}
