//! A mesh against convex shapes and compounds, stock Parry beside SBBK: wrong contacts, and times.
//!
//! ```text
//! cargo run --release --example convex
//! cargo run --release --example convex -- --quick --csv convex.csv
//! ```

use sbbk_lab::cli::{Outcome, run_study};
use sbbk_lab::study::convex::{ConvexPlan, convex};

fn main() -> Outcome {
    run_study(
        "Compares the contacts of a mesh and convex shapes or compounds, and their times",
        ConvexPlan::standard,
        ConvexPlan::quick,
        convex,
    )
}
