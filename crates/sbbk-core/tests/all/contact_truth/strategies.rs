//! Random triangles, sizes and rotations.

use super::check::Triangle;
use crate::prelude::*;
use glamx::DVec4;
use proptest::prelude::*;

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
        let size = super::check::size(t);
        (t[1] - t[0]).cross(t[2] - t[0]).length() > 0.02 * size * size
    })
}
