//! Simple shapes for tests, benchmarks and scenery: ball, torus, box, floor, terrain.

use std::f32::consts::TAU;

use glamx::Vec3;

use super::Mesh;
use super::grids::{octasphere, quad_grid};

/// A ball about the origin of `8 * detail * detail` triangles (`detail` at least 1): an
/// octahedron with each edge cut into `detail` parts, blown up to `radius`.
pub fn ball(radius: f32, detail: u32) -> Mesh {
    octasphere(detail).scaled(radius).named("ball")
}

/// A torus about the `y` axis: a tube of radius `tube_radius` along a ring of radius
/// `ring_radius`, of `2 * ring_segments * tube_segments` triangles (at least 3 segments each).
pub fn torus(ring_radius: f32, tube_radius: f32, ring_segments: u32, tube_segments: u32) -> Mesh {
    let segments = [ring_segments.max(3), tube_segments.max(3)];
    quad_grid(segments, |i, j| {
        // The last row and column repeat the first exactly, so that welding closes the seams.
        let [(ring_sin, ring_cos), (tube_sin, tube_cos)] = [(i, segments[0]), (j, segments[1])]
            .map(|(k, count)| (TAU * (k % count) as f32 / count as f32).sin_cos());
        let distance = ring_radius + tube_radius * tube_cos;
        Vec3::new(distance * ring_cos, -tube_radius * tube_sin, distance * ring_sin)
    })
    .welded()
    .named("torus")
}

/// A box about the origin with `cells * cells` quads a face: `12 * cells * cells` triangles
/// (`cells` at least 1).
pub fn cuboid(half_extents: Vec3, cells: u32) -> Mesh {
    let cells = cells.max(1);
    // The same but for the sign at both ends, so that the rims of the faces weld.
    let coordinate = |k: u32| (2.0 * k as f32 - cells as f32) / cells as f32;
    let faces: Vec<Mesh> = (0..6)
        .map(|face| {
            let axis = face / 2;
            let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
            quad_grid([cells; 2], |i, j| {
                let mut point = Vec3::ZERO;
                point[axis] = sign;
                point[(axis + 1) % 3] = sign * coordinate(i);
                point[(axis + 2) % 3] = coordinate(j);
                point * half_extents
            })
        })
        .collect();
    Mesh::merged("cuboid", &faces).welded()
}

/// A square sheet of `cells * cells` quads in the plane `y = 0` about the origin, sides of length
/// `size`, facing up: `2 * cells * cells` triangles (`cells` at least 1). Not closed.
pub fn floor(size: f32, cells: u32) -> Mesh {
    sheet(size, cells, |_, _| 0.0).named("floor")
}

/// [`floor`] with rolling bumps between `-height` and `height`.
pub fn terrain(size: f32, cells: u32, height: f32) -> Mesh {
    // Three wave lengths that do not divide each other, so that no two hills are alike.
    let bumps = |x: f32, z: f32| {
        0.5 * (7.0 * x).sin() * (6.0 * z).cos()
            + 0.3 * (17.0 * x + 5.0 * z).sin()
            + 0.2 * (29.0 * z - 11.0 * x).cos()
    };
    sheet(size, cells, |x, z| height * bumps(x, z)).named("terrain")
}

/// A square sheet with heights over `(x, z)`, each within -0.5..0.5 of the side.
fn sheet(size: f32, cells: u32, height: impl Fn(f32, f32) -> f32) -> Mesh {
    let cells = cells.max(1);
    let coordinate = |k: u32| k as f32 / cells as f32 - 0.5;
    quad_grid([cells; 2], |i, j| {
        let [z, x] = [i, j].map(coordinate);
        Vec3::new(size * x, height(x, z), size * z)
    })
}
