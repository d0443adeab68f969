//! Light: from samples to pixels.

use glamx::{Vec2, Vec3};

use super::camera::View;
use super::canvas::{Colour, SUPERSAMPLING};
use super::shadow::ShadowMap;

/// Light of the sun, of the sky from above and of the ground from below, linear. Their sum on a
/// surface that faces the sun is near one, so that colours come out as given.
const SUN: Vec3 = Vec3::new(0.80, 0.77, 0.70);
const SKY: Vec3 = Vec3::new(0.30, 0.33, 0.38);
const BOUNCE: Vec3 = Vec3::new(0.13, 0.12, 0.11);

/// Background at the upper and lower edge, and the ground, in sRGB.
const BACKGROUND: [Colour; 2] = [[188, 203, 220], [240, 243, 246]];
const GROUND: Colour = [214, 216, 218];

/// Where the ground starts and has ended fading into the background, in distances from the eye
/// to the target.
const GROUND_FADE: [f32; 2] = [1.0, 3.5];

/// An endless plane across `y`.
pub(super) struct Ground {
    pub height: f32,
}

/// What is seen at one sample.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// One over `z` of view space; zero where nothing is.
    inverse_depth: f32,
    /// World space, of any length, on the side that is seen; zero for what is unlit.
    normal: Vec3,
    colour: Colour,
}

impl Sample {
    pub const EMPTY: Self = Self { inverse_depth: 0.0, normal: Vec3::ZERO, colour: [0; 3] };

    /// Shows a surface here if it is nearer than what was.
    pub fn cover(&mut self, inverse_depth: f32, normal: Vec3, colour: Colour) {
        if inverse_depth > self.inverse_depth {
            *self = Self { inverse_depth, normal, colour };
        }
    }
}

/// Lights all samples and averages those of each pixel: bytes of red, green and blue, by rows.
pub(super) fn resolve(
    samples: &[Sample],
    size: [usize; 2],
    view: &View,
    shadow: &ShadowMap,
    ground: Option<&Ground>,
) -> Vec<u8> {
    let lighting = Lighting {
        height: size[1] as f32,
        view,
        shadow,
        ground,
        linear: std::array::from_fn(|byte| (byte as f32 / 255.0).powf(2.2)),
    };
    let [width, height] = size.map(|length| length / SUPERSAMPLING);
    let mut bytes = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            let mut sum = Vec3::ZERO;
            for sub in 0..SUPERSAMPLING * SUPERSAMPLING {
                let column = x * SUPERSAMPLING + sub % SUPERSAMPLING;
                let row = y * SUPERSAMPLING + sub / SUPERSAMPLING;
                let position = Vec2::new(column as f32, row as f32) + 0.5;
                sum += lighting.colour(&samples[row * size[0] + column], position);
            }
            let mean = sum / (SUPERSAMPLING * SUPERSAMPLING) as f32;
            bytes.extend(mean.to_array().map(|c| (255.0 * c.powf(1.0 / 2.2)) as u8));
        }
    }
    bytes
}

struct Lighting<'a> {
    /// Height of the raster, in samples.
    height: f32,
    view: &'a View,
    shadow: &'a ShadowMap,
    ground: Option<&'a Ground>,
    /// Linear light of each byte of sRGB, taken as gamma 2.2.
    linear: [f32; 256],
}

impl Lighting<'_> {
    /// Linear colour of a sample at a raster position.
    fn colour(&self, sample: &Sample, position: Vec2) -> Vec3 {
        let ray = self.view.ray(position);
        let background = self.background(position);
        let drop = self.ground.map(|ground| ground.height - self.view.eye.y);
        let drop = drop.filter(|&drop| drop != 0.0);
        // One over the depth at which the ray meets the ground, if it does ahead.
        let ground_inverse_depth = drop.map_or(0.0, |drop| ray.y / drop);
        if ground_inverse_depth > sample.inverse_depth {
            self.ground_colour(ray, ground_inverse_depth.recip(), background)
        } else if sample.inverse_depth == 0.0 {
            background
        } else if sample.normal == Vec3::ZERO {
            self.linear(sample.colour)
        } else {
            let normal = sample.normal.normalize();
            let point = self.view.eye + ray / sample.inverse_depth;
            self.lit(point, normal, self.linear(sample.colour))
        }
    }

    fn ground_colour(&self, ray: Vec3, depth: f32, background: Vec3) -> Vec3 {
        let point = self.view.eye + ray * depth;
        let up = if ray.y < 0.0 { Vec3::Y } else { Vec3::NEG_Y };
        let lit = self.lit(point, up, self.linear(GROUND));
        let reach = self.view.eye.distance(self.view.target);
        let [start, end] = GROUND_FADE;
        let fade = (point.distance(self.view.target) / reach - start) / (end - start);
        lit.lerp(background, fade.clamp(0.0, 1.0))
    }

    fn lit(&self, point: Vec3, normal: Vec3, colour: Vec3) -> Vec3 {
        let facing = normal.dot(self.shadow.to_sun);
        let sun = if facing > 0.0 {
            SUN * (facing * self.shadow.light_at(point, normal))
        } else {
            Vec3::ZERO
        };
        let light = sun + BOUNCE.lerp(SKY, 0.5 + 0.5 * normal.y);
        (colour * light).min(Vec3::ONE)
    }

    fn background(&self, position: Vec2) -> Vec3 {
        let [top, bottom] = BACKGROUND.map(|colour| self.linear(colour));
        top.lerp(bottom, position.y / self.height)
    }

    fn linear(&self, colour: Colour) -> Vec3 {
        Vec3::from_array(colour.map(|byte| self.linear[byte as usize]))
    }
}
