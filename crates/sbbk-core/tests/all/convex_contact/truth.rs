//! Conditions that every contact must meet.

use super::shape::Shape;
use glamx::DVec3;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_truth::ConvexBody;

/// Size of a triangle and a shape.
pub fn size(triangle: &[DVec3; 3], shape: &Shape) -> f64 {
    let [a, b, c] = *triangle;
    let across = |u: DVec3| (shape.support(u) - shape.support(-u)).dot(u);
    let width = DVec3::AXES.into_iter().map(across).fold(0.0, f64::max);
    (b - a).length().max((c - a).length()).max(width + shape.radius)
}

/// Gap between the shadows of the core and the triangle on an axis, less the rounding radius.
pub fn gap(triangle: &[DVec3; 3], shape: &Shape, normal: DVec3) -> f64 {
    let lowest = shape.support(-normal);
    let above = |c: &DVec3| (lowest - *c).dot(normal);
    triangle.iter().map(above).fold(f64::INFINITY, f64::min) - shape.radius
}

/// Checks that the points lie on the bodies, on one line along a unit normal, and that the normal
/// proves the distance. For bodies that cross, this proves that the move separates them.
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
    // twenty times on its way. (The fuzzer has found 4.4e-15.)
    let size = size(triangle, shape);
    let rounding = 5.0e-15 * size * (size / (distance + shape.radius).abs()).min(1.0e9);
    assert!(open <= tolerance + rounding, "normal open by {open:e}: {}", says());
}
