//! A long run in which bodies and meshes come and go all the time.
//!
//! ```text
//! cargo run --release --example soak
//! cargo run --release --example soak -- --steps 100000
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::study::Progress;
use sbbk_lab::study::soak::{SoakEnd, SoakPlan, soak};

/// Runs SBBK for long: memory and step time should stay flat, no contact be lost, and no tree be
/// left at the end. Fails if one is.
#[derive(Parser)]
struct Arguments {
    /// Steps of a sixtieth of a second
    #[arg(long, default_value = "10000")]
    steps: usize,
    /// Bodies at once
    #[arg(long, default_value = "40")]
    bodies: usize,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let window = arguments.steps.div_ceil(10).max(1);
    let plan = SoakPlan {
        steps: arguments.steps,
        body_limit: arguments.bodies,
        window,
        ..SoakPlan::default()
    };
    let (found, SoakEnd { wrong, trees_left }) = soak(&plan, &Progress::visible());
    print(found)?;
    if wrong > 0 || trees_left > 0 {
        return Err(format!("{wrong} wrong contacts, {trees_left} trees left").into());
    }
    Ok(())
}
