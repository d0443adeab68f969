//! The camera, and how points get from the world to samples and back.

use glamx::{Vec2, Vec3};

/// Where a picture is taken from. Up in the picture is `y`, or `z` when looking along `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the camera.
    pub eye: Vec3,
    /// The point in the middle of the picture; its distance also sets how far shadows reach.
    pub target: Vec3,
    /// Angle between the upper and the lower edge of the picture, in radians.
    pub field_of_view: f32,
}

impl Camera {
    /// A camera at `eye` that looks at `target` with a field of view of 35 degrees.
    pub fn looking(eye: Vec3, target: Vec3) -> Self {
        Self { eye, target, field_of_view: 35f32.to_radians() }
    }
}

/// A camera set up for a raster. View space: `x` right, `y` up, `z` forwards, from the eye.
pub(super) struct View {
    pub eye: Vec3,
    pub target: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Least `z` drawn, as a small part of the distance to the target.
    pub near: f32,
    /// Samples a unit at distance one.
    focal: f32,
    /// The middle of the raster, in samples.
    centre: Vec2,
}

impl View {
    pub fn new(camera: &Camera, raster_size: [usize; 2]) -> Self {
        let [width, height] = raster_size.map(|length| length as f32);
        let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
        let right = forward.cross(Vec3::Y).try_normalize();
        let right = right.unwrap_or_else(|| forward.cross(Vec3::Z).normalize());
        Self {
            eye: camera.eye,
            target: camera.target,
            right,
            up: right.cross(forward),
            forward,
            near: 1.0e-3 * camera.eye.distance(camera.target).max(1.0e-3),
            focal: 0.5 * height / (0.5 * camera.field_of_view).tan(),
            centre: Vec2::new(0.5 * width, 0.5 * height),
        }
    }

    /// World to view space.
    pub fn to_view(&self, point: Vec3) -> Vec3 {
        let offset = point - self.eye;
        Vec3::new(offset.dot(self.right), offset.dot(self.up), offset.dot(self.forward))
    }

    /// View space (`z` above zero) to the raster, in samples.
    pub fn project(&self, point: Vec3) -> Vec2 {
        self.centre + self.focal / point.z * Vec2::new(point.x, -point.y)
    }

    /// World direction through a raster position, of length one along `forward`: times `z` of
    /// view space it leads from the eye to the point seen there.
    pub fn ray(&self, position: Vec2) -> Vec3 {
        let offset = (position - self.centre) / self.focal;
        self.forward + self.right * offset.x - self.up * offset.y
    }
}
