//! Meshes with the defects of meshes that people have.

use std::collections::BTreeSet;
use std::f32::consts::TAU;

use glamx::Vec3;
use oorandom::Rand32;

use super::Mesh;
use super::shapes::{box_faces, quad_grid};
use crate::scene::random::direction;

/// A floor about the origin in strips of other subdivision, with T-junctions between them.
pub fn strips(size: f32, count: u32, seed: u64) -> Mesh {
    let mut random = Rand32::new(seed);
    let edge = |index: u32| size * (index as f32 / count as f32 - 0.5);
    // Exact at both ends, so that the rims of neighbours agree.
    let between =
        |[low, high]: [u32; 2], share: f32| edge(low) * (1.0 - share) + edge(high) * share;
    let strips = (0..count).map(|index| {
        let [rows, columns] = [random.rand_range(3..40), random.rand_range(1..4)];
        quad_grid([rows, columns], |i, j| {
            let x = between([index, index + 1], j as f32 / columns as f32);
            Vec3::new(x, 0.0, between([0, count], i as f32 / rows as f32))
        })
    });
    Mesh::merged("strips", &strips.collect::<Vec<Mesh>>()).welded()
}

/// The mesh with corners of its own for each triangle, each moved by up to `most`.
pub fn unwelded(mesh: &Mesh, most: f32, seed: u64) -> Mesh {
    let mut random = Rand32::new(seed);
    let corners = (0..mesh.triangle_count()).flat_map(|index| mesh.corners(index));
    let vertices: Vec<Vec3> = corners
        .map(|corner| corner + direction(&mut random) * most * random.rand_float())
        .collect();
    let triangles = (0..mesh.triangle_count() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    Mesh::new(mesh.name.clone(), vertices, triangles.collect())
}

/// The mesh with each `nth` triangle twice.
pub fn doubled(mesh: &Mesh, nth: usize) -> Mesh {
    let times = |index: usize| if index.is_multiple_of(nth) { 2 } else { 1 };
    let triangles = mesh.triangles.iter().enumerate();
    let triangles = triangles.flat_map(|(index, &triangle)| vec![triangle; times(index)]);
    Mesh { triangles: triangles.collect(), ..mesh.clone() }
}

/// The mesh with slivers, which have no area up to rounding. On an edge of each second triangle
/// lies one with a corner of its own, one with two equal corners, or a point.
pub fn with_slivers(mesh: &Mesh, seed: u64) -> Mesh {
    let mut random = Rand32::new(seed);
    let mut dirty = mesh.clone();
    for corners in mesh.triangles.iter().step_by(2) {
        let edge = random.rand_range(0..3) as usize;
        let [a, b] = [corners[edge], corners[(edge + 1) % 3]];
        let middle = dirty.vertices.len() as u32;
        let [from, to] = [a, b].map(|end| mesh.vertices[end as usize]);
        dirty.vertices.push(from.lerp(to, random.rand_float()));
        let slivers = [[a, b, middle], [a, a, b], [middle; 3]];
        dirty.triangles.push(slivers[random.rand_range(0..3) as usize]);
    }
    dirty
}

/// The mesh with each triangle again, wound the other way.
pub fn two_sided(mesh: &Mesh) -> Mesh {
    let mut both = mesh.clone();
    both.triangles.extend(mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]));
    both
}

/// The mesh with triangles wound by chance.
pub fn random_winding(mesh: &Mesh, seed: u64) -> Mesh {
    let mut random = Rand32::new(seed);
    turned(mesh.clone(), |_| random.rand_range(0..2) == 1)
}

/// The mesh with the triangles within `reach` of a point wound the other way.
pub fn turned_near(mesh: &Mesh, point: Vec3, reach: f32) -> Mesh {
    let is_near = |index| mesh.corners(index).iter().all(|corner| corner.distance(point) < reach);
    turned(mesh.clone(), is_near)
}

/// A mesh whose triangles are wound the other way.
pub fn turned_inside_out(mesh: Mesh) -> Mesh {
    turned(mesh, |_| true)
}

