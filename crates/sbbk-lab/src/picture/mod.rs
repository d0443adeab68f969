//! A small software renderer, for the pictures in the documentation and `--picture FILE`.
//!
//! No window, no GPU: [`Picture::draw`] fills triangles into a buffer of samples (depth, normal,
//! colour) and into a shadow map, and [`Picture::save`] lights each sample once, averages the
//! samples of each pixel and writes a PNG file. Memory does not grow with what is drawn, so that
//! thousands of meshes are no trouble.
//!
//! ```no_run
//! use glamx::{Pose3, Vec3};
//! use sbbk_lab::{mesh, picture::{Camera, Picture}};
//!
//! let camera = Camera::looking(Vec3::new(2.0, 2.0, 5.0), Vec3::ZERO);
//! let mut picture = Picture::new(1280, 720, camera).with_ground(-1.0);
//! picture.draw(&mesh::monkey_head(), Pose3::IDENTITY, [214, 160, 96]);
//! picture.save("head.png".as_ref())?;
//! # Ok::<(), sbbk_lab::picture::PictureError>(())
//! ```

mod camera;
mod canvas;
mod clip;
mod raster;
mod shade;
mod shadow;
#[cfg(test)]
mod tests;

pub use camera::Camera;
pub use canvas::{Colour, Picture, PictureError};
