//! Neighbours, sides and kinds of surfaces, by definitions that look at everything.

/// Directions of local minima.
mod cones;
/// Solids and sheets.
mod kinds;
/// Meshes whose kind is known.
pub mod shapes;

use crate::prelude::*;
use shapes::{cube, sheet};

/// The corners of a half-edge's triangle, from its start on.
fn corners(Soup { vertices, triangles }: &Soup, half_edge: usize) -> [Vec3; 3] {
    [0, 1, 2].map(|i| vertices[triangles[half_edge / 3][(half_edge + i) % 3] as usize])
}

/// The half-edge before another one of the same triangle.
fn before(half_edge: usize) -> usize {
    3 * (half_edge / 3) + (half_edge + 2) % 3
}

/// True if an earlier triangle has the same corners, or if others have the sides of one without an
/// area.
fn is_double(mesh: &Soup, triangle: usize) -> bool {
    is_repeated(mesh, triangle) || is_sliver(mesh, triangle)
}

/// True if the corners of a triangle are on a line, up to rounding.
fn is_flat(mesh: &Soup, triangle: usize) -> bool {
    let [a, b, c] = corners(mesh, 3 * triangle).map(|corner| corner.as_dvec3());
    let longest = [b - a, c - b, a - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
    let magnitude = [a, b, c].map(|corner| corner.abs().max_element()).into_iter();
    let rounding = 4.0 * f64::from(f32::EPSILON) * magnitude.fold(0.0, f64::max);
    (b - a).cross(c - a).length() <= rounding * longest
}

/// The other triangles with a side between the ends of a half-edge.
fn others_at(mesh: &Soup, half_edge: usize) -> Vec<usize> {
    let [start, end, _] = corners(mesh, half_edge);
    let has_side = |other: &usize| {
        let ends = [0, 1, 2].map(|i| corners(mesh, 3 * other + i)).map(|[a, b, _]| [a, b]);
        *other != half_edge / 3 && (ends.contains(&[start, end]) || ends.contains(&[end, start]))
    };
    (0..mesh.triangles.len()).filter(has_side).collect()
}

/// True if a triangle without an area is a point, or has a side of one that has an area.
fn is_sliver(mesh: &Soup, triangle: usize) -> bool {
    let is_of_face = |half_edge| {
        let [start, end, _] = corners(mesh, half_edge);
        start != end && others_at(mesh, half_edge).iter().any(|&other| !is_flat(mesh, other))
    };
    let [a, b, c] = corners(mesh, 3 * triangle);
    let is_point = a == b && b == c;
    is_flat(mesh, triangle) && (is_point || (3 * triangle..3 * triangle + 3).any(is_of_face))
}

/// True for a sliver that does not fill a gap between three others.
fn hangs(mesh: &Soup, triangle: usize) -> bool {
    let is_filled = |half_edge| {
        let [start, end, _] = corners(mesh, half_edge);
        start != end && others_at(mesh, half_edge).len() == 1
    };
    is_sliver(mesh, triangle) && !(3 * triangle..3 * triangle + 3).all(is_filled)
}

/// True if an earlier triangle has the same corners.
fn is_repeated(mesh: &Soup, triangle: usize) -> bool {
    let sorted = |triangle: usize| {
        // Minus zero is at the same place.
        let mut places =
            corners(mesh, 3 * triangle).map(|at| (at + 0.0).to_array().map(f32::to_bits));
        places.sort_unstable();
        places
    };
    (0..triangle).any(|other| sorted(other) == sorted(triangle))
}

/// The twin of each half-edge by definition: the only half-edge from its end to its start, if no
/// other runs from start to end. Doubles with the corners of others and hanging slivers do not
/// count.
fn brute_twins(mesh: &Soup) -> Vec<Option<u32>> {
    let count = 3 * mesh.triangles.len();
    let is_left_out = |triangle| is_repeated(mesh, triangle) || hangs(mesh, triangle);
    let doubles: Vec<bool> = (0..count / 3).map(is_left_out).collect();
    let along = |from: Vec3, to: Vec3| -> Vec<u32> {
        let is_along = |&half_edge: &u32| {
            !doubles[half_edge as usize / 3] && corners(mesh, half_edge as usize)[..2] == [from, to]
        };
        (0..count as u32).filter(is_along).collect()
    };
    (0..count)
        .map(|half_edge| {
            let [start, end, _] = corners(mesh, half_edge);
            match (&along(start, end)[..], &along(end, start)[..]) {
                ([_], &[twin]) if start != end && !doubles[half_edge / 3] => Some(twin),
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
    let doubles = (0..mesh.triangles.len()).filter(|&triangle| is_double(mesh, triangle));
    assert!(
        doubles.eq((0..mesh.triangles.len()).filter(|&i| surface.is_double(i as u32))),
        "{mesh:?}"
    );
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
    let weighted = |[a, b, c]: [DVec3; 3]| {
        let angle = match feature {
            Feature::Vertex(_) => (b - a).angle_between(c - a),
            _ => 1.0,
        };
        angle * (b - a).cross(c - a).normalize_or_zero()
    };
    let normal: DVec3 = around.iter().map(|&h| at(h)).map(weighted).sum();
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

/// Corners of tetrahedra are acute, and their triangles unlike in size. Would catch a corner that
/// seems to lead into the solid as one large triangle there faces away.
#[test]
fn the_farthest_corners_and_edges_of_tetrahedra_are_minima() {
    let mut random = Random(43);
    let mut counts = [0; 2];
    for _ in 0..2000 {
        let thin = Vec3::new(1.0, 1.0, random.range(0.02, 1.0));
        let vertices: Vec<Vec3> = (0..4).map(|_| thin * random.vector(1.0)).collect();
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| vertices[i]);
        let is_left = (b - a).cross(c - a).dot(d - a) > 0.0;
        let [i, j] = if is_left { [1, 2] } else { [2, 1] };
        let triangles = vec![[0, j, i], [0, i, 3], [i, j, 3], [j, 0, 3]];
        let mesh = Soup { vertices, triangles };
        let surface = mesh.surface();
        let around = Around { facets: mesh.facets(&surface), side: Side::Outer };
        for half_edge in 0..12_u32 {
            let (triangle, i) = (half_edge / 3, (half_edge % 3) as u8);
            let [start, end, _] = corners(&mesh, half_edge as usize).map(|at| at.as_dvec3());
            let mut direction = random.vector(1.0).as_dvec3();
            let is_edge = random.bits().is_multiple_of(2);
            let feature = if is_edge {
                direction = direction.reject_from(end - start);
                Feature::Edge(i)
            } else {
                Feature::Vertex(i)
            };
            let direction = direction.normalize();
            let height = |at: &Vec3| direction.dot(at.as_dvec3() - start);
            if mesh.vertices.iter().all(|at| height(at) <= 1e-9) {
                let found = side(&around, triangle, feature, direction);
                assert_eq!(found, Seen::Front, "{triangle} {feature:?} {direction}");
                counts[usize::from(is_edge)] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
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
