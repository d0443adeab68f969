//! A small software renderer, for the pictures in the documentation and `--picture FILE`.
//!
//! [`Picture::draw`] fills triangles into a buffer of samples and into a shadow map;
//! [`Picture::save`] lights each sample once, averages those of each pixel and writes a PNG file.
//! Memory does not grow with what is drawn.
//!
//! ```no_run
//! use glamx::{Pose3, Vec3};
//! use sbbk_lab::{mesh, picture::{Camera, Picture}};
//!
//! let camera = Camera { eye: Vec3::new(2.0, 2.0, 5.0), target: Vec3::ZERO };
//! let mut picture = Picture::new(1280, 720, camera).with_ground(-1.0);
//! picture.draw(&mesh::monkey_head(), &Pose3::IDENTITY, [214, 160, 96]);
//! picture.save("head.png".as_ref())?;
//! # Ok::<(), sbbk_lab::picture::PictureError>(())
//! ```

mod portrait;
mod raster;

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use glamx::camera::rh::proj::directx::perspective_infinite_reverse;
use glamx::camera::rh::view::look_at_mat4;
use glamx::{Mat3, Mat4, Pose3, Vec3};
use thiserror::Error;

use crate::mesh::{self, Mesh};
use raster::Raster;

/// Red, green and blue in sRGB, as colour pickers give them.
pub type Colour = [u8; 3];

/// Samples a pixel along each side. Lower: jagged edges; higher: slower by the square.
const SUPERSAMPLING: usize = 2;
/// Side of the shadow map in texels. Lower: blocky shadows; higher: slower.
const SHADOW_SIDE: usize = 2048;
/// Angle between the upper and the lower edge of the picture, in degrees.
const FIELD_OF_VIEW: f32 = 35.0;
/// Least cosine between a vertex normal and a face for the face to be shaded smoothly there:
/// lower rounds off edges that are meant to be sharp, higher shows the triangles of round things.
const SMOOTH_COSINE: f32 = 0.6;

/// Light of the sun, of the sky from above and of the ground from below, linear. Their sum on a
/// surface that faces the sun is near one, so that colours come out as given.
const SUN: Vec3 = Vec3::new(0.80, 0.77, 0.70);
const SKY: Vec3 = Vec3::new(0.30, 0.33, 0.38);
const BOUNCE: Vec3 = Vec3::new(0.13, 0.12, 0.11);
/// Background at the upper and lower edge, and the ground.
const BACKGROUND: [Colour; 2] = [[188, 203, 220], [240, 243, 246]];
const GROUND: Colour = [214, 216, 218];
/// Where things start and have ended fading into the background: their distance from the target,
/// in distances from the eye to the target.
const FADE: [f32; 2] = [1.0, 3.5];
/// Cells along each side of the ground. Fewer: those that reach behind the eye, which are left
/// out, come into the picture.
const GROUND_CELLS: u32 = 96;

/// A picture could not be written; the message names the file.
#[derive(Debug, Error)]
#[error("cannot write the picture {}: {source}", path.display())]
pub struct PictureError {
    path: PathBuf,
    source: png::EncodingError,
}

/// Where a picture is taken from. Up in the picture is `y`; the view must not be along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the camera.
    pub eye: Vec3,
    /// The point in the middle of the picture. Shadows reach as far around it as the eye is away.
    pub target: Vec3,
}

/// What is seen at one sample.
#[derive(Clone, Copy, Default)]
struct Sample {
    point: Vec3,
    /// Of any length, on the side that is seen; zero where nothing is.
    normal: Vec3,
    colour: Colour,
}

/// A picture being drawn; see the [module](self) for an example.
pub struct Picture {
    camera: Camera,
    raster: Raster,
    samples: Vec<Sample>,
    /// Unit vector towards the sun.
    to_sun: Vec3,
    /// As seen from the sun, in texels along all axes.
    shadows: Raster,
    /// World units a texel.
    texel: f32,
}

