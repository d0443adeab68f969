use crate::prelude::*;

/// A cube of edge length 1 in eight vertices.
pub fn cube() -> Soup {
    let vertices = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Soup { vertices: vertices.map(|v| v - 0.5).collect(), triangles: triangles.collect() }
}

/// A copy whose triangles have vertices of their own.
pub fn unwelded(mesh: &Soup) -> Soup {
    Soup::apart(mesh.triangles.iter().flatten().map(|&i| mesh.vertices[i as usize]))
}

/// All of some meshes.
pub fn together(meshes: impl IntoIterator<Item = Soup>) -> Soup {
    let mut all = Soup { vertices: Vec::new(), triangles: Vec::new() };
    for mesh in meshes {
        let first = all.vertices.len() as u32;
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| first + i)));
        all.vertices.extend(mesh.vertices);
    }
    all
}

pub fn mapped(mut mesh: Soup, map: impl Fn(Vec3) -> Vec3) -> Soup {
    mesh.vertices.iter_mut().for_each(|vertex| *vertex = map(*vertex));
    mesh
}

pub fn turned_inside_out(mut mesh: Soup) -> Soup {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    mesh
}

/// Two triangles a cell over the square from -1 to 1, at some heights.
pub fn sheet(cells: u32, height: impl Fn(f32, f32) -> f32) -> Soup {
    let at = |i: u32| 2.0 * i as f32 / cells as f32 - 1.0;
    let row = |i: u32| (0..=cells).map(move |j| [at(i), at(j)]);
    let vertices = (0..=cells).flat_map(row).map(|[x, y]| Vec3::new(x, y, height(x, y)));
    let cell = |i: u32, j: u32| {
        let [a, b] = [i * (cells + 1) + j, (i + 1) * (cells + 1) + j];
        [[a, b, b + 1], [a, b + 1, a + 1]]
    };
    let triangles = (0..cells).flat_map(|i| (0..cells).flat_map(move |j| cell(i, j)));
    Soup { vertices: vertices.collect(), triangles: triangles.collect() }
}

/// A profile of radii and heights, from below, turned around the z axis by `turn`. A whole turn
/// ends where it starts only up to roundings, if it is not `welded`.
pub fn lathe(profile: &[[f32; 2]], turn: f32, welded: bool) -> Soup {
    const SEGMENTS: u32 = 24;
    let columns = if welded { SEGMENTS } else { SEGMENTS + 1 };
    let rows = profile.len() as u32;
    let column = |i: u32| {
        let (sin, cos) = (turn * i as f32 / SEGMENTS as f32).sin_cos();
        profile.iter().map(move |&[radius, z]| Vec3::new(radius * cos, radius * sin, z))
    };
    let mut triangles = Vec::new();
    for (i, row) in (0..SEGMENTS).flat_map(|i| (0..rows - 1).map(move |row| (i, row))) {
        let at = |i: u32, row: u32| i % columns * rows + row;
        let [a, b, c, d] = [at(i, row), at(i + 1, row), at(i + 1, row + 1), at(i, row + 1)];
        let [low, high] = [profile[row as usize], profile[row as usize + 1]];
        if low[0] > 0.0 {
            triangles.push([a, b, c]);
        }
        if high[0] > 0.0 {
            triangles.push([a, c, d]);
        }
    }
    Soup { vertices: (0..columns).flat_map(column).collect(), triangles }
}

/// Half a circle, or a part of it, from the bottom on.
pub fn arc(share: f32) -> Vec<[f32; 2]> {
    let point = |i: u8| match i {
        0 => [0.0, -1.0],
        20 if share == 1.0 => [0.0, 1.0],
        _ => {
            let (sin, cos) = (share * PI * f32::from(i) / 20.0).sin_cos();
            [sin, -cos]
        }
    };
    (0..=20).map(point).collect()
}

pub fn ball() -> Soup {
    lathe(&arc(1.0), TAU, true)
}

/// A tube of radius 1, closed by a half ball below.
pub fn glove(length: f32) -> Soup {
    let straight = (1..=10).map(|i| [1.0, 0.1 * length * f32::from(i as u8)]);
    lathe(&arc(0.5).into_iter().chain(straight).collect::<Vec<_>>(), TAU, true)
}

/// A pot of radius 1 with a disc of a radius over its opening; upside down if that is negative.
pub fn with_lid(radius: f32, height: f32) -> Soup {
    let lid = lathe(&[[radius.abs(), 0.0], [0.0, 0.0]], TAU, true);
    let lid = if radius < 0.0 { turned_inside_out(lid) } else { lid };
    together([glove(1.0), mapped(lid, |v| v + Vec3::Z * (1.0 + height))])
}

/// A tube of radius 1, open at both ends.
pub fn tube(turn: f32, welded: bool) -> Soup {
    let profile: Vec<_> = (0..=20).map(|i: u8| [1.0, 0.3 * f32::from(i)]).collect();
    lathe(&profile, turn, welded)
}

pub fn torus() -> Soup {
    let circle = |i: u8| {
        let (sin, cos) = (TAU * f32::from(i % 16) / 16.0).sin_cos();
        [2.0 + 0.5 * cos, 0.5 * sin]
    };
    lathe(&(0..=16).map(circle).collect::<Vec<_>>(), TAU, true)
}

pub fn moebius() -> Soup {
    const SEGMENTS: u32 = 40;
    let point = |i: u32, side: f32| {
        let angle = TAU * i as f32 / SEGMENTS as f32;
        let (out, up) = ((0.5 * angle).cos(), (0.5 * angle).sin());
        let [sin, cos] = [angle.sin(), angle.cos()];
        let radius = 1.0 + side * out;
        Vec3::new(radius * cos, radius * sin, side * up)
    };
    let vertices = (0..SEGMENTS).flat_map(|i| [point(i, -0.3), point(i, 0.3)]).collect();
    let triangles = (0..SEGMENTS).flat_map(|i| {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 < SEGMENTS { [a + 2, b + 2] } else { [1, 0] };
        [[a, c, d], [a, d, b]]
    });
    Soup { vertices, triangles: triangles.collect() }
}

pub fn without(mut mesh: Soup, removed: &[usize]) -> Soup {
    let mut index = 0..;
    mesh.triangles.retain(|_| index.next().is_some_and(|index| !removed.contains(&index)));
    mesh
}

pub fn with_turned(mut mesh: Soup, triangle: usize) -> Soup {
    mesh.triangles[triangle].swap(0, 1);
    mesh
}
