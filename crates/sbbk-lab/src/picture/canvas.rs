//! The picture: what is drawn, sample by sample, and the file it is saved to.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use glamx::{Pose3, Vec2, Vec3};
use thiserror::Error;

use super::camera::{Camera, View};
use super::clip::{self, Vertex};
use super::raster;
use super::shade::{self, Ground, Sample};
use super::shadow::ShadowMap;
use crate::mesh::Mesh;

/// Red, green and blue in sRGB, as colour pickers give them.
pub type Colour = [u8; 3];

/// Samples a pixel along each side. Lower: jagged edges; higher: slower by the square.
pub(super) const SUPERSAMPLING: usize = 2;

/// Least cosine between a vertex normal and a face for the face to be shaded smoothly there:
/// lower rounds off edges that are meant to be sharp, higher shows the triangles of round things.
const SMOOTH_COSINE: f32 = 0.6;

/// Relative shift of segments towards the camera, so that those on a surface are seen whole.
const SEGMENT_LIFT: f32 = 1.0e-3;

/// A picture could not be written.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The file could not be created.
    #[error("cannot create the picture {}: {source}", path.display())]
    Create {
        /// The file asked for.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file was created, but writing the picture to it failed.
    #[error("cannot write the picture {}: {source}", path.display())]
    Write {
        /// The file asked for.
        path: PathBuf,
        /// What the encoder says.
        source: png::EncodingError,
    },
}

/// A picture being drawn; see the [module](super) for an example.
pub struct Picture {
    /// Width and height in samples.
    size: [usize; 2],
    view: View,
    shadow: ShadowMap,
    ground: Option<Ground>,
    samples: Vec<Sample>,
}

impl Picture {
    /// An empty picture of `width` by `height` pixels. Takes about 80 bytes a pixel.
    pub fn new(width: u32, height: u32, camera: Camera) -> Self {
        let size = [width, height].map(|length| length as usize * SUPERSAMPLING);
        let view = View::new(&camera, size);
        Self {
            size,
            shadow: ShadowMap::new(&view),
            view,
            ground: None,
            samples: vec![Sample::EMPTY; size[0] * size[1]],
        }
    }

    /// Adds an endless ground plane at this height, which hides what is below and takes shadows.
    pub fn with_ground(mut self, height: f32) -> Self {
        self.ground = Some(Ground { height });
        self
    }

    /// Draws a mesh at a pose; both sides of each triangle are seen.
    pub fn draw(&mut self, mesh: &Mesh, pose: Pose3, colour: Colour) {
        let transform = pose.to_mat4();
        let vertices: Vec<Vec3> =
            mesh.vertices.iter().map(|&v| transform.transform_point3(v)).collect();
        let faces: Vec<Vec3> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|i| vertices[i as usize]);
                (b - a).cross(c - a)
            })
            .collect();
        let normals = vertex_normals(mesh, &faces);
        for (triangle, face) in mesh.triangles.iter().zip(faces) {
            let first = vertices[triangle[0] as usize];
            // The side that is seen; without it, rims of smooth surfaces would turn dark.
            let side = 1f32.copysign((self.view.eye - first).dot(face));
            let face = face.normalize_or_zero();
            self.shadow.cast(triangle.map(|i| vertices[i as usize]));
            let corners = triangle.map(|i| Vertex {
                position: self.view.to_view(vertices[i as usize]),
                normal: side
                    * Some(normals[i as usize])
                        .filter(|normal| normal.dot(face) > SMOOTH_COSINE)
                        .unwrap_or(face),
            });
            self.fill(corners, colour);
        }
    }

    /// Draws an unlit line segment, `width` pixels wide, hidden by what is before it.
    pub fn segment(&mut self, from: Vec3, to: Vec3, width: f32, colour: Colour) {
        let [a, b] = [from, to].map(|point| self.view.to_view(point));
        let near = self.view.near;
        if a.z.max(b.z) < near {
            return;
        }
        let cut = |p: Vec3, q: Vec3| match p.z < near {
            true => p.lerp(q, (near - p.z) / (q.z - p.z)),
            false => p,
        };
        let ends = [cut(a, b), cut(b, a)];
        let [start, end] = ends.map(|p| self.view.project(p));
        let half_width = 0.5 * width * SUPERSAMPLING as f32;
        let along = (end - start).normalize_or(Vec2::X) * half_width;
        let across = along.perp();
        let rim = [
            start - along - across,
            end + along - across,
            end + along + across,
            start - along + across,
        ];
        let [d0, d1] = ends.map(|p| (1.0 + SEGMENT_LIFT) / p.z);
        let depths = [d0, d1, d1, d0];
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            let depths = Vec3::new(depths[i], depths[j], depths[k]);
            raster::fill([rim[i], rim[j], rim[k]], self.size, |index, weights| {
                let inverse_depth = weights.dot(depths);
                self.samples[index].cover(inverse_depth, Vec3::ZERO, colour);
            });
        }
    }

    /// Lights the picture and writes it as a PNG file, overwriting what was there.
    ///
    /// Errors: the file cannot be created or written, or the picture has no pixels.
    pub fn save(&self, path: &Path) -> Result<(), PictureError> {
        let file = File::create(path)
            .map_err(|source| PictureError::Create { path: path.to_owned(), source })?;
        let pixels = shade::resolve(
            &self.samples,
            self.size,
            &self.view,
            &self.shadow,
            self.ground.as_ref(),
        );
        let [width, height] = self.size.map(|length| (length / SUPERSAMPLING) as u32);
        let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder
            .write_header()
            .and_then(|mut writer| {
                writer.write_image_data(&pixels)?;
                writer.finish()
            })
            .map_err(|source| PictureError::Write { path: path.to_owned(), source })
    }

    /// Fills a triangle of view space, cut at the near plane, into the samples.
    fn fill(&mut self, triangle: [Vertex; 3], colour: Colour) {
        let polygon = clip::near(triangle, self.view.near);
        for second in 1..polygon.len().saturating_sub(1) {
            let corners = [0, second, second + 1].map(|i| polygon[i]);
            let positions = corners.map(|vertex| self.view.project(vertex.position));
            // Linear on the raster: one over depth, and anything of the surface times it.
            let depths = corners.map(|vertex| vertex.position.z.recip());
            let normals = [0, 1, 2].map(|i| corners[i].normal * depths[i]);
            let depths = Vec3::from_array(depths);
            raster::fill(positions, self.size, |index, weights| {
                let [u, v, w] = weights.to_array();
                let normal = normals[0] * u + normals[1] * v + normals[2] * w;
                self.samples[index].cover(weights.dot(depths), normal, colour);
            });
        }
    }
}

/// Unit normals of the vertices from the faces' normals, weighted by area.
fn vertex_normals(mesh: &Mesh, faces: &[Vec3]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; mesh.vertices.len()];
    for (triangle, face) in mesh.triangles.iter().zip(faces) {
        for &vertex in triangle {
            normals[vertex as usize] += *face;
        }
    }
    for normal in &mut normals {
        *normal = normal.normalize_or_zero();
    }
    normals
}
