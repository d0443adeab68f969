//! Random triangles, sizes and rotations, and conditions that every contact must meet.

use crate::prelude::*;
use glamx::DVec4;
use proptest::prelude::*;
use sbbk_core::contact::{Feature, TriangleContact, contact};
use sbbk_truth::{self as truth, TruthContact};

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
pub fn check(t1: &Triangle, t2: &Triangle) -> TruthContact {
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
    let case = Case { triangles: [t1, t2], found, expected, size, tolerance };
    let fault = case.normal().or_else(|| case.points()).or_else(|| case.mirrored());
    assert_eq!(fault, None, "{}", context());
    expected
}

/// A contact of two triangles.
struct Case<'a> {
    triangles: [&'a Triangle; 2],
    found: TriangleContact,
    expected: TruthContact,
    size: f64,
    tolerance: f64,
}

impl Case<'_> {
    /// The normal must prove the distance: the shadows of the triangles are that far apart on it.
    fn normal(&self) -> Option<String> {
        let Self { triangles: [t1, t2], found, expected, size, tolerance } = *self;
        let off = (found.normal.length() - 1.0).abs();
        if off >= 1.0e-12 {
            return Some(format!("the length of the normal is off by {off:e}"));
        }
        let angle = found.normal.angle_between(expected.normal);
        if expected.normal_is_unique && angle.to_degrees() > NORMAL_TOLERANCE {
            return Some(format!("the normal is off by {} degrees", angle.to_degrees()));
        }
        let gap = truth::separation(t1, t2, found.normal);
        // The difference of two points is rounded: its direction is off by that over the distance.
        let is_close = found.distance <= 1.0e-12 * size;
        let tilt = if is_close { 0.0 } else { 3.0e-14 * size / found.distance };
        // Two points whose distances differ by rounding only may lie in directions that differ by
        // the root of it.
        let is_proved = gap >= found.distance - tolerance - tilt * size
            || !is_close && angle <= (1.0e-15 * size / found.distance).sqrt();
        (!is_proved).then(|| format!("the normal leaves {gap:e} only"))
    }

    fn points(&self) -> Option<String> {
        let Self { triangles: [t1, t2], found, size, tolerance, .. } = *self;
        let mismatch = (found.point2 - found.point1 - found.distance * found.normal).length();
        if mismatch > tolerance {
            return Some(format!("point2 - point1 is off by {mismatch:e}"));
        }
        // The end of a sliver is less certain than the distance. If axes tie at a tiny depth,
        // rounding may pick one whose point lies beside.
        let beside = 1.0e-6 * size + (-found.distance).clamp(0.0, 1.0e-6 * size);
        let mut sides = [
            (found.point1, t1, found.features.feature1()),
            (found.point2, t2, found.features.feature2()),
        ]
        .into_iter();
        sides.find_map(|(point, triangle, feature)| {
            let off = truth::contact(&[point; 3], &part(triangle, feature)).distance.abs();
            (off > tolerance + beside).then(|| format!("a point is off its {feature:?} by {off:e}"))
        })
    }

    fn mirrored(&self) -> Option<String> {
        let Self { triangles: [t1, t2], found, expected, tolerance, .. } = *self;
        let Some(mirrored) = contact(t2, t1, f64::INFINITY) else {
            return Some("none when swapped".into());
        };
        if (mirrored.distance - found.distance).abs() > tolerance {
            return Some(format!("distance {:e} when swapped", mirrored.distance));
        }
        let degrees = mirrored.normal.angle_between(-found.normal).to_degrees();
        let has_turned = expected.normal_is_unique && degrees > NORMAL_TOLERANCE;
        has_turned.then(|| format!("normal turns by {degrees} degrees when swapped"))
    }
}

/// A point in the cube from -1 to 1.
pub fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from_array)
}

/// Three points in the cube: of any shape, slivers included.
pub fn triangle() -> impl Strategy<Value = Triangle> {
    prop::array::uniform3(point())
}

/// From 10^low to 10^high, evenly over the decades, of either sign.
pub fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    ((low..high), any::<bool>())
        .prop_map(|(e, up)| if up { 10.0_f64.powf(e) } else { -10.0_f64.powf(e) })
}

pub fn rotation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0)
        .prop_map(DVec4::from_array)
        .prop_filter("too short to normalise", |v| v.length() > 0.1)
        .prop_map(|v| DQuat::from_vec4(v.normalize()))
}

/// A triangle in the plane z = 0, with an angle of at least a degree everywhere.
pub fn flat_triangle() -> impl Strategy<Value = Triangle> {
    triangle().prop_map(|t| t.map(|v| DVec3::new(v.x, v.y, 0.0))).prop_filter("a sliver", |t| {
        let size = size(t);
        (t[1] - t[0]).cross(t[2] - t[0]).length() > 0.02 * size * size
    })
}
