//! Points for tests that want many and need no seed.

use glamx::Vec3;

/// Between 0 and 1.
fn noise(i: u32) -> f32 {
    ((i as f32 * 12.9898).sin() * 43758.547).fract().abs()
}

/// In the unit cube.
pub(super) fn point(i: u32) -> Vec3 {
    Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2))
}
