//! The contact of a triangle and a convex shape against brute force, with the checks of the
//! property tests.
//!
//! With cargo-fuzz and a nightly compiler: `cargo +nightly fuzz run convex`.

#![no_main]

#[path = "../../crates/sbbk-core/tests/all/convex_contact/drawn.rs"]
mod drawn;
#[path = "../../crates/sbbk-core/tests/all/convex_contact/shape.rs"]
#[allow(dead_code)]
mod shape;
#[path = "../../crates/sbbk-core/tests/support/mod.rs"]
mod support;
#[path = "../../crates/sbbk-core/tests/all/convex_contact/truth.rs"]
mod truth;

use libfuzzer_sys::arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut input = Unstructured::new(bytes);
    // Too few bytes make no shapes.
    let _ = drawn::check_drawn(&mut |below| input.int_in_range(0..=below - 1));
});