impl Picture {
    /// An empty picture of `width` by `height` pixels.
    pub fn new(width: u32, height: u32, camera: Camera) -> Self {
        let size = [width, height].map(|length| length as usize * SUPERSAMPLING);
        let [columns, rows] = size.map(|length| length as f32);
        let Camera { eye, target } = camera;
        let reach = eye.distance(target);
        let to_samples = Mat4::from_scale(Vec3::new(0.5 * columns, -0.5 * rows, 1.0))
            * Mat4::from_translation(Vec3::new(1.0, -1.0, 0.0));
        let angle = FIELD_OF_VIEW.to_radians();
        let lens = perspective_infinite_reverse(angle, columns / rows, 1e-3 * reach);
        let view = look_at_mat4(eye, target, Vec3::Y);

        // The sun stands behind the camera's left shoulder: what is seen is lit from the side.
        let forward = (target - eye).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let to_sun = (Vec3::Y - 0.5 * right - 0.9 * forward).normalize();
        let texel = 2.0 * reach / SHADOW_SIDE as f32;
        let half = 0.5 * SHADOW_SIDE as f32;
        let to_texels = Mat4::from_translation(Vec3::new(half, half, 0.0))
            * Mat4::from_scale(Vec3::splat(1.0 / texel));
        let sun_view = look_at_mat4(target, target - to_sun, right);
        Self {
            camera,
            samples: vec![Sample::default(); size[0] * size[1]],
            raster: Raster::new(size, to_samples * lens * view),
            to_sun,
            shadows: Raster::new([SHADOW_SIDE; 2], to_texels * sun_view),
            texel,
        }
    }

    /// Adds a ground plane at this height, as wide as can be seen before it fades away.
    pub fn with_ground(mut self, height: f32) -> Self {
        let Camera { eye, target } = self.camera;
        let ground = mesh::floor(2.0 * FADE[1] * eye.distance(target), GROUND_CELLS);
        let pose = Pose3::from_translation(target.with_y(height));
        self.draw(&ground, &pose, GROUND);
        self
    }

    /// Draws a mesh at a pose. Both sides of each triangle are seen; those that reach behind the
    /// eye are left out.
    pub fn draw(&mut self, mesh: &Mesh, pose: &Pose3, colour: Colour) {
        let mesh = mesh.clone().posed(pose);
        let mut vertex_normals = vec![Vec3::ZERO; mesh.vertex_count()];
        let face_normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let face = face_normal(mesh.corners(index));
            triangle.iter().for_each(|&vertex| vertex_normals[vertex as usize] += face);
        }
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let corners = mesh.corners(index);
            let face = face_normal(corners).normalize_or_zero();
            // The side that is seen; without it, rims of smooth surfaces would turn dark.
            let side = 1f32.copysign((self.camera.eye - corners[0]).dot(face));
            let normals = triangle.map(|vertex| {
                let smooth = vertex_normals[vertex as usize].normalize_or_zero();
                side * if smooth.dot(face) > SMOOTH_COSINE { smooth } else { face }
            });
            let [points, normals] = [corners, normals].map(|[a, b, c]| Mat3::from_cols(a, b, c));
            self.shadows.fill(corners, |_, _| ());
            self.raster.fill(corners, |sample, weights| {
                self.samples[sample] =
                    Sample { point: points * weights, normal: normals * weights, colour };
            });
        }
    }

    /// Lights the picture and writes it as a PNG file, overwriting what was there.
    ///
    /// Errors: the file cannot be created or written, or the picture has no pixels.
    pub fn save(&self, path: &Path) -> Result<(), PictureError> {
        let write = || {
            let [width, height] = self.raster.size.map(|length| (length / SUPERSAMPLING) as u32);
            let file = BufWriter::new(File::create(path)?);
            let mut encoder = png::Encoder::new(file, width, height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.pixels())?;
            writer.finish()
        };
        write().map_err(|source| PictureError { path: path.to_owned(), source })
    }

    /// The mean light of the samples of each pixel: bytes of red, green and blue, by rows.
    fn pixels(&self) -> Vec<u8> {
        let [columns, rows] = self.raster.size;
        let [width, height] = [columns / SUPERSAMPLING, rows / SUPERSAMPLING];
        let [top, bottom] = BACKGROUND.map(linear);
        let mut light = vec![Vec3::ZERO; width * height];
        for (index, sample) in self.samples.iter().enumerate() {
            let [x, y] = [index % columns, index / columns];
            let background = top.lerp(bottom, y as f32 / rows as f32);
            let pixel = y / SUPERSAMPLING * width + x / SUPERSAMPLING;
            light[pixel] += self.lit(sample, background);
        }
        let share = 1.0 / (SUPERSAMPLING * SUPERSAMPLING) as f32;
        let encoded = |light: f32| (255.0 * (share * light).powf(1.0 / GAMMA)) as u8;
        light.into_iter().flat_map(|light| light.to_array().map(encoded)).collect()
    }

    /// The linear colour of a sample.
    fn lit(&self, sample: &Sample, background: Vec3) -> Vec3 {
        let Some(normal) = sample.normal.try_normalize() else { return background };
        let facing = normal.dot(self.to_sun);
        let sun = if facing > 0.0 { facing * self.sunlight(sample.point, normal) } else { 0.0 };
        let light = SUN * sun + BOUNCE.lerp(SKY, 0.5 + 0.5 * normal.y);
        let Camera { eye, target } = self.camera;
        let distance = sample.point.distance(target) / eye.distance(target);
        let fade = (distance - FADE[0]) / (FADE[1] - FADE[0]);
        (linear(sample.colour) * light).min(Vec3::ONE).lerp(background, fade.clamp(0.0, 1.0))
    }

    /// Share of the sunlight that reaches a point on a surface, by the mean over nine texels.
    fn sunlight(&self, point: Vec3, normal: Vec3) -> f32 {
        // Lifted off its own surface by these texels, or it would shade itself in stripes.
        let lifted = point + 2.0 * self.texel * normal;
        let place = self.shadows.matrix.transform_point3(lifted);
        let lit = (0..9).filter(|texel| {
            let [x, y] = [place.x as isize + texel % 3 - 1, place.y as isize + texel / 3 - 1];
            let is_inside = [x, y].iter().all(|k| (0..SHADOW_SIDE as isize).contains(k));
            let is_shaded = || self.shadows.depths[y as usize * SHADOW_SIDE + x as usize] > place.z;
            !(is_inside && is_shaded())
        });
        lit.count() as f32 / 9.0
    }
}

