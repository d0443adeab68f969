//! Approaches of a second shape to a first one, and motion about the places of contact.

use crate::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;
use std::fmt;

use rapier3d::geometry::TriMesh;

/// Steps of one motion, after its first query: they slide and turn.
pub(super) const STEP_COUNT: usize = 16;
/// Approaches tried until one touches.
const TRIES: usize = 100;

/// Kind of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// The first query of a pair.
    Fresh,
    /// Queries in motion, with the memory of the query before. A step moves the surface by up to so
    /// many prediction distances.
    Steady(Real),
}

impl Mode {
    pub const SLOW: Self = Self::Steady(0.05);
    pub const FAST: Self = Self::Steady(0.5);
    pub const ALL: [Self; 3] = [Self::Fresh, Self::SLOW, Self::FAST];

    /// Queries of two shapes at a place.
    pub fn sequence(self, shapes: [&SharedShape; 2], place: &Place, prediction: Real) -> Sequence {
        let poses = match self {
            Self::Fresh => vec![place.pos12],
            Self::Steady(share) => motion(shapes[1], place, share * prediction),
        };
        Sequence { shapes: shapes.map(SharedShape::clone), poses, prediction }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fresh => f.pad("fresh"),
            Self::Steady(share) => write!(f, "steady, {share} a step"),
        }
    }
}

/// A straight way of the second shape to its first touch with the first one.
pub(super) struct Approach {
    rotation: Quat,
    /// Unit vector from the first shape, against the way.
    direction: Vec3,
    /// End of the way, if nothing stops the shape.
    end: Vec3,
    /// Largest distance from the end at which the shapes touch.
    touch: Real,
}

/// A pose of the second shape in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub pos12: Pose3,
    /// Unit vector from the first shape, against the way of the second one.
    pub direction: Vec3,
}

impl Approach {
    /// Makes an approach in a random orientation along a random direction.
    ///
    /// Panics if no approach touches, as for shapes without extent.
    pub fn random(
        dispatcher: &SharedDispatcher,
        shapes: [&SharedShape; 2],
        random: &mut Rand32,
    ) -> Self {
        let mut way = || {
            let (rotation, direction) = (random::rotation(random), random::direction(random));
            Self::along(direction, rotation, Vec3::ZERO, dispatcher, shapes)
        };
        (0..TRIES).find_map(|_| way()).expect("shapes with an extent touch on some way")
    }

    /// Makes an approach along `direction` to `end`; `None` if the shapes do not touch.
    pub fn along(
        direction: Vec3,
        rotation: Quat,
        end: Vec3,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&SharedShape; 2],
    ) -> Option<Self> {
        let way = Self { rotation, direction, end, touch: 0.0 };
        let opposite = rotation.inverse() * -direction;
        let farthest = reach(shape1, end, direction) + reach(shape2, Vec3::ZERO, opposite);
        let meet = |distance| {
            let answer = dispatcher.intersection_test(&way.at(distance), &**shape1, &**shape2);
            answer.is_ok_and(|answer| answer.intersecting)
        };
        let touch = random::first_touch(farthest, 0.0, meet)?;
        Some(Self { touch, ..way })
    }

    fn at(&self, distance: Real) -> Pose3 {
        Pose3::from_parts(self.end + distance * self.direction, self.rotation)
    }

    /// The place so far beyond the first touch, in units.
    pub fn place(&self, advance: Real) -> Place {
        Place { pos12: self.at(self.touch - advance), direction: self.direction }
    }
}

/// Largest extent of a shape along a direction, from a point of its frame.
fn reach(shape: &SharedShape, from: Vec3, direction: Vec3) -> Real {
    /// Bound for the shapes of the studies that are no meshes.
    const OTHERS: Real = 2.0;
    let heights = |mesh: &TriMesh| {
        let heights = mesh.vertices().iter().map(|vertex| (*vertex - from).dot(direction));
        heights.fold(Real::NEG_INFINITY, Real::max)
    };
    shape.as_trimesh().map_or(OTHERS, heights)
}

/// Poses from before a place through it to as far behind it, in equal steps. The mesh slides along
/// a straight line and turns about its origin; each of the two moves the surface by half of `step`.
fn motion(shape: &SharedShape, place: &Place, step: Real) -> Vec<Pose3> {
    // The axis is between those for rolling and for spinning.
    let slide = place.direction.any_orthonormal_vector();
    let axis = FRAC_1_SQRT_2 * (place.direction + place.direction.cross(slide));
    let local_axis = place.pos12.rotation.inverse() * axis;
    let vertices = shape.as_trimesh().map_or(&[][..], |mesh| mesh.vertices());
    let radii = vertices.iter().map(|vertex| vertex.cross(local_axis).length());
    let angle = 0.5 * step / radii.fold(Real::MIN_POSITIVE, Real::max);
    let pose = |index: usize| {
        let steps = index as Real - 0.5 * STEP_COUNT as Real;
        Pose3::from_parts(
            place.pos12.translation + 0.5 * step * steps * slide,
            Quat::from_axis_angle(axis, angle * steps) * place.pos12.rotation,
        )
    };
    (0..=STEP_COUNT).map(pose).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;

    /// Would catch steps that are shorter or longer than tables say, and a motion without sliding.
    #[test]
    fn a_step_moves_the_surface_by_the_stated_amount() {
        let shape = mesh::monkey_head_with(6).shape();
        let vertices = shape.as_trimesh().unwrap().vertices();
        let pos12 = Pose3::new(Vec3::new(0.4, 1.3, -0.6), Vec3::new(0.3, -1.2, 0.8));
        let place = Place { pos12, direction: Vec3::new(0.48, 0.6, -0.64) };
        for step in [0.001, 0.01] {
            let poses = motion(&shape, &place, step);
            assert!((poses[STEP_COUNT / 2].translation - pos12.translation).length() < 1e-6);
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
