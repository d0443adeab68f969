//! Three vectors side by side in SIMD lanes; the fourth lane repeats the first.

use glamx::DVec3;
use std::ops::Sub;
use wide::f64x4;

/// Mask of the lanes that count.
pub(super) const USED: u32 = 0b0111;

/// One vector a lane.
#[derive(Clone, Copy)]
pub(super) struct Lanes {
    x: f64x4,
    y: f64x4,
    z: f64x4,
}

impl Lanes {
    #[inline(always)]
    pub fn new(v: &[DVec3; 3]) -> Self {
        let [a, b, c] = *v;
        Self {
            x: f64x4::new([a.x, b.x, c.x, a.x]),
            y: f64x4::new([a.y, b.y, c.y, a.y]),
            z: f64x4::new([a.z, b.z, c.z, a.z]),
        }
    }

    #[inline(always)]
    pub fn splat(v: DVec3) -> Self {
        Self { x: f64x4::splat(v.x), y: f64x4::splat(v.y), z: f64x4::splat(v.z) }
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> f64x4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}
