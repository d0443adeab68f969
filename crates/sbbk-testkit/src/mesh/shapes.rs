//! Grids and lofts, from which every procedural mesh is made, and simple shapes.

use std::f32::consts::TAU;

use glamx::{IVec3, Vec3};

use super::Mesh;

/// A ball about the origin of `8 * detail * detail` triangles (`detail` at least 1): an
/// octahedron with each edge cut into `detail` parts, blown up to `radius`.
pub fn ball(radius: f32, detail: u32) -> Mesh {
    octasphere(detail).scaled(radius).named("ball")
}

/// A torus about the `y` axis: a tube of radius `tube_radius` along a ring of radius
/// `ring_radius`, of `2 * ring_segments * tube_segments` triangles (at least 3 segments each).
pub fn torus(ring_radius: f32, tube_radius: f32, ring_segments: u32, tube_segments: u32) -> Mesh {
    let segments = [ring_segments.max(3), tube_segments.max(3)];
    let torus = quad_grid(segments, |i, j| {
        // The last row and column repeat the first exactly, so that welding closes the seams.
        let [(ring_sin, ring_cos), (tube_sin, tube_cos)] = [(i, segments[0]), (j, segments[1])]
            .map(|(k, count)| (TAU * (k % count) as f32 / count as f32).sin_cos());
        let distance = ring_radius + tube_radius * tube_cos;
        Vec3::new(distance * ring_cos, -tube_radius * tube_sin, distance * ring_sin)
    });
    torus.welded().named("torus")
}

/// A box about the origin with `cells * cells` quads a face: `12 * cells * cells` triangles
/// (`cells` at least 1).
pub fn cuboid(half_extents: Vec3, cells: u32) -> Mesh {
    slab(half_extents, [cells; 3])
}

/// A box about the origin, cut into so many cells along each axis (at least 1).
pub fn slab(half_extents: Vec3, cells: [u32; 3]) -> Mesh {
    box_faces(half_extents, |face| [1, 2].map(|next| cells[(face / 2 + next) % 3]))
}

