//! Clipping against the near plane, so that what reaches behind the camera is cut, not dropped.

use arrayvec::ArrayVec;
use glamx::Vec3;

/// A corner of a polygon in view space.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub position: Vec3,
    /// World space; zero for what is drawn unlit.
    pub normal: Vec3,
}

/// The part of the triangle at `z >= near` (Sutherland and Hodgman's walk along the rim with one
/// plane): nothing, a triangle or a quad.
pub(super) fn near(triangle: [Vertex; 3], near: f32) -> ArrayVec<Vertex, 4> {
    let mut kept = ArrayVec::new();
    for (index, &vertex) in triangle.iter().enumerate() {
        let next = triangle[(index + 1) % 3];
        let [distance, next_distance] = [vertex, next].map(|v| v.position.z - near);
        if distance >= 0.0 {
            kept.push(vertex);
        }
        if (distance >= 0.0) != (next_distance >= 0.0) {
            let t = distance / (distance - next_distance);
            kept.push(Vertex {
                position: vertex.position.lerp(next.position, t),
                normal: vertex.normal.lerp(next.normal, t),
            });
        }
    }
    kept
}
