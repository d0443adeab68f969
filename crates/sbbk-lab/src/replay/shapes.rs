//! Surfaces of shapes, in two resolutions.

use crate::prelude::*;

use rapier3d::geometry::TypedShape;
use rapier3d::parry::shape::Shape;

/// Triangles of the fine and the coarse resolution, which slow machines draw. Higher: larger pages;
/// lower: rougher shapes.
const TRIANGLES: [usize; 2] = [20_000, 160];
/// Segments of round shapes.
const SEGMENTS: u32 = 16;

/// The surface of a shape; empty if it is of a kind that no scene has.
pub(super) fn surface(shape: &dyn Shape) -> Mesh {
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
            let parts = compound.shapes().iter().map(|(pose, part)| surface(&**part).posed(pose));
            return Mesh::merged("", &parts.collect::<Vec<Mesh>>());
        }
        _ => (Vec::new(), Vec::new()),
    };
    Mesh::new("", vertices, triangles)
}

/// The finer and the coarser resolution of a surface.
pub(super) fn levels(surface: &Mesh) -> [Mesh; 2] {
    TRIANGLES.map(|most| {
        // A surface crosses about as many cells as it has vertices, half as many as triangles.
        let mut cells = (most as f32).sqrt();
        let mut level = surface.clone();
        while level.triangles.len() > most && cells > 2.0 {
            level = simplified(surface, cells);
            cells *= 0.85;
        }
        level
    })
}

/// All vertices of a cell are one; of a grid with so many cells along its longest side.
fn simplified(surface: &Mesh, cells: f32) -> Mesh {
    let bounds = surface.bounds();
    let side = bounds.extents().max_element() / cells;
    let mut places: HashMap<[i32; 3], u32> = HashMap::new();
    let mut merged: Vec<(Vec3, f32)> = Vec::new();
    let place = |&vertex: &Vec3| {
        let cell = ((vertex - bounds.mins) / side).to_array().map(|k| k as i32);
        let place = *places.entry(cell).or_insert_with(|| {
            merged.push((Vec3::ZERO, 0.0));
            merged.len() as u32 - 1
        });
        merged[place as usize].0 += vertex;
        merged[place as usize].1 += 1.0;
        place
    };
    let places: Vec<u32> = surface.vertices.iter().map(place).collect();
    let triangles = surface.triangles.iter().map(|t| t.map(|vertex| places[vertex as usize]));
    let is_flat = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    let triangles = triangles.filter(|triangle| !is_flat(triangle)).collect();
    Mesh::new("", merged.into_iter().map(|(sum, count)| sum / count).collect(), triangles)
}