/// A box about the origin whose faces +x, -x, +y, -y, +z, -z are cut into cells (at least 1). The
/// two numbers are those along the next axis and the one after it.
pub(super) fn box_faces(half_extents: Vec3, cells_of: impl Fn(usize) -> [u32; 2]) -> Mesh {
    // Both ends differ by the sign only, so that the rims of the faces weld.
    let coordinate = |k: u32, cells: u32| (2.0 * k as f32 - cells as f32) / cells as f32;
    let faces = [0, 1, 2, 3, 4, 5].map(|face| {
        let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
        let [second, third] = [1, 2].map(|next| (axis + next) % 3);
        let cells = cells_of(face).map(|cells| cells.max(1));
        quad_grid(cells, |i, j| {
            let mut point = Vec3::ZERO;
            point[axis] = sign;
            point[second] = sign * coordinate(i, cells[0]);
            point[third] = coordinate(j, cells[1]);
            point * half_extents
        })
    });
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

/// A square sheet of `cells * cells` quads about the origin, with the heights of [`hill_height`]:
/// what bodies of about a unit roll over. `2 * cells * cells` triangles (`cells` at least 1).
pub fn hills(size: f32, cells: u32) -> Mesh {
    sheet(size, cells, |x, z| hill_height(size, size * x, size * z)).named("hills")
}

/// Height of [`hills`] of this size over `(x, z)`, in units: smooth waves of 7 to 23 units, a unit
/// high and no steeper than 30 degrees, and a rim 3 units high that nothing rolls over.
pub fn hill_height(size: f32, x: f32, z: f32) -> f32 {
    let waves = 0.7 * (0.31 * x).sin() * (0.27 * z).cos() + 0.3 * (0.83 * x + 0.41 * z).sin();
    let beyond = x.abs().max(z.abs()) - (0.5 * size - RIM);
    waves + 2.0 * beyond.max(0.0)
}

/// Width of the rim of [`hills`], in units.
const RIM: f32 = 1.5;

/// A square sheet with heights over `(x, z)`, each within -0.5..0.5 of the side.
fn sheet(size: f32, cells: u32, height: impl Fn(f32, f32) -> f32) -> Mesh {
    let cells = cells.max(1);
    quad_grid([cells; 2], |i, j| {
        let [z, x] = [i, j].map(|k| k as f32 / cells as f32 - 0.5);
        Vec3::new(size * x, height(x, z), size * z)
    })
}

/// A grid of `cells[0] * cells[1]` quads, two triangles each, through `position(i, j)` for
/// `0 <= i <= cells[0]` and `0 <= j <= cells[1]`. Faces look along `d/di x d/dj`.
pub(super) fn quad_grid([columns, rows]: [u32; 2], position: impl Fn(u32, u32) -> Vec3) -> Mesh {
    let index = |i: u32, j: u32| i * (rows + 1) + j;
    let mut grid = Mesh::new("grid", Vec::new(), Vec::new());
    for i in 0..=columns {
        grid.vertices.extend((0..=rows).map(|j| position(i, j)));
    }
    for i in 0..columns {
        for j in 0..rows {
            let [a, b] = [index(i, j), index(i + 1, j + 1)];
            grid.triangles.extend([[a, index(i + 1, j), b], [a, b, index(i, j + 1)]]);
        }
    }
    grid
}

/// The unit sphere as an octahedron with each edge cut into `detail` parts (at least 1): closed,
/// `8 * detail * detail` triangles over `4 * detail * detail + 2` vertices, and mirrored exactly
/// in the three coordinate planes.
pub(super) fn octasphere(detail: u32) -> Mesh {
    let n = detail.max(1) as i32;
    let mut sphere = Mesh::new("octasphere", Vec::new(), Vec::new());
    for octant in 0..8 {
        let signs = IVec3::from_array([0, 1, 2].map(|axis| 1 - 2 * (octant >> axis & 1)));
        // An odd number of mirrorings turns the triangle round.
        let [b, c] = if signs.element_product() < 0 { [2, 1] } else { [1, 2] };
        let mut push = |corners: [[i32; 2]; 3]| {
            let first = sphere.vertices.len() as u32;
            let points = corners.map(|[i, j]| (signs * IVec3::new(i, j, n - i - j)).as_vec3());
            sphere.vertices.extend(points.map(Vec3::normalize));
            sphere.triangles.push([first, first + b, first + c]);
        };
        for i in 0..n {
            for j in 0..n - i {
                push([[i, j], [i + 1, j], [i, j + 1]]);
                if i + j + 1 < n {
                    push([[i + 1, j], [i + 1, j + 1], [i, j + 1]]);
                }
            }
        }
    }
    sphere.welded()
}

/// A cross section of a [`loft`]: an ellipse with two half axes.
#[derive(Clone, Copy)]
pub(super) struct Ring {
    pub centre: Vec3,
    pub half_axes: [Vec3; 2],
}

/// A closed solid through rings, each cut into `segments` parts, with flat ends. It faces outwards
/// when `half_axes[0] x half_axes[1]` points from each ring to the next.
pub(super) fn loft(rings: &[Ring], segments: u32) -> Mesh {
    let rim_point = |ring: &Ring, segment: u32| {
        let angle = TAU * (segment % segments) as f32 / segments as f32;
        let (sin, cos) = angle.sin_cos();
        ring.centre + ring.half_axes[0] * cos + ring.half_axes[1] * sin
    };
    let last = rings.len() as u32 + 1;
    let grid = quad_grid([segments, last], |i, j| match j {
        0 => rings[0].centre,
        j if j == last => rings[rings.len() - 1].centre,
        _ => rim_point(&rings[j as usize - 1], i),
    });
    // The first and the last row are one point each: half of their triangles have no area.
    without_needles(&grid)
}

/// The mesh welded, without triangles that have two corners in one place.
pub(super) fn without_needles(mesh: &Mesh) -> Mesh {
    let mut solid = mesh.welded();
    solid.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
    solid
}
