//! What one step does to the velocities of a pile, beside a converged step with every contact:
//! error against time, for several numbers of solver iterations.
//!
//! ```text
//! cargo run --release --example one_step
//! cargo run --release --example one_step -- --quick --backends stock,sbbk --csv step.csv
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::one_step::{OneStepPlan, one_step};

/// Compares single steps with what they should do.
#[derive(Parser)]
struct Arguments {
    /// Compares only these
    #[arg(long, value_enum, value_name = "BACKENDS", value_delimiter = ',')]
    backends: Vec<Backend>,
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { backends, study } = Arguments::parse();
    let mut plan = study.plan(OneStepPlan::standard, OneStepPlan::quick);
    if !backends.is_empty() {
        plan.backends = backends;
    }
    exit_code(study.run(&plan, one_step, OtherFiles::default()))
}
