//! Both scenes of the paper under stock Rapier and SBBK, with the paper's numbers among ours.
//!
//! ```text
//! cargo run --release --example compare
//! cargo run --release --example compare -- --quick --csv compare.csv
//! ```

use sbbk_lab::cli::{Outcome, run_study};
use sbbk_lab::study::compare::{ComparePlan, compare};

fn main() -> Outcome {
    run_study(
        "Compares stock Rapier, SBBK, and SBBK with AABBs only, in speed and error",
        ComparePlan::standard,
        ComparePlan::quick,
        compare,
    )
}
