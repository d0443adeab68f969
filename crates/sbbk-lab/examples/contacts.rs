//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: wrong ones, and times.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv
//! ```

use clap::Parser;
use sbbk_lab::cli::{Outcome, StudyArguments};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

/// Compares the contacts of stock Parry and SBBK with brute force, and their times
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> Outcome {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(ContactsPlan::standard, ContactsPlan::quick);
    study.run(None, None, |progress| Ok(contacts(&plan, progress)))
}
