//! Same inputs, same bits: whole worlds after hundreds of steps, run again, on more threads, and
//! with nothing remembered.
//!
//! ```text
//! cargo run --release --example determinism
//! cargo run --release --example determinism --features parallel -- --threads 1,2,4
//! cargo run --release --example determinism --features enhanced-determinism
//! ```

use std::error::Error;
use std::num::NonZeroUsize;
use std::process::ExitCode;
use std::thread::available_parallelism;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::study::Progress;
use sbbk_lab::study::determinism::{DeterminismPlan, broken, determinism};

/// Runs scenes again and again, and compares the worlds bit for bit. Fails if SBBK's differ.
#[derive(Parser)]
struct Arguments {
    /// Heads in the pile
    #[arg(long, default_value = "60")]
    heads: usize,
    /// Numbers of threads; by default 1, 2 and as many as the machine has
    #[arg(long, value_delimiter = ',')]
    threads: Vec<NonZeroUsize>,
    /// Steps of a sixtieth of a second
    #[arg(long, default_value = "300")]
    steps: NonZeroUsize,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut threads: Vec<usize> = arguments.threads.iter().map(|count| count.get()).collect();
    if threads.is_empty() {
        threads = vec![1, 2, available_parallelism().map_or(1, usize::from)];
        threads.dedup();
    }
    let plan = DeterminismPlan {
        steps: arguments.steps.get(),
        ..DeterminismPlan::standard(arguments.heads, threads)
    };
    let found = determinism(&plan, &Progress::visible());
    print(&found)?;
    match &broken(&found)[..] {
        [] => Ok(()),
        scenes => Err(format!("runs under sbbk differ: {}", scenes.join(", ")).into()),
    }
}
