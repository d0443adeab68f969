//! What any contact must fulfil.

use super::shape::{Core, Shape};
use glamx::DVec3;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::truth::ConvexBody;

/// Size of a triangle and a shape.
pub fn size(triangle: &[DVec3; 3], shape: &Shape) -> f64 {
    let [a, b, c] = *triangle;
    let across = |u: DVec3| (shape.support(u) - shape.support(-u)).dot(u);
    let width = DVec3::AXES.into_iter().map(across).fold(0.0, f64::max);
    (b - a).length().max((c - a).length()).max(width + shape.radius)
}

/// How far apart the shadows are on an axis: what the core leaves free of the triangle.
pub fn gap(triangle: &[DVec3; 3], shape: &Shape, normal: DVec3) -> f64 {
    let lowest = shape.support(-normal);
    let above = |c: &DVec3| (lowest - *c).dot(normal);
    triangle.iter().map(above).fold(f64::INFINITY, f64::min) - shape.radius
}

/// What every contact must fulfil whatever the truth is: points on the bodies, both on one line
/// along a unit normal, and a normal along which the bodies are as far apart as it says. Apart,
/// that proves the distance; crossing, that the move parts the bodies.
pub fn check(triangle: &[DVec3; 3], shape: &Shape, contact: &ConvexContact, tolerance: f64) {
    let ConvexContact { distance, normal, on_triangle, on_shape } = *contact;
    let says = || format!("{triangle:?} {shape:?} {contact:?}");
    assert!((normal.length() - 1.0).abs() < 1.0e-12, "normal: {}", says());
    let line = (on_shape - on_triangle - normal * distance).length();
    assert!(line <= tolerance, "points off the normal by {line:e}: {}", says());
    let off = ConvexBody::hull(*triangle).outside(on_triangle);
    assert!(off <= tolerance, "point off the triangle by {off:e}: {}", says());
    let off = shape.truth().outside(on_shape);
    assert!(off <= tolerance, "point off the shape by {off:e}: {}", says());
    let open = (gap(triangle, shape, normal) - distance).abs();
    // Between edges and vertices, a direction is a difference of coordinates, each rounded some
    // twenty times on its way. (The fuzzer has found 1e-14.)
    let (size, apart) = (size(triangle, shape), (distance + shape.radius).abs());
    // Nearer than that, the bodies touch, and the normal is that of a face: of two triangles as in
    // `contact_truth`.
    let touching = if matches!(shape.core, Core::Triangle(_)) { 1.0e-12 } else { 1.0e-9 };
    let rounding = 2.0e-14 * size * (size / apart).min(1.0 / touching);
    // Of features next to each other and nearly parallel, points whose distances differ by rounding only
    // may lie in directions that differ by the root of it.
    let slide = if apart < 1.0e-6 * size {
        size * (1.0e-15 * size / apart).sqrt().min(1.0e-3)
    } else {
        0.0
    };
    assert!(open <= tolerance + rounding + slide, "normal open by {open:e}: {}", says());
}