/// Exponent of sRGB, nearly.
const GAMMA: f32 = 2.2;

fn linear(colour: Colour) -> Vec3 {
    Vec3::from_array(colour.map(|channel| (f32::from(channel) / 255.0).powf(GAMMA)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [64, 48];
    const RED: Colour = [220, 20, 20];
    const BLUE: Colour = [20, 20, 220];

    fn picture(eye: Vec3) -> Picture {
        let [width, height] = SIZE.map(|length| length as u32);
        Picture::new(width, height, Camera { eye, target: Vec3::ZERO })
    }

    /// Position in pixels and strongest channel of what is not background or ground.
    fn coloured(picture: &Picture) -> Vec<([usize; 2], usize)> {
        let pixels = picture.pixels();
        let pixels = pixels.chunks(3).enumerate().filter_map(|(index, pixel)| {
            let channel = (0..3).max_by_key(|&channel| pixel[channel])?;
            let weakest = *pixel.iter().min()?;
            let position = [index % SIZE[0], index / SIZE[0]];
            (pixel[channel] / 2 > weakest).then_some((position, channel))
        });
        pixels.collect()
    }

    /// Would catch a mirrored or upside-down picture, and a depth test that goes by the order of
    /// drawing or the wrong way round.
    #[test]
    fn things_are_where_they_should_be() {
        let ball = mesh::ball(0.2, 4);
        for order in [[0, 1], [1, 0]] {
            let mut picture = picture(Vec3::Z * 5.0).with_ground(-0.5);
            for index in order {
                let (place, colour) =
                    [(Vec3::new(1.0, 0.5, 0.0), RED), (Vec3::new(0.9, 0.45, 0.5), BLUE)][index];
                picture.draw(&ball, &Pose3::from_translation(place), colour);
            }
            picture.draw(&ball, &Pose3::from_translation(Vec3::NEG_Y), RED);
            let seen = coloured(&picture);
            assert!(seen.len() > 15, "{seen:?}");
            for ([x, y], channel) in seen {
                assert!(x > SIZE[0] / 2 + 4 && y < SIZE[1] / 2, "{channel} at {x} {y}");
                assert_eq!(channel, 2, "red is behind blue or below the ground");
            }
        }
    }

    /// Would catch a lost shadow, one cast upwards, and a ground that shades itself.
    #[test]
    fn shadows_fall_on_the_ground() {
        let middle =
            |picture: &Picture| picture.pixels()[3 * (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2)];
        let mut picture = picture(Vec3::new(0.0, 8.0, 8.0)).with_ground(0.0);
        let bright = middle(&picture);
        assert!(bright > 180, "{bright}");
        let roof = mesh::cuboid(Vec3::new(1.0, 0.05, 1.0), 1);
        picture.draw(&roof, &Pose3::translation(-1.0, 2.5, 1.8), RED);
        let dark = middle(&picture);
        assert!(u32::from(dark) * 4 < u32::from(bright) * 3, "{dark} of {bright}");
    }

    #[test]
    fn unwritable_pictures_name_the_file() {
        let path = Path::new("no/such/folder/picture.png");
        let message = picture(Vec3::Z).save(path).unwrap_err().to_string();
        assert!(message.contains("no/such/folder/picture.png"), "{message}");
    }
}
