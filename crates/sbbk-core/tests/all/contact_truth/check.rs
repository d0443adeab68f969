//! Conditions that every contact must meet.

use glamx::DVec3;
use sbbk_core::contact::{Feature, TriangleContact, contact};
use sbbk_truth as truth;

/// Distances and depths may be off by this many triangle sizes.
pub const TOLERANCE: f64 = 1.0e-9;

/// Angle between normals, in degrees, where only one is right.
const NORMAL_TOLERANCE: f64 = 0.1;

pub type Triangle = [DVec3; 3];

pub fn size(t: &Triangle) -> f64 {
    (0..3).map(|i| t[i].distance(t[(i + 1) % 3])).fold(0.0, f64::max)
}

/// A part of a triangle, as a triangle that may be a segment or a point.
pub fn part(t: &Triangle, feature: Feature) -> Triangle {
    let vertex = |i: u8| t[usize::from(i) % 3];
    match feature {
        Feature::Vertex(i) => [vertex(i); 3],
        Feature::Edge(i) => [vertex(i), vertex(i), vertex(i + 1)],
        Feature::Face => *t,
    }
}

/// Checks the contact of two triangles against the truth and returns the truth.
pub fn check(t1: &Triangle, t2: &Triangle) -> truth::TruthContact {
    let size = size(t1).max(size(t2));
    let reach = t1.iter().chain(t2).map(|v| v.length()).fold(0.0, f64::max);
    let tolerance = TOLERANCE * size + 1.0e-15 * reach;
    let expected = truth::contact(t1, t2);
    let at = |margin| contact(t1, t2, margin);
    let within = at(expected.distance + tolerance);
    let context = || format!("{t1:?}\n{t2:?}\n{expected:?}\n{:?}", at(f64::INFINITY));
    let found = within.unwrap_or_else(|| panic!("missed inside the margin: {}", context()));
    let too_near = (expected.distance - tolerance).next_down();
    assert!(at(too_near).is_none(), "phantom beyond the margin: {}", context());

    let error = (found.distance - expected.distance).abs();
    assert!(error <= tolerance, "distance is off by {error:e}: {}", context());
    assert!((found.normal.length() - 1.0).abs() < 1.0e-12, "normal: {}", context());
    check_normal(t1, t2, &found, &expected, tolerance)
        .unwrap_or_else(|e| panic!("{e}: {}", context()));
    if expected.normal_is_unique {
        let degrees = found.normal.angle_between(expected.normal).to_degrees();
        assert!(degrees <= NORMAL_TOLERANCE, "normal is off by {degrees} degrees: {}", context());
    }
    check_points(t1, t2, &found, tolerance).unwrap_or_else(|e| panic!("{e}: {}", context()));
    check_mirrored(t1, t2, &found, tolerance, expected.normal_is_unique)
        .unwrap_or_else(|e| panic!("{e}: {}", context()));
    expected
}

/// The normal must prove the distance: the shadows of the triangles are that far apart on it.
fn check_normal(
    t1: &Triangle,
    t2: &Triangle,
    found: &TriangleContact,
    expected: &truth::TruthContact,
    tolerance: f64,
) -> Result<(), String> {
    let size = size(t1).max(size(t2));
    let gap = truth::separation(t1, t2, found.normal);
    // The difference of two points is rounded: its direction is off by that over the distance.
    let is_close = found.distance <= 1.0e-12 * size;
    let tilt = if is_close { 0.0 } else { 3.0e-14 * size / found.distance };
    if gap >= found.distance - tolerance - tilt * size {
        return Ok(());
    }
    // Two points whose distances differ by rounding only may lie in directions that differ by the
    // root of it.
    let angle = found.normal.angle_between(expected.normal);
    if !is_close && angle <= (1.0e-15 * size / found.distance).sqrt() {
        return Ok(());
    }
    Err(format!("the normal leaves {gap:e} only"))
}

fn check_points(
    t1: &Triangle,
    t2: &Triangle,
    found: &TriangleContact,
    tolerance: f64,
) -> Result<(), String> {
    let mismatch = (found.point2 - found.point1 - found.distance * found.normal).length();
    if mismatch > tolerance {
        return Err(format!("point2 - point1 is off by {mismatch:e}"));
    }
    // The end of a sliver is less certain than the distance. If axes tie at a tiny depth, rounding
    // may pick one whose point lies beside.
    let size = size(t1).max(size(t2));
    let beside = 1.0e-6 * size + (-found.distance).clamp(0.0, 1.0e-6 * size);
    let sides = [
        (found.point1, t1, found.features.feature1()),
        (found.point2, t2, found.features.feature2()),
    ];
    for (point, triangle, feature) in sides {
        let off = truth::contact(&[point; 3], &part(triangle, feature)).distance;
        if off.abs() > tolerance + beside {
            return Err(format!("a point is off its {feature:?} by {off:e}"));
        }
    }
    Ok(())
}

fn check_mirrored(
    t1: &Triangle,
    t2: &Triangle,
    found: &TriangleContact,
    tolerance: f64,
    is_unique: bool,
) -> Result<(), String> {
    let mirrored = contact(t2, t1, f64::INFINITY).ok_or("none when swapped")?;
    if (mirrored.distance - found.distance).abs() > tolerance {
        return Err(format!("distance {:e} when swapped", mirrored.distance));
    }
    let degrees = mirrored.normal.angle_between(-found.normal).to_degrees();
    if is_unique && degrees > NORMAL_TOLERANCE {
        return Err(format!("normal turns by {degrees} degrees when swapped"));
    }
    Ok(())
}
