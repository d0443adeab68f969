use glamx::{DMat3, DQuat, DVec3, Pose3, Vec3};

use crate::simd::each;

/// A pose as a linear map in f64.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Placement {
    /// The linear part. Parry rotates a point `v` by a quaternion `q` as `q v q*`, which scales by
    /// `|q|²`. So does this map: the quaternion is not normalised.
    pub rotation: DMat3,
    /// The image of the origin.
    pub translation: DVec3,
    /// The inverse of the linear part; not finite if there is none.
    pub inverse: DMat3,
}

impl Placement {
    /// The map of `pose`, up to rounding of f64.
    ///
    /// With `q = (b, w)`: `q v q* = (w² - b²) v + 2 (b·v) b + 2 w b × v`, which is `|q|²` times a
    /// rotation, so the inverse is the transpose over `|q|⁴`.
    pub fn new(pose: &Pose3) -> Self {
        let DQuat { x, y, z, w } = pose.rotation.as_dquat();
        let (xx, yy, zz, ww) = (x * x, y * y, z * z, w * w);
        let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
        let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
        let rotation = DMat3::from_cols(
            DVec3::new(ww + xx - yy - zz, xy + wz, xz - wy),
            DVec3::new(xy - wz, ww + yy - xx - zz, yz + wx),
            DVec3::new(xz + wy, yz - wx, ww + zz - xx - yy),
        );
        let scale = xx + yy + zz + ww;
        Self {
            rotation,
            translation: pose.translation.as_dvec3(),
            inverse: rotation.transpose() * (1.0 / (scale * scale)),
        }
    }

    /// Returns true if no entry, nor one of the inverse, is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite() && self.inverse.is_finite()
    }

    /// The placement of frame 1 in frame 2.
    #[must_use]
    pub fn inverted(&self) -> Self {
        Self {
            rotation: self.inverse,
            translation: -(self.inverse * self.translation),
            inverse: self.rotation,
        }
    }

    /// The placement in frame 1 of a frame that is at `inner` in frame 2.
    #[must_use]
    pub fn of(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.rotation * inner.translation + self.translation,
            inverse: inner.inverse * self.inverse,
        }
    }

    /// `x`, a point of frame 2, in frame 1 and relative to `origin` there.
    #[inline]
    pub fn to_frame1(&self, x: Vec3, origin: Vec3) -> DVec3 {
        // Subtract the translations first: they cancel if two bodies touch far from the origin.
        self.rotation * x.as_dvec3() + (self.translation - origin.as_dvec3())
    }

    /// The inverse of [`to_frame1`](Self::to_frame1): `x`, a point of frame 1 relative to `origin`
    /// there, in frame 2.
    #[inline]
    pub fn to_frame2(&self, x: DVec3, origin: Vec3) -> DVec3 {
        self.inverse * (x - (self.translation - origin.as_dvec3()))
    }

    /// Returns how much longer a vector of frame 2 may be in frame 1, along one of its axes.
    pub(crate) fn scale(&self) -> f64 {
        longest_row(&self.rotation)
    }

    /// An upper bound of the motion of any point of a ball from an earlier placement.
    ///
    /// With `c` the ball's centre and `r` its radius, a point `x` in it moved by `(R' - R)(x - c) +
    /// (R' c + t') - (R c + t)`. This is at most `‖R' - R‖·r` plus the motion of the centre.
    ///
    /// The spectral norm is at most the Frobenius norm over √2. With `R = s·Q`, `R' = s'·Q'` and
    /// `θ` the angle from `Q` to `Q'`, `R' - R` has the singular values `|s'·exp(iθ) - s|` twice
    /// and `|s' - s|`, which is not larger. So the sum of squares is at least twice the largest.
    /// The last term covers f64 rounding, a few 1e-16 of the terms.
    pub fn motion_bound(&self, earlier: &Self, centre: Vec3, radius: f32) -> f64 {
        let (centre, radius) = (centre.as_dvec3(), f64::from(radius));
        let turn = self.rotation - earlier.rotation;
        let spectral = || {
            let axes = [turn.x_axis, turn.y_axis, turn.z_axis];
            let [x, y, z] = axes.map(DVec3::length_squared);
            (0.5 * (x + y + z)).sqrt()
        };
        let spin = if radius == 0.0 { 0.0 } else { spectral() * radius };
        let shift = turn * centre + (self.translation - earlier.translation);
        let magnitude = (centre.abs() + self.translation.abs()).element_sum() + radius;
        spin + shift.length() + 1e-14 * magnitude
    }
}

/// Length of the longest row of a matrix.
pub(super) fn longest_row(matrix: &DMat3) -> f64 {
    each(|i| matrix.row(i).length_squared()).into_iter().fold(0.0, f64::max).sqrt()
}
