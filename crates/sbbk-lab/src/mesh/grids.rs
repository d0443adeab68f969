//! The grids that every procedural mesh starts from.

use std::f32::consts::TAU;

use glamx::{IVec3, Vec3};

use super::Mesh;

/// A grid of `cells[0] * cells[1]` quads, two triangles each, through `position(i, j)` for
/// `0 <= i <= cells[0]` and `0 <= j <= cells[1]`. Faces look along `d/di x d/dj`.
pub(super) fn quad_grid(cells: [u32; 2], position: impl Fn(u32, u32) -> Vec3) -> Mesh {
    let [columns, rows] = cells;
    let index = |i: u32, j: u32| i * (rows + 1) + j;
    let mut grid = Mesh::new("grid", Vec::new(), Vec::new());
    for i in 0..=columns {
        grid.vertices.extend((0..=rows).map(|j| position(i, j)));
    }
    for i in 0..columns {
        for j in 0..rows {
            let [a, b] = [index(i, j), index(i + 1, j + 1)];
            grid.triangles.push([a, index(i + 1, j), b]);
            grid.triangles.push([a, b, index(i, j + 1)]);
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
        let mut push = |corners: [[i32; 2]; 3]| {
            let first = sphere.vertices.len() as u32;
            let points = corners.map(|[i, j]| (signs * IVec3::new(i, j, n - i - j)).as_vec3());
            sphere.vertices.extend(points.map(Vec3::normalize));
            // An odd number of mirrorings turns the triangle round.
            let turned = signs.element_product() < 0;
            let [b, c] = if turned { [2, 1] } else { [1, 2] };
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
    let (first, last) = (0, rings.len() as u32 + 1);
    quad_grid([segments, last], |i, j| match j {
        j if j == first => rings[0].centre,
        j if j == last => rings[rings.len() - 1].centre,
        _ => rim_point(&rings[j as usize - 1], i),
    })
    .welded()
    .without_repeated_corners()
}
