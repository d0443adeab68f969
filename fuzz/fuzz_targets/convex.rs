//! The contact of a triangle and a convex shape against brute force, with the checks of the property
//! tests: points, segments, triangles, boxes and hulls by the truth, cylinders and cones by the
//! search. The fuzzer builds corners on a grid, equal ones among them, moved by next to nothing.
//!
//! With cargo-fuzz and a nightly compiler: `cargo +nightly fuzz run convex`.

#![no_main]

#[path = "../../crates/sbbk-core/tests/convex_contact/shape.rs"]
#[allow(dead_code)]
mod shape;
#[path = "../../crates/sbbk-core/tests/convex_contact/truth.rs"]
mod truth;

use glamx::DVec3;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use sbbk_core::contact::convex::{ConeSupport, CylinderSupport, round_contact};
use shape::{Core, Shape};

/// A point on the grid of eighths, or next to one.
fn point(input: &mut Unstructured) -> Result<DVec3> {
    let mut coordinate = || input.int_in_range(-16..=16_i8).map(|x| f64::from(x) / 8.0);
    let [grid, nudge] =
        [(); 2].map(|()| Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?)));
    let power = input.int_in_range(0..=50)?;
    Ok(grid? + if power == 0 { DVec3::ZERO } else { nudge? * 2.0_f64.powi(-power) })
}

fn check_bytes(bytes: &[u8]) -> Result<()> {
    let mut input = Unstructured::new(bytes);
    let triangle = [point(&mut input)?, point(&mut input)?, point(&mut input)?];
    let mut length = || input.int_in_range(0..=16_u8).map(|x| f64::from(x) / 8.0);
    let (radius, half_height, half_width) = (length()?, length()?, length()?);
    let core = match input.int_in_range(0..=6_u8)? {
        0 => Core::Point(point(&mut input)?),
        1 => Core::Segment([point(&mut input)?, point(&mut input)?]),
        2 => Core::Triangle([point(&mut input)?, point(&mut input)?, point(&mut input)?]),
        3 => Core::Cuboid(DVec3::new(half_height, half_width, radius)),
        4 => Core::Cylinder(CylinderSupport { half_height, radius: half_width }),
        5 => Core::Cone(ConeSupport { half_height, radius: half_width }),
        _ => {
            let count = input.int_in_range(4..=7_u8)?;
            Core::Hull((0..count).map(|_| point(&mut input)).collect::<Result<_>>()?)
        }
    };
    let shape = Shape { core, radius };
    let contact = shape.contact(&triangle, 100.0).expect("within the margin");
    // Coordinates are up to 4, and what is closer than 1e-10 of their sums may count as touching.
    let size = truth::size(&triangle, &shape).max(8.0);
    let says = || format!("{contact:?} {shape:?} {triangle:?}");
    if matches!(shape.core, Core::Cylinder(_) | Core::Cone(_)) {
        truth::check(&triangle, &shape, &contact, 1.0e-5 * size);
        let core = |direction: DVec3| shape.support(direction);
        let searched = round_contact(&triangle, &core, radius, 100.0).expect("within the margin");
        assert!(contact.distance >= searched.distance - 1.0e-5 * size, "{searched:?} {}", says());
    } else {
        truth::check(&triangle, &shape, &contact, 1.0e-9 * size);
        // No farther: the check has proved the rest, even of a point on a segment, where brute force
        // finds no axis.
        let truth = shape.truth().distance(&triangle);
        assert!(truth - contact.distance <= 1.0e-9 * size, "{truth} {}", says());
    }
    Ok(())
}

fuzz_target!(|bytes: &[u8]| {
    // Too few bytes make no shapes.
    let _ = check_bytes(bytes);
});
