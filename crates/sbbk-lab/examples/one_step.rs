//! Velocities of a pile after one step, beside those of a converged step with every contact: error
//! against time, for several numbers of solver iterations.
//!
//! ```text
//! cargo run --release --example one_step
//! cargo run --release --example one_step -- --quick --backends stock,sbbk --csv step.csv
//! ```

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{Outcome, StudyArguments};
use sbbk_lab::study::one_step::{OneStepPlan, one_step};

/// Compares single steps with a converged one
#[derive(Parser)]
struct Arguments {
    /// Compares only these
    #[arg(long, value_enum, value_name = "BACKENDS", value_delimiter = ',')]
    backends: Vec<Backend>,
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> Outcome {
    let Arguments { backends, study } = Arguments::parse();
    let mut plan = study.plan(OneStepPlan::standard, OneStepPlan::quick);
    if !backends.is_empty() {
        plan.backends = backends;
    }
    study.run(None, None, |progress| Ok(one_step(&plan, progress)))
}
