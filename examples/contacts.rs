//! Contacts of mesh pairs at every scale: how many are right, and what they cost, stock Parry
//! beside SBBK.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv --plot contacts.svg
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

/// Compares the contacts of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(ContactsPlan::standard, ContactsPlan::quick);
    exit_code(study.run(&plan, contacts, OtherFiles::default()))
}
