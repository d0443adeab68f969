//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: wrong ones, and times.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv
//! ```

use sbbk_lab::cli::{Outcome, run_study};
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

fn main() -> Outcome {
    run_study(
        "Compares the contacts of stock Parry and SBBK with brute force, and their times",
        ContactsPlan::standard,
        ContactsPlan::quick,
        contacts,
    )
}
