//! Surfaces of shapes, in two resolutions.

use std::collections::HashMap;
use std::fmt;

use glamx::Vec3;
use rapier3d::geometry::{SharedShape, TypedShape};
use rapier3d::parry::shape::Shape;

use crate::backend::shape_address;

/// Triangles of the finer and the coarser resolution, about: finer, the page gets large; coarser
/// ones are for machines that cannot draw the finer ones fast enough.
const TRIANGLES: [usize; 2] = [20_000, 160];
/// Segments of round shapes.
const SEGMENTS: u32 = 16;

/// The different shapes of a run.
#[derive(Clone, Default)]
pub(super) struct Shapes {
    pub surfaces: Vec<Surface>,
    by_address: HashMap<usize, usize>,
    /// Keeps addresses from being those of others.
    kept: Vec<SharedShape>,
}

/// A surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    pub vertices: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl fmt::Debug for Shapes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.surfaces.fmt(f)
    }
}

impl Shapes {
    /// The index of a shape's surface.
    pub fn add(&mut self, shape: &SharedShape) -> usize {
        let address = shape_address(&**shape);
        if let Some(&index) = self.by_address.get(&address) {
            return index;
        }
        let index = self.add_surface(&**shape);
        self.by_address.insert(address, index);
        self.kept.push(shape.clone());
        index
    }

    /// The same, without keeping the shape.
    pub fn add_surface(&mut self, shape: &dyn Shape) -> usize {
        let surface = Surface::of(shape);
        let known = self.surfaces.iter().position(|other| *other == surface);
        known.unwrap_or_else(|| {
            self.surfaces.push(surface);
            self.surfaces.len() - 1
        })
    }
}

impl Surface {
    /// That of a shape; empty if it is of a kind that no scene has.
    fn of(shape: &dyn Shape) -> Self {
        let (vertices, triangles) = match shape.as_typed_shape() {
            TypedShape::TriMesh(mesh) => (mesh.vertices().to_vec(), mesh.indices().to_vec()),
            TypedShape::HeightField(field) => field.to_trimesh(),
            TypedShape::Ball(ball) => ball.to_trimesh(SEGMENTS, SEGMENTS),
            TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
            TypedShape::Capsule(capsule) => capsule.to_trimesh(SEGMENTS, SEGMENTS / 2),
            TypedShape::Cylinder(cylinder) => cylinder.to_trimesh(SEGMENTS),
            TypedShape::Cone(cone) => cone.to_trimesh(SEGMENTS),
            TypedShape::ConvexPolyhedron(hull) => hull.to_trimesh(),
            TypedShape::Compound(compound) => {
                let mut all = Self::default();
                for (pose, part) in compound.shapes() {
                    let part = Self::of(&**part);
                    let first = all.vertices.len() as u32;
                    all.vertices.extend(part.vertices.iter().map(|&vertex| *pose * vertex));
                    all.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + first)));
                }
                return all;
            }
            _ => return Self::default(),
        };
        Self { vertices, triangles }
    }

    /// The finer and the coarser resolution.
    pub fn levels(&self) -> [Self; 2] {
        TRIANGLES.map(|most| {
            // A surface crosses about as many cells as it has vertices, half as many as triangles.
            let mut cells = (most as f32).sqrt();
            let mut level = self.clone();
            while level.triangles.len() > most && cells > 2.0 {
                level = self.simplified(cells);
                cells *= 0.85;
            }
            level
        })
    }

    /// All vertices of a cell are one; of a grid with so many cells along its longest side.
    fn simplified(&self, cells: f32) -> Self {
        let least = self.vertices.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let most = self.vertices.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let side = (most - least).max_element() / cells;
        let mut places: HashMap<[i32; 3], u32> = HashMap::new();
        let mut merged: Vec<(Vec3, f32)> = Vec::new();
        let place = |&vertex: &Vec3| {
            let cell = ((vertex - least) / side).to_array().map(|k| k as i32);
            let place = *places.entry(cell).or_insert_with(|| {
                merged.push((Vec3::ZERO, 0.0));
                merged.len() as u32 - 1
            });
            merged[place as usize].0 += vertex;
            merged[place as usize].1 += 1.0;
            place
        };
        let places: Vec<u32> = self.vertices.iter().map(place).collect();
        let triangles = self.triangles.iter().map(|t| t.map(|vertex| places[vertex as usize]));
        let is_flat = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
        Self {
            triangles: triangles.filter(|triangle| !is_flat(triangle)).collect(),
            vertices: merged.into_iter().map(|(sum, count)| sum / count).collect(),
        }
    }

    /// Half the longest way through it.
    pub fn radius(&self) -> f32 {
        let least = self.vertices.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let most = self.vertices.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        0.5 * (most - least).length()
    }
}
