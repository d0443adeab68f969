//! Neighbours, sides and kinds of surfaces, by definitions that look at everything.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};
use glamx::{DVec3, Quat, Vec3};
use sbbk_core::contact::Feature;
use sbbk_core::surface::{Around, Facets, Side, SurfaceKind};

use SurfaceKind::{InsideOut, Sheet, Solid};

/// The corners of a half-edge's triangle, from its start on.
fn corners(Soup { vertices, triangles }: &Soup, half_edge: usize) -> [Vec3; 3] {
    [0, 1, 2].map(|i| vertices[triangles[half_edge / 3][(half_edge + i) % 3] as usize])
}

/// The half-edge before another one of the same triangle.
fn before(half_edge: usize) -> usize {
    3 * (half_edge / 3) + (half_edge + 2) % 3
}

/// The twin of each half-edge by definition: the only half-edge from its end to its start, if no
/// other runs from start to end.
fn brute_twins(mesh: &Soup) -> Vec<Option<u32>> {
    let count = 3 * mesh.triangles.len();
    let along = |from: Vec3, to: Vec3| -> Vec<u32> {
        let is_along = |&half_edge: &u32| corners(mesh, half_edge as usize)[..2] == [from, to];
        (0..count as u32).filter(is_along).collect()
    };
    (0..count)
        .map(|half_edge| {
            let [start, end, _] = corners(mesh, half_edge);
            match (&along(start, end)[..], &along(end, start)[..]) {
                ([_], &[twin]) if start != end => Some(twin),
                _ => None,
            }
        })
        .collect()
}

/// Panics unless all twins are right; how many half-edges have one.
fn check_twins(mesh: &Soup) -> usize {
    let surface = mesh.surface();
    let expected = brute_twins(mesh);
    let found: Vec<Option<u32>> =
        (0..expected.len()).map(|half_edge| surface.twin(half_edge as u32)).collect();
    assert_eq!(found, expected, "{mesh:?}");
    expected.iter().flatten().count()
}

/// A copy in which a third of the corners have vertices of their own at the same places.
fn with_copies(mesh: &Soup, random: &mut Random) -> Soup {
    let Soup { mut vertices, mut triangles } = mesh.clone();
    for index in triangles.iter_mut().flatten() {
        if random.bits().is_multiple_of(3) {
            // Minus zero is at the same place.
            let place = vertices[*index as usize];
            *index = vertices.len() as u32;
            vertices.push(Vec3::select(place.cmpeq(Vec3::ZERO), -place, place));
        }
    }
    Soup { vertices, triangles }
}

#[test]
fn twins_agree_with_a_search_of_all_half_edges() {
    let mut random = Random(41);
    let mut count = 0;
    for i in 0..400 {
        let mesh = match i % 4 {
            0 => lattice_soup(&mut random, 1 + i / 8, 1),
            1 => lattice_soup(&mut random, 1 + i / 4, 2),
            2 => soup(&mut random, 10, 0.5),
            _ => bumpy_ball(2 + i % 4, 0.1),
        };
        count += check_twins(&mesh);
        count += check_twins(&with_copies(&mesh, &mut random));
    }
    assert!(count > 5_000, "{count} twins");
}

/// Bounds of the sine by which a neighbour may rise and still count as no nearer.
const RISES: [f64; 2] = [0.04, 0.06];

/// Half-edges at a feature, one for each triangle of its one-ring. A vertex has all triangles that
/// are connected by edges at the vertex.
fn triangles_around(
    mesh: &Soup,
    twins: &[Option<u32>],
    triangle: u32,
    feature: Feature,
) -> Vec<usize> {
    let (Feature::Edge(i) | Feature::Vertex(i)) = feature else {
        return vec![3 * triangle as usize];
    };
    let own = 3 * triangle as usize + usize::from(i);
    let twin = |half_edge: usize| twins[half_edge].map(|twin| twin as usize);
    if let Feature::Edge(_) = feature {
        return [Some(own), twin(own)].into_iter().flatten().collect();
    }
    let place = corners(mesh, own)[0];
    let starts: Vec<usize> =
        (0..3 * mesh.triangles.len()).filter(|&other| corners(mesh, other)[0] == place).collect();
    let mut found = vec![own];
    loop {
        let is_next = |other: &&usize| {
            let other = **other;
            let hangs_on = |&known: &usize| {
                twin(before(known)) == Some(other) || twin(before(other)) == Some(known)
            };
            !found.contains(&other) && found.iter().any(hangs_on)
        };
        match starts.iter().find(is_next) {
            Some(&next) => found.push(next),
            None => return found,
        }
    }
}

