//! Contacts of mesh pairs at every scale: how many are right, and what they cost, stock Parry
//! beside SBBK.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv --plot contacts.svg
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{Output, exit_code};
use sbbk_lab::report::{tables, write_contacts_plot};
use sbbk_lab::study::Progress;
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

/// Compares the contacts of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    /// Smaller meshes and fewer poses: half a minute instead of three
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    output: Output,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { ContactsPlan::quick() } else { ContactsPlan::standard() };
    arguments.output.reserve()?;
    let contacts = contacts(&plan, &Progress::visible())?;
    let tables = tables::contacts(&contacts);
    arguments.output.publish(&contacts, &contacts.environment, &tables, write_contacts_plot)
}
