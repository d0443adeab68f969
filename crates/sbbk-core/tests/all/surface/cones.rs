//! Normal cones hold all directions of local minima.

use super::shapes::sheet;
use crate::prelude::*;
use sbbk_core::surface::minimum_cones;

fn random_mesh(random: &mut Random, i: u64) -> Soup {
    match i % 5 {
        0 => bumpy_ball(3 + i as u32 % 7, 0.2),
        1 => bumpy_ball(12, 0.02),
        2 => sheet(8, |x, y| 0.2 * (5.0 * x).sin() * y),
        3 => lattice_soup(random, 40, 2),
        _ => soup(random, 30, 0.5),
    }
}

#[test]
fn local_minima_are_within_the_cones_of_their_triangles() {
    let mut random = Random(71);
    let (mut minima, mut outside) = ([0; 2], [0; 2]);
    for i in 0..60 {
        let mesh = random_mesh(&mut random, i);
        let surface = mesh.surface();
        let side = [Side::Outer, Side::Sheet][(i / 5 % 2) as usize];
        let around = Around { facets: mesh.facets(&surface), side };
        for _ in 0..4000 {
            let triangle = (random.bits() % mesh.triangles.len() as u64) as u32;
            let [a, b, c] = [0, 1, 2].map(|i| around.facets.corner(3 * triangle, i));
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let sign = [1.0, -1.0][(random.bits() % 2) as usize];
            let spread = f64::from(random.range(0.0, 1.0));
            let direction = sign * normal + spread * random.vector(1.0).as_dvec3();
            let Some(direction) = direction.try_normalize() else { continue };
            let vertex = (random.bits() % 3) as u8;
            let feature = [Feature::Vertex(vertex), Feature::Edge(vertex)][(i % 2) as usize];
            let cones = minimum_cones(&around.facets, triangle);
            for (to_face, other) in [Feature::Edge(0), Feature::Face].into_iter().enumerate() {
                let contact = Some((around.facets.corner(3 * triangle, vertex.into()), other));
                let least = cones.least_square(to_face == 1);
                let is_outside = normal.dot(direction).powi(2) < least;
                if around.is_local_minimum(triangle, feature, direction, contact) {
                    assert!(!is_outside, "{triangle} {feature:?} {direction} {least} {mesh:?}");
                    minima[to_face] += 1;
                }
                outside[to_face] += usize::from(is_outside);
            }
        }
    }
    assert!(minima.iter().chain(&outside).all(|&count| count > 1000), "{minima:?} {outside:?}");
}

/// Would catch cones that hold everything, and bounds where a surface ends.
#[test]
fn triangles_within_a_flat_floor_have_narrow_cones() {
    let floor = sheet(6, |_, _| 0.0);
    let surface = floor.surface();
    let around = Around { facets: floor.facets(&surface), side: Side::Sheet };
    for (triangle, corners) in (0..).zip(&floor.triangles) {
        let least = minimum_cones(&around.facets, triangle).least_square(true);
        let is_within = corners.iter().all(|&corner| {
            let Vec3 { x, y, .. } = floor.vertices[corner as usize];
            [x, y].into_iter().all(|at| at.abs() < 0.9)
        });
        assert_eq!((least > 0.99, least == 0.0), (is_within, !is_within), "{corners:?}");
    }
}