/// The mesh with some triangles wound the other way, chosen by their indices in order.
fn turned(mut mesh: Mesh, mut is_turned: impl FnMut(usize) -> bool) -> Mesh {
    let triangles = mesh.triangles.iter_mut().enumerate();
    let chosen = triangles.filter(|(index, _)| is_turned(*index));
    chosen.for_each(|(_, triangle)| triangle.swap(1, 2));
    mesh
}

/// Closed boxes of 12 triangles side by side, `count` a side, with tops at height 0; not welded.
pub fn tiles(size: f32, count: u32, depth: f32) -> Mesh {
    let edge = |index: u32| size * (index as f32 / count as f32 - 0.5);
    let tile = |index: u32| {
        let [column, row] = [index % count, index / count];
        super::cuboid(Vec3::ONE, 1).mapped(|v| {
            let [x, z] = [(column, v.x), (row, v.z)].map(|(k, at)| edge(k + u32::from(at > 0.0)));
            Vec3::new(x, if v.y > 0.0 { 0.0 } else { -depth }, z)
        })
    };
    Mesh::merged("tiles", &(0..count * count).map(tile).collect::<Vec<Mesh>>())
}

/// A box about the origin whose faces have so many cells a side: +x, -x, +y, -y, +z, -z.
pub fn uneven_box(half_extents: Vec3, cells: [u32; 6]) -> Mesh {
    box_faces(half_extents, |face| [cells[face]; 2]).named("uneven box")
}

/// A ball of six faces with so many cells a side: +x, -x, +y, -y, +z, -z.
pub fn cube_ball(radius: f32, cells: [u32; 6]) -> Mesh {
    uneven_box(Vec3::ONE, cells).mapped(|v| v.normalize() * radius).named("cube ball")
}

/// The sheet, seen from above a rectangle, with walls down and a bottom of two triangles.
pub fn skirted(sheet: &Mesh, bottom: f32) -> Mesh {
    let edges_of = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let edges: BTreeSet<[u32; 2]> = sheet.triangles.iter().flat_map(edges_of).collect();
    let mut solid = sheet.clone();
    for &[a, b] in edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])) {
        let first = solid.vertices.len() as u32;
        solid.vertices.extend([a, b].map(|k| sheet.vertices[k as usize].with_y(bottom)));
        solid.triangles.extend([[b, a, first], [b, first, first + 1]]);
    }
    let bounds = sheet.bounds();
    let [low, high] = [bounds.mins, bounds.maxs];
    let first = solid.vertices.len() as u32;
    let corners = [(low.x, low.z), (high.x, low.z), (high.x, high.z), (low.x, high.z)];
    solid.vertices.extend(corners.map(|(x, z)| Vec3::new(x, bottom, z)));
    solid.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|k| first + k)));
    solid.welded().named("skirted")
}

/// A box with `2 * cells` cells a side, and a wall across its middle.
pub fn walled_box(half_extents: Vec3, cells: u32) -> Mesh {
    let solid = super::cuboid(half_extents, 2 * cells);
    let is_first_face = |corners: [Vec3; 3]| corners.iter().all(|v| v.x == half_extents.x);
    let wall = solid.clone().keeping(is_first_face).mapped(|v| v.with_x(0.0));
    Mesh::merged("walled box", &[solid, wall]).welded()
}

/// A tube about the `z` axis without ends, of `2 * segments` triangles.
pub fn tube(radius: f32, half_width: f32, segments: u32) -> Mesh {
    let tube = quad_grid([segments, 1], |i, j| {
        let (sin, cos) = (TAU * (i % segments) as f32 / segments as f32).sin_cos();
        Vec3::new(radius * cos, radius * sin, if j == 0 { -half_width } else { half_width })
    });
    tube.welded().named("tube")
}

/// A ball cut off at the height `top`, a share of its radius: a bowl, or a vase.
pub fn vessel(radius: f32, cells: u32, top: f32) -> Mesh {
    let is_below = |corners: [Vec3; 3]| corners.iter().all(|corner| corner.y < top * radius);
    cube_ball(radius, [cells; 6]).keeping(is_below).welded().named("vessel")
}