/// The side of a feature to which a direction leads.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Seen {
    Front,
    Behind,
    Beside,
}

fn side(around: &Around<impl Facets>, triangle: u32, feature: Feature, direction: DVec3) -> Seen {
    let is_behind = around.points_inside(triangle, feature, direction);
    match around.is_local_minimum(triangle, feature, direction, None) {
        true if is_behind => panic!("in front and behind"),
        true => Seen::Front,
        false if is_behind => Seen::Behind,
        false => Seen::Beside,
    }
}

/// The expected side; `None` if rounding decides.
fn brute_side(
    mesh: &Soup,
    is_solid: bool,
    around: &[usize],
    feature: Feature,
    direction: DVec3,
) -> Option<Seen> {
    let at = |half_edge: usize| corners(mesh, half_edge).map(|corner| corner.as_dvec3());
    let normal: DVec3 = around.iter().map(|&h| at(h)).map(|[a, b, c]| (b - a).cross(c - a)).sum();
    let cosine = normal.normalize_or_zero().dot(direction);
    // The face of a triangle without area is nowhere nearest.
    let is_unsure = if feature == Feature::Face { normal == DVec3::ZERO } else { is_solid };
    if is_unsure && cosine.abs() < 1e-9 {
        return None;
    }
    if feature == Feature::Face {
        return match cosine.abs() {
            x if x < 1.0 - RISES[1] => Some(Seen::Beside),
            x if x < 1.0 - RISES[0] => None,
            _ if is_solid && cosine < 0.0 => Some(Seen::Behind),
            _ => Some(Seen::Front),
        };
    }
    if is_solid && cosine < 0.0 {
        return Some(Seen::Behind);
    }
    let rises = around.iter().flat_map(|&half_edge| {
        let [a, b, c] = at(half_edge);
        [b - a, c - a].map(|edge| edge.normalize_or_zero().dot(direction))
    });
    // The surface may rise twice as much as it bends.
    let [a, b, c] = at(around[0]);
    let own = (b - a).cross(c - a).normalize_or_zero();
    let bends = around.iter().flat_map(|&half_edge| {
        let [a, b, c] = at(half_edge);
        [b - a, c - a].map(|edge| edge.normalize_or_zero().dot(own).abs())
    });
    let bend = if own == DVec3::ZERO { 1.0 } else { (2.0 * bends.fold(0.0, f64::max)).max(1e-3) };
    match rises.fold(0.0, f64::max) {
        x if x < 0.99 * bend.min(RISES[0]) => Some(Seen::Front),
        x if x < 1.01 * bend.min(RISES[1]) => None,
        _ => Some(Seen::Beside),
    }
}

fn features() -> impl Iterator<Item = Feature> {
    (0..3).flat_map(|i| [Feature::Vertex(i), Feature::Edge(i)]).chain([Feature::Face])
}

