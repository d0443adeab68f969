//! Velocities of a pile after one step, beside those of a converged step with every contact: error
//! against time, for several numbers of solver iterations.
//!
//! ```text
//! cargo run --release --example one_step
//! cargo run --release --example one_step -- --quick --csv step.csv
//! ```

use sbbk_lab::cli::{Outcome, run_study};
use sbbk_lab::study::one_step::{OneStepPlan, one_step};

fn main() -> Outcome {
    run_study(
        "Compares single steps with a converged one",
        OneStepPlan::standard,
        OneStepPlan::quick,
        one_step,
    )
}
