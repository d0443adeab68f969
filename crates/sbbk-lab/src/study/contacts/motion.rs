//! Small steps, as bodies in contact make them.

use glamx::{Pose3, Quat, Vec3};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;

use super::approach::Place;

/// Slow motion: how far a step moves the surface, as a share of the prediction distance.
pub const SLOW: Real = 0.05;
/// Faster motion, likewise.
pub const FAST: Real = 0.5;
/// Steps of one motion, after its first query.
pub const STEP_COUNT: usize = 16;

/// Poses from before a place through it to as far behind it, [`STEP_COUNT`] equal steps: the mesh
/// slides along a straight line and turns about its origin at once. Each of the two moves the
/// point of the surface that it moves most by half of `step`; together they move no point farther
/// than `step`, and some nearly so far.
pub(in crate::study) fn motion(shape: &SharedShape, place: &Place, step: Real) -> Vec<Pose3> {
    let (slide, axis) = place.motion();
    let local_axis = place.pos12.rotation.inverse() * axis;
    let angle = 0.5 * step / radius(shape, local_axis);
    let pose = |index: usize| {
        let steps = index as Real - 0.5 * STEP_COUNT as Real;
        Pose3::from_parts(
            place.pos12.translation + 0.5 * step * steps * slide,
            Quat::from_axis_angle(axis, angle * steps) * place.pos12.rotation,
        )
    };
    (0..=STEP_COUNT).map(pose).collect()
}

/// Largest distance of a vertex from an axis through the origin.
fn radius(shape: &SharedShape, axis: Vec3) -> Real {
    let vertices = shape.as_trimesh().map_or(&[][..], |mesh| mesh.vertices());
    vertices.iter().map(|vertex| vertex.cross(axis).length()).fold(Real::MIN_POSITIVE, Real::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;

    /// Would catch steps that are shorter or longer than tables say, a motion without turning or
    /// sliding, and one that does not lead through the place where the meshes touch.
    #[test]
    fn steps_move_the_surface_by_the_stated_amount() {
        let shape = mesh::monkey_head_with(6).shared_shape().unwrap();
        let vertices = shape.as_trimesh().unwrap().vertices();
        let pos12 = Pose3::new(Vec3::new(0.4, 1.3, -0.6), Vec3::new(0.3, -1.2, 0.8));
        let place = Place { pos12, direction: Vec3::new(0.48, 0.6, -0.64) };
        for step in [0.001, 0.01] {
            let poses = motion(&shape, &place, step);
            assert_eq!(poses.len(), STEP_COUNT + 1);
            let middle = poses[STEP_COUNT / 2];
            assert!((middle.translation - pos12.translation).length() < 1e-6);
            assert!(middle.rotation.angle_between(pos12.rotation) < 1e-3);
            for pair in poses.windows(2) {
                let moved = vertices.iter().map(|&v| (pair[1] * v - pair[0] * v).length());
                let farthest = moved.fold(0.0, Real::max);
                assert!((0.8..=1.01).contains(&(farthest / step)), "{farthest} for {step}");
                let slid = (pair[1].translation - pair[0].translation).length();
                assert!((slid / step - 0.5).abs() < 0.01, "{slid} for {step}");
            }
        }
    }
}