#[test]
fn directions_agree_with_all_triangles_of_the_one_ring() {
    let mut random = Random(42);
    let mut seen = [0; 3];
    for i in 0..60_u32 {
        let mut mesh = match i % 3 {
            0 => bumpy_ball(3 + i % 5, 0.2),
            1 => with_copies(&sheet(5, |x, y| 0.4 * (3.0 * x).sin() * y), &mut random),
            _ => lattice_soup(&mut random, 30, 2),
        };
        if i % 2 == 0 {
            // Fans with borders.
            mesh.triangles.retain(|_| !random.bits().is_multiple_of(6));
        }
        let surface = mesh.surface();
        let twins = brute_twins(&mesh);
        for case in 0..800 {
            let is_solid = case % 2 == 0;
            let side_of_all = if is_solid { Side::Outer } else { Side::Sheet };
            let around = Around { facets: mesh.facets(&surface), side: side_of_all };
            let triangle = (random.bits() % mesh.triangles.len() as u64) as u32;
            for feature in features() {
                let mut own = triangles_around(&mesh, &twins, triangle, feature);
                own.sort_by_key(|half_edge| half_edge / 3 != triangle as usize);
                let [a, b, c] = corners(&mesh, own[0]).map(|corner| corner.as_dvec3());
                // About the normal, where the answers change most.
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let sign = [1.0, -1.0][(random.bits() % 2) as usize];
                let spread = f64::from(random.range(0.0, 1.0));
                let direction = sign * normal + spread * random.vector(1.0).as_dvec3();
                let Some(direction) = direction.try_normalize() else { continue };
                let found = side(&around, triangle, feature, direction);
                if let Some(expected) = brute_side(&mesh, is_solid, &own, feature, direction) {
                    assert_eq!(found, expected, "{triangle} {feature:?} {direction} {mesh:?}");
                    seen[found as usize] += 1;
                }
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 10_000), "{seen:?}");
}

/// The cube leans on an edge, and a corner leads down.
#[test]
fn a_leaning_corner_is_a_minimum_for_faces_first() {
    let cube = cube();
    let surface = cube.surface();
    let around = Around { facets: cube.facets(&surface), side: Side::Outer };
    let half_edges = 0..3 * cube.triangles.len();
    let corner = half_edges.into_iter().find(|&half_edge| {
        let [corner, _, _] = corners(&cube, half_edge);
        (0..3).all(|axis| corner[axis] <= cube.vertices.iter().map(|v| v[axis]).fold(1e9, f32::min))
    });
    let corner = corner.expect("a cube has a lowest corner") as u32;
    let (triangle, feature) = (corner / 3, Feature::Vertex((corner % 3) as u8));
    for (lean, free, to_face) in [
        (-0.1, true, true),
        (0.04, true, true),
        (0.1, false, true),
        (0.25, false, true),
        (0.4, false, false),
    ] {
        let down = DVec3::new(f64::sin(lean), -f64::cos(lean), 0.0);
        let is_front = |to| around.is_local_minimum(triangle, feature, down, to);
        assert_eq!(
            [is_front(None), is_front(Some((DVec3::ZERO, Feature::Face)))],
            [free, to_face],
            "{lean}"
        );
    }
}

/// A cube of edge length 1 in eight vertices.
fn cube() -> Soup {
    let vertices = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Soup { vertices: vertices.map(|v| v - 0.5).collect(), triangles: triangles.collect() }
}

/// Each two triangles in a row with vertices of their own: of a cube, 24.
fn unwelded(mesh: &Soup) -> Soup {
    let mut apart = Soup { vertices: Vec::new(), triangles: Vec::new() };
    for two in mesh.triangles.chunks(2) {
        let mut indices: Vec<u32> = two.iter().flatten().copied().collect();
        indices.sort_unstable();
        indices.dedup();
        let first = apart.vertices.len() as u32;
        let place = |index: &u32| first + indices.binary_search(index).unwrap() as u32;
        apart.triangles.extend(two.iter().map(|t| t.each_ref().map(place)));
        apart.vertices.extend(indices.iter().map(|&i| mesh.vertices[i as usize]));
    }
    apart
}

/// All of some meshes.
fn together<const N: usize>(meshes: [Soup; N]) -> Soup {
    let mut all = Soup { vertices: Vec::new(), triangles: Vec::new() };
    for mesh in meshes {
        let first = all.vertices.len() as u32;
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| first + i)));
        all.vertices.extend(mesh.vertices);
    }
    all
}

fn mapped(mut mesh: Soup, map: impl Fn(Vec3) -> Vec3) -> Soup {
    mesh.vertices.iter_mut().for_each(|vertex| *vertex = map(*vertex));
    mesh
}

fn turned_inside_out(mut mesh: Soup) -> Soup {
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    mesh
}

