//! Distances by other formulas than the kernel's, and what any contact must fulfil.

use crate::polytope::{self, nearest_of_triangle};
use crate::shape::{Core, Shape};
use glamx::DVec3;
use sbbk_core::contact::convex::ConvexContact;

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

/// Distance of a point from a core that it is outside of; 0 inside.
pub fn outside(core: &Core, point: DVec3) -> f64 {
    let across = point.x.hypot(point.z);
    let y = point.y;
    match core {
        Core::Cylinder(c) => (across - c.radius).max(0.0).hypot((y.abs() - c.half_height).max(0.0)),
        Core::Cone(c) => {
            // In a half plane, the cone is a right triangle: base, axis and slope.
            let (h, r) = (c.half_height, c.radius);
            if y < -h {
                return (across - r).max(0.0).hypot(y + h);
            }
            let (slope, length) = ((r, -2.0 * h), r.hypot(2.0 * h));
            let beyond = across * 2.0 * h + (y - h) * r;
            if beyond <= 0.0 {
                return 0.0;
            }
            let along = ((across * slope.0 + (y - h) * slope.1) / length).clamp(0.0, length);
            let (x0, y0) = (slope.0 * along / length, h + slope.1 * along / length);
            (across - x0).hypot(y - y0)
        }
        core => {
            let shape = Shape { core: core.clone(), radius: 0.0 };
            polytope::distance(&shape.vertices(), &[point; 3]).max(0.0)
        }
    }
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
    let off = (nearest_of_triangle(triangle, on_triangle) - on_triangle).length();
    assert!(off <= tolerance, "point off the triangle by {off:e}: {}", says());
    let off = outside(&shape.core, on_shape) - shape.radius;
    assert!(off <= tolerance, "point off the shape by {off:e}: {}", says());
    let open = (gap(triangle, shape, normal) - distance).abs();
    // Between edges and vertices, a direction is a difference of coordinates.
    let size = size(triangle, shape);
    let rounding = 4.0e-15 * size * (size / (distance + shape.radius).abs()).min(1.0e9);
    assert!(open <= tolerance + rounding, "normal open by {open:e}: {}", says());
}
