//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: wrong ones, and times.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{StudyArguments, exit_code};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

/// Compares the contacts of stock Parry and SBBK with brute force, and their times
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(ContactsPlan::standard, ContactsPlan::quick);
    exit_code(study.run(None, None, |progress| Ok(contacts(&plan, progress))))
}
