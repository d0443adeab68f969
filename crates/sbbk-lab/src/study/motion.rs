//! Where a second shape comes to touch a first one, and how it moves there.

use std::f32::consts::FRAC_1_SQRT_2;
use std::fmt;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{SharedShape, TriMesh};
use rapier3d::math::Real;

use crate::backend::SharedDispatcher;
use crate::metrics::Sequence;
use crate::scene::random;

/// Steps of one motion, after its first query.
pub const STEP_COUNT: usize = 16;

/// Steps of the coarse search for the first touch. Fewer: thin parts pass through each other, and
/// the first touch found is not the first.
const COARSE_STEPS: usize = 64;
/// Approaches tried until one touches: nearly all do.
const TRIES: usize = 100;

/// How a pair is asked, and how far a step moves the surface, in prediction distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// For the first time.
    Fresh,
    /// In motion, with what the query before left.
    Steady(Real),
}

impl Mode {
    pub const SLOW: Self = Self::Steady(0.05);
    pub const FAST: Self = Self::Steady(0.5);
    pub const ALL: [Self; 3] = [Self::Fresh, Self::SLOW, Self::FAST];

    /// The queries of two shapes at a place, see [`motion`].
    pub fn sequence(self, shapes: [&SharedShape; 2], place: &Place, prediction: Real) -> Sequence {
        let poses = match self {
            Self::Fresh => vec![place.pos12],
            Self::Steady(share) => motion(shapes[1], place, share * prediction, STEP_COUNT),
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

/// How the queries of each mode are made, for notes.
pub(super) fn mode_notes() -> Vec<String> {
    vec![
        "fresh: nothing known about the pair, trees built; to free the manifolds is part of it"
            .into(),
        format!(
            "steady: {STEP_COUNT} steps in a straight line while turning, which move the surface by \
             up to so many prediction distances each, with what the query before left"
        ),
    ]
}

/// A straight way of the second shape to its first touch with the first one.
pub(super) struct Approach {
    pub rotation: Quat,
    /// Unit vector from the first shape, against the way.
    pub direction: Vec3,
    /// Where the way leads, if nothing stops it.
    pub end: Vec3,
    /// Distance from the end at which the shapes touch and a bit farther away do not.
    touch: Real,
}

/// Where the second shape is, in the frame of the first, and from where it came.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub pos12: Pose3,
    /// Unit vector from the first shape, against the way that the second one came.
    pub direction: Vec3,
}

impl Approach {
    /// A way in a random orientation along a random direction. The shape may pass through a hole,
    /// as of a torus: then another is tried.
    ///
    /// Panics where none touches, as of shapes without extent.
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

    /// The way along `direction` to `end`; `None` if the shapes do not touch.
    pub fn along(
        direction: Vec3,
        rotation: Quat,
        end: Vec3,
        dispatcher: &SharedDispatcher,
        shapes: [&SharedShape; 2],
    ) -> Option<Self> {
        let mut way = Self { rotation, direction, end, touch: 0.0 };
        way.touch = way.first_touch(dispatcher, shapes)?;
        Some(way)
    }

    fn first_touch(
        &self,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&SharedShape; 2],
    ) -> Option<Real> {
        let opposite = self.rotation.inverse() * -self.direction;
        let farthest =
            reach(shape1, self.end, self.direction) + reach(shape2, Vec3::ZERO, opposite);
        let step = farthest / COARSE_STEPS as Real;
        let touches = |distance: &Real| {
            let answer = dispatcher.intersection_test(&self.at(*distance), &**shape1, &**shape2);
            answer.is_ok_and(|answer| answer.intersecting)
        };
        let mut distances = (0..COARSE_STEPS).map(|i| farthest - step * i as Real);
        let mut inside = distances.find(touches)?;
        let mut outside = inside + step;
        loop {
            let middle = 0.5 * (inside + outside);
            if middle <= inside || middle >= outside {
                return Some(inside);
            }
            *(if touches(&middle) { &mut inside } else { &mut outside }) = middle;
        }
    }

    fn at(&self, distance: Real) -> Pose3 {
        Pose3::from_parts(self.end + distance * self.direction, self.rotation)
    }

    /// So far beyond the first touch, in units; negative: short of it.
    pub fn place(&self, advance: Real) -> Place {
        Place { pos12: self.at(self.touch - advance), direction: self.direction }
    }
}

/// How far a shape reaches in a direction from a point of its frame.
fn reach(shape: &SharedShape, from: Vec3, direction: Vec3) -> Real {
    // Shapes of the studies that are no meshes reach less far; floors are approached from above.
    const OTHERS: Real = 2.0;
    let heights = |mesh: &TriMesh| {
        let heights = mesh.vertices().iter().map(|vertex| (*vertex - from).dot(direction));
        heights.fold(Real::NEG_INFINITY, Real::max)
    };
    shape.as_trimesh().map_or(OTHERS, heights)
}

/// Poses from before a place through it to as far behind it, `step_count` equal steps: the mesh
/// `shape` slides along a straight line and turns about its origin at once. Each of the two moves
/// the point of the surface that it moves most by half of `step`; together they move no point
/// farther than `step`, and some nearly so far.
pub(super) fn motion(
    shape: &SharedShape,
    place: &Place,
    step: Real,
    step_count: usize,
) -> Vec<Pose3> {
    // Along the first shape, and about an axis that is neither that of rolling nor that of
    // spinning.
    let slide = place.direction.any_orthonormal_vector();
    let axis = FRAC_1_SQRT_2 * (place.direction + place.direction.cross(slide));
    let local_axis = place.pos12.rotation.inverse() * axis;
    let vertices = shape.as_trimesh().map_or(&[][..], |mesh| mesh.vertices());
    let radii = vertices.iter().map(|vertex| vertex.cross(local_axis).length());
    let angle = 0.5 * step / radii.fold(Real::MIN_POSITIVE, Real::max);
    let pose = |index: usize| {
        let steps = index as Real - 0.5 * step_count as Real;
        Pose3::from_parts(
            place.pos12.translation + 0.5 * step * steps * slide,
            Quat::from_axis_angle(axis, angle * steps) * place.pos12.rotation,
        )
    };
    (0..=step_count).map(pose).collect()
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
            let poses = motion(&shape, &place, step, STEP_COUNT);
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