/// Two triangles a cell over the square from -1 to 1, at some heights.
fn sheet(cells: u32, height: impl Fn(f32, f32) -> f32) -> Soup {
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
fn lathe(profile: &[[f32; 2]], turn: f32, welded: bool) -> Soup {
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
fn arc(share: f32) -> Vec<[f32; 2]> {
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

fn ball() -> Soup {
    lathe(&arc(1.0), TAU, true)
}

/// A tube of radius 1, closed by a half ball below.
fn glove(length: f32) -> Soup {
    let straight = (1..=10).map(|i| [1.0, 0.1 * length * f32::from(i as u8)]);
    lathe(&arc(0.5).into_iter().chain(straight).collect::<Vec<_>>(), TAU, true)
}

/// A pot of radius 1 with a disc of a radius over its opening; upside down if that is negative.
fn with_lid(radius: f32, height: f32) -> Soup {
    let lid = lathe(&[[radius.abs(), 0.0], [0.0, 0.0]], TAU, true);
    let lid = if radius < 0.0 { turned_inside_out(lid) } else { lid };
    together([glove(1.0), mapped(lid, |v| v + Vec3::Z * (1.0 + height))])
}

/// A tube of radius 1, open at both ends.
fn tube(turn: f32, welded: bool) -> Soup {
    let profile: Vec<_> = (0..=20).map(|i: u8| [1.0, 0.3 * f32::from(i)]).collect();
    lathe(&profile, turn, welded)
}

fn torus() -> Soup {
    let circle = |i: u8| {
        let (sin, cos) = (TAU * f32::from(i % 16) / 16.0).sin_cos();
        [2.0 + 0.5 * cos, 0.5 * sin]
    };
    lathe(&(0..=16).map(circle).collect::<Vec<_>>(), TAU, true)
}

fn moebius() -> Soup {
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

fn without(mut mesh: Soup, removed: &[usize]) -> Soup {
    let mut index = 0..;
    mesh.triangles.retain(|_| index.next().is_some_and(|index| !removed.contains(&index)));
    mesh
}

fn with_turned(mut mesh: Soup, triangle: usize) -> Soup {
    mesh.triangles[triangle].swap(0, 1);
    mesh
}

/// Shapes and what they are.
fn kinds() -> Vec<(&'static str, Soup, SurfaceKind)> {
    let flat = |z: f32| sheet(8, move |_, _| z);
    let half = |mesh: Soup| mapped(mesh, |v| 0.5 * v);
    let beside = |mesh: Soup| mapped(mesh, |v| v + 3.0 * Vec3::X);
    let plate = |thickness: f32| mapped(cube(), move |v| v * Vec3::new(1.0, 1.0, thickness));
    let lidless = |mut mesh: Soup| {
        mesh.triangles.drain(2..4);
        mesh
    };
    let crate_half_open = {
        // The lid reaches over half of the box.
        let mut mesh = lidless(cube());
        mesh.vertices.extend([Vec3::new(0.0, -0.5, 0.5), Vec3::new(0.0, 0.5, 0.5)]);
        mesh.triangles.extend([[4, 8, 9], [4, 9, 6]]);
        mesh
    };
    let folded = {
        let mesh = sheet(8, |_, _| 0.0);
        mapped(mesh, |v| if v.x > 0.0 { Vec3::new(-v.x, v.y, v.z) } else { v })
    };
    // 912 triangles.
    let holes: Vec<usize> = (0..100).map(|i| 9 * i).collect();
    let mut random = Random(44);
    vec![
        ("nothing", Soup { vertices: Vec::new(), triangles: Vec::new() }, Sheet),
        ("cube", cube(), Solid),
        ("cube of 24 vertices", unwelded(&cube()), Solid),
        ("ball", ball(), Solid),
        ("ball with a seam", lathe(&arc(1.0), TAU, false), Solid),
        ("torus", torus(), Solid),
        ("cube inside out", turned_inside_out(cube()), InsideOut),
        ("torus inside out", turned_inside_out(torus()), InsideOut),
        ("hollow ball", together([ball(), turned_inside_out(half(ball()))]), Solid),
        ("two balls", together([ball(), beside(ball())]), Solid),
        ("balls in a ball", together([ball(), half(ball()), beside(ball())]), Solid),
        ("plate", plate(0.001), Solid),
        ("ball without a triangle", without(ball(), &[300]), Solid),
        ("ball with holes", without(ball(), &holes[..36]), Solid),
        ("ball with more holes", without(ball(), &holes), Sheet),
        ("ball with a triangle turned", with_turned(ball(), 300), Solid),
        ("cube with a triangle turned", with_turned(cube(), 3), Sheet),
        ("bottle", glove(70.0), Solid),
        ("pot with a lid", with_lid(0.93, 0.0), Solid),
        ("pot with a lid in it", with_lid(0.97, -0.02), Solid),
        ("pot with a small lid", with_lid(0.8, 0.0), Sheet),
        ("pot with a lid that floats", with_lid(0.95, 0.3), Sheet),
        ("pot with a lid upside down", with_lid(-0.95, 0.0), Sheet),
        ("glove", glove(4.0), Sheet),
        ("bowl", lathe(&arc(0.5), TAU, true), Sheet),
        ("deep bowl", lathe(&arc(0.8), TAU, true), Sheet),
        ("box without lid", lidless(cube()), Sheet),
        ("half-open box", crate_half_open, Sheet),
        ("sheet", flat(0.3), Sheet),
        ("bent sheet", sheet(8, |x, y| 0.3 * (2.0 * x).sin() + 0.2 * y * y), Sheet),
        ("two layers", together([flat(0.0), turned_inside_out(flat(0.0))]), Sheet),
        ("two layers, one way", together([flat(0.0), flat(0.0)]), Sheet),
        ("folded sheet", folded, Sheet),
        ("Moebius strip", moebius(), Sheet),
        ("soup", soup(&mut random, 300, 0.3), Sheet),
        ("tube", tube(TAU, true), Sheet),
        ("tube with a seam", tube(TAU, false), Sheet),
        ("tube with a slit", tube(0.99 * TAU, false), Sheet),
        ("half a tube", tube(FRAC_PI_2 * 2.0, false), Sheet),
    ]
}

#[test]
fn kinds_are_independent_of_size_place_and_order() {
    let mut random = Random(45);
    for (name, mesh, kind) in kinds() {
        for size in [1e-3, 1.0, 1e3] {
            let (turn, shift): (Quat, Vec3) = (random.rotation(), random.vector(3.0));
            let mut moved = mapped(mesh.clone(), |v| size * (turn * v + shift));
            for i in (1..moved.triangles.len()).rev() {
                moved.triangles.swap(i, (random.bits() % (i as u64 + 1)) as usize);
            }
            for triangle in &mut moved.triangles {
                triangle.rotate_left((random.bits() % 3) as usize);
            }
            let found = moved.surface().kind();
            assert_eq!(found, kind, "{name}, {size} times as large");
            let mirrored = mapped(moved, |v| v * Vec3::new(-1.0, 1.0, 1.0));
            let found = mirrored.surface().kind();
            let mirror = match kind {
                Solid => InsideOut,
                InsideOut => Solid,
                Sheet => Sheet,
            };
            assert_eq!(found, mirror, "{name}, mirrored");
        }
    }
}

#[test]
fn a_solid_with_a_hole_is_solid_far_from_the_origin() {
    let open = {
        let mut ball = ball();
        ball.triangles
            .retain(|corners| corners.iter().all(|&v| ball.vertices[v as usize].z < 0.95));
        ball
    };
    for away in Vec3::AXES.into_iter().flat_map(|axis| [100.0 * axis, -100.0 * axis]) {
        let moved = mapped(open.clone(), |v| v + away);
        assert_eq!(moved.surface().kind(), Solid, "at {away}");
    }
}

#[test]
fn flat_sides_continue_to_their_end() {
    const CELLS: u32 = 5;
    let mut mesh = Soup { vertices: Vec::new(), triangles: Vec::new() };
    for i in 0..=CELLS {
        // The last row leans by a degree.
        let lean = if i == CELLS { 0.017 } else { 0.0 };
        mesh.vertices.extend((0..=CELLS).map(|j| Vec3::new(j as f32, i as f32, lean)));
    }
    for (i, j) in (0..CELLS * CELLS).map(|cell| (cell / CELLS, cell % CELLS)) {
        let [a, b] = [i, i + 1].map(|row| row * (CELLS + 1) + j);
        mesh.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
    }
    let surface = mesh.surface();
    let around = Around { facets: mesh.facets(&surface), side: Side::Sheet };
    for triangle in 0..2 * CELLS * (CELLS - 1) {
        let top = 1 + triangle / (2 * CELLS);
        let beyond = |direction, most| around.side_beyond(triangle, direction, most);
        let expected = f64::from(CELLS - 1 - top);
        assert_eq!(beyond(DVec3::Y, 100.0), expected, "{triangle}");
        assert_eq!(beyond(DVec3::Y, 1.5), expected.min(1.5));
        assert_eq!(beyond(-DVec3::Y, 100.0), f64::from(top - 1));
        assert_eq!(beyond(DVec3::new(0.0, 1.0, 0.01).normalize(), 100.0), 0.0);
    }
}
