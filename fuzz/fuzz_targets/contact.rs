//! The contact of two triangles against the brute-force reference, with the checks of the
//! property tests. The fuzzer builds the triangles from what makes trouble: equal vertices,
//! vertices on edges and faces, whole coordinates, and all these moved by next to nothing.
//!
//! With cargo-fuzz and a nightly compiler: `cargo +nightly fuzz run contact`. Without, on stable
//! but blind to coverage: `cargo run --release --manifest-path fuzz/Cargo.toml -- -runs=1000000`.

#![no_main]

#[path = "../../crates/sbbk-core/tests/all/contact_truth/check.rs"]
mod check;

use glamx::DVec3;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use sbbk_core::contact::{FeaturePair, contact, contact_from};

/// A point on the grid of eighths, or made from those before it.
fn vertex(input: &mut Unstructured, before: &[DVec3]) -> Result<DVec3> {
    let mut coordinate = || input.int_in_range(-16..=16_i8).map(|x| f64::from(x) / 8.0);
    let grid = DVec3::new(coordinate()?, coordinate()?, coordinate()?);
    if before.is_empty() {
        return Ok(grid);
    }
    let [a, b] = [*input.choose(before)?, *input.choose(before)?];
    let part = f64::from(input.int_in_range(-2..=10_i8)?) / 8.0;
    Ok(match input.int_in_range(0..=4_u8)? {
        0 => a,
        1 => a.lerp(b, part),
        2 => a + (b - a) * part + grid * 2.0_f64.powi(-input.int_in_range(1..=30)?),
        3 => a + grid * 2.0_f64.powi(-input.int_in_range(0..=50)?),
        _ => grid,
    })
}

fn check_bytes(bytes: &[u8]) -> Result<()> {
    let mut input = Unstructured::new(bytes);
    let mut vertices = Vec::with_capacity(6);
    for _ in 0..6 {
        vertices.push(vertex(&mut input, &vertices)?);
    }
    let (t1, t2) =
        ([vertices[0], vertices[2], vertices[4]], [vertices[1], vertices[3], vertices[5]]);
    // Of a triangle far smaller than its coordinates, the coordinates are the rounding.
    if [t1, t2].iter().any(|t| (f64::MIN_POSITIVE..1.0e-3).contains(&check::size(t))) {
        return Ok(());
    }
    check::check(&t1, &t2);
    let last = FeaturePair::from_bits(input.arbitrary()?);
    let cold = contact(&t1, &t2, f64::INFINITY).expect("finite");
    let warm = contact_from(&t1, &t2, f64::INFINITY, last).expect("finite");
    assert_eq!(cold, warm, "what was before is part of the answer: {t1:?} {t2:?}");
    Ok(())
}

fuzz_target!(|bytes: &[u8]| {
    // Too few bytes make no triangles.
    let _ = check_bytes(bytes);
});
