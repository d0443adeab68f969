//! Single steps on a small scale.

use sbbk_lab::backend::Backend;
use sbbk_lab::study::Progress;
use sbbk_lab::study::one_step::{OneStepPlan, one_step};

use super::support;

/// Would catch bodies that are not put where they were, which no number of substeps would mend; a
/// reference that has not converged; errors that are not of one step; and contacts of surfaces that
/// are no nearer to the truth than stock's.
#[test]
fn more_substeps_come_nearer_to_the_reference() {
    let plan = OneStepPlan {
        heads: 20,
        backends: vec![Backend::Stock, Backend::Sbbk],
        substeps: vec![1, 16],
        moments: vec![60, 90],
        reference_substeps: 64,
        ..OneStepPlan::quick()
    };
    let study = one_step(&plan, &Progress::hidden());
    let error = |row: usize| study.rows[row].number("error.median");
    let names: Vec<&str> = study.rows.iter().map(|row| &*row.backend).collect();
    assert_eq!(names[2..], ["stock", "sbbk", "stock", "sbbk"]);
    let ([half, clusters], [stock, sbbk], [stock16, sbbk16]) =
        ([error(0), error(1)], [error(2), error(3)], [error(4), error(5)]);
    assert!(half > 0.0 && half < 0.1 && half < clusters, "{half} {clusters}");
    assert!(sbbk < 1.0 && sbbk16 < 0.7 * sbbk, "{sbbk} {sbbk16}");
    assert!(sbbk16 < 0.5 * stock16, "{stock} {stock16}");
    assert!(study.rows.iter().all(|row| row.number("solver.min") > 0.0));

    assert_eq!(support::line_counts(&study), [6]);
    assert!(support::report(&study).svg.contains("solver alone"));
}
