//! Changes of the input that leave a contact unchanged.

use super::shape::{Core, Kind, Shape};
use super::truth::size;
use crate::prelude::*;

fn kinds() -> impl Iterator<Item = Kind> {
    Kind::POLYTOPES.into_iter().chain(Kind::CURVED)
}

fn poses(kind: Kind, count: u32, mut each: impl FnMut(&mut Random, Shape, [DVec3; 3])) {
    let mut rng = Random(1000 + kind as u64);
    for i in 0..count {
        let shape = rng.shape(kind);
        let gap = [rng.within(0.0, 0.1), 0.0, rng.within(-0.5, 0.0)][i as usize % 3];
        let triangle = rng.triangle_beside(&shape, gap);
        each(&mut rng, shape, triangle);
    }
}

#[test]
fn contacts_scale_with_the_bodies() {
    for kind in kinds() {
        poses(kind, 500, |_, shape, triangle| {
            let contact = shape.contact(&triangle, 0.2);
            for factor in [0.5_f64.powi(10), 2.0_f64.powi(10), 2.0_f64.powi(-60), 2.0_f64.powi(60)]
            {
                let scaled =
                    shape.scaled(factor).contact(&triangle.map(|c| c * factor), 0.2 * factor);
                let Some(contact) = contact else {
                    assert_eq!(scaled, None);
                    continue;
                };
                let scaled = scaled.expect("a contact at any scale");
                assert_eq!(scaled.distance, contact.distance * factor);
                assert_eq!(scaled.normal, contact.normal);
                assert_eq!(scaled.on_triangle, contact.on_triangle * factor);
                assert_eq!(scaled.on_shape, contact.on_shape * factor);
            }
        });
    }
}

#[test]
fn margins_filter_contacts_but_do_not_change_them() {
    for kind in kinds() {
        poses(kind, 500, |_, shape, triangle| {
            let wide = shape.contact(&triangle, 1.0e6).expect("within the margin");
            for margin in [0.0, 0.01, 0.1, 1.0, f64::INFINITY] {
                let contact = shape.contact(&triangle, margin);
                if contact.is_some() || wide.distance < margin * (1.0 - 1.0e-9) {
                    assert_eq!(contact, Some(wide));
                }
            }
            assert_eq!(shape.contact(&triangle, wide.distance - 1.0e-3), None);
            if wide.distance > 0.0 {
                assert_eq!(shape.contact(&triangle, wide.distance), Some(wide));
            }
        });
    }
}

#[test]
fn order_of_corners_and_mirrors_change_only_last_digits() {
    for kind in kinds() {
        poses(kind, 500, |rng, shape, triangle| {
            let contact = shape.contact(&triangle, 0.2);
            let [a, b, c] = triangle;
            let mut turned = shape.clone();
            if let Core::Hull(points) = &mut turned.core {
                points.reverse();
            }
            let same = |other: Option<f64>| match (contact.map(|c| c.distance), other) {
                (Some(x), Some(y)) => assert!((x - y).abs() <= 1.0e-8 * size(&triangle, &shape)),
                (Some(x), None) | (None, Some(x)) => assert!((x - 0.2).abs() < 1.0e-9),
                (None, None) => {}
            };
            for other in [[b, c, a], [c, b, a], [a, c, b]] {
                same(turned.contact(&other, 0.2).map(|c| c.distance));
            }
            // Shapes around the y axis are the same in a mirror.
            if matches!(shape.core, Core::Cuboid(_) | Core::Cylinder(_) | Core::Cone(_)) {
                let [x, z] = [0; 2].map(|_| if rng.below(2) == 0 { -1.0 } else { 1.0 });
                let mirrored = triangle.map(|c| c * DVec3::new(x, 1.0, z));
                same(shape.contact(&mirrored, 0.2).map(|c| c.distance));
            }
        });
    }
}

#[test]
fn far_offsets_lose_only_digits_of_coordinates() {
    for offset in [1.0e3, 1.0e6] {
        poses(Kind::Hull, 2000, |rng, shape, triangle| {
            let Core::Hull(points) = &shape.core else { unreachable!() };
            let shift = rng.direction() * offset;
            let moved = Shape {
                core: Core::Hull(points.iter().map(|&p| p + shift).collect()),
                radius: shape.radius,
            };
            let near = shape.contact(&triangle, 0.2);
            let far = moved.contact(&triangle.map(|c| c + shift), 0.2);
            let [near, far] = [near, far].map(|c| c.map_or(0.2, |c| c.distance));
            let error = (near - far).abs();
            assert!(error <= 1.0e-11 * offset, "{error:e} {shape:?} {triangle:?}");
        });
    }
}
