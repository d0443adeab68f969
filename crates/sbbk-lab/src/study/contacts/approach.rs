//! Poses at which two meshes are near, touch and cross.

use std::f32::consts::FRAC_1_SQRT_2;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;

use super::contest::{Contest, Memory};
use crate::scene::random;

/// Where the second mesh is, and from where it came.
#[derive(Clone, Copy, Debug)]
pub(in crate::study) struct Place {
    /// Pose of the second mesh in the frame of the first.
    pub pos12: Pose3,
    /// Unit vector from the first mesh, against the way that the second one came.
    pub direction: Vec3,
}

/// Places along one approach.
pub(super) const PLACE_COUNT: usize = 5;

/// Where there would be more contacts than these, the approach ends earlier: two meshes of 70,000
/// triangles, a tenth of a unit long, have tens of millions within 0.02 units. Higher: minutes and
/// gigabytes for the same verdict. Lower: meshes touch and cross in fewer cases.
pub const PAIR_LIMIT: usize = 40_000;
/// The way to a place is halved at most so often to stay below the limit.
const HALVINGS: i32 = 7;
/// Steps of the coarse search for the first touch. Fewer: thin parts pass through each other, and
/// the first touch found is not the first.
const COARSE_STEPS: usize = 64;

/// Approaches tried until one touches: nearly all do.
const TRIES: usize = 100;

/// A way towards the first mesh on which the meshes do touch.
struct Approach {
    rotation: Quat,
    direction: Vec3,
    /// Distance of the origins when they first touch.
    touch: Real,
}

/// How far the second mesh goes beyond the first touch, in units; negative: short of it. The
/// distance of the meshes is at most the way back to where they touch, so that they are within the
/// prediction distance at all places.
fn advances(size: Real, prediction: Real) -> [Real; PLACE_COUNT] {
    [-0.95 * prediction, -0.5 * prediction, 0.0, 0.02 * size, 0.06 * size]
}

/// The places of one approach, in a random orientation and along a random direction, from apart to
/// deep inside.
pub(super) fn places(
    contest: &Contest,
    shape: &SharedShape,
    (size, prediction): (Real, Real),
    random: &mut Rand32,
) -> [Place; PLACE_COUNT] {
    let ask = |pos12: &Pose3, prediction| {
        let mut memory = Memory::default();
        memory.ask(contest.sbbk(), shape, pos12, prediction);
        memory.manifolds
    };
    let touches = |pos12: &Pose3| {
        let mut points = ask(pos12, 0.0).into_iter().flat_map(|manifold| manifold.points);
        points.any(|point| point.dist <= 0.0)
    };
    let approach = Approach::new(shape, touches, random);
    let advances = advances(size, prediction);
    let first = advances[0];
    advances.map(|advance| {
        let ways = (0..=HALVINGS).rev().map(|k| first + (advance - first) * 0.5f32.powi(k));
        let poses = ways.map(|way| approach.pose(way));
        let is_small = |pos12: &Pose3| ask(pos12, prediction).len() <= PAIR_LIMIT;
        let pos12 = poses.take_while(is_small).last().unwrap_or(approach.pose(first));
        Place { pos12, direction: approach.direction }
    })
}

impl Approach {
    /// A random approach. The mesh may pass through a hole, as of a torus: then another is tried.
    /// If none touches, which is so for a mesh without extent only, the last one ends where the
    /// origins meet.
    fn new(shape: &SharedShape, touches: impl Fn(&Pose3) -> bool, random: &mut Rand32) -> Self {
        let mut approach = Self { rotation: Quat::IDENTITY, direction: Vec3::Y, touch: 0.0 };
        for _ in 0..TRIES {
            (approach.rotation, approach.direction) =
                (random::rotation(random), random::direction(random));
            if let Some(touch) = approach.first_touch(shape, &touches) {
                return Self { touch, ..approach };
            }
        }
        approach
    }

    /// Distance of the origins at which the meshes touch and a bit farther away do not.
    fn first_touch(&self, shape: &SharedShape, touches: impl Fn(&Pose3) -> bool) -> Option<Real> {
        let opposite = self.rotation.inverse() * -self.direction;
        let farthest = reach(shape, self.direction) + reach(shape, opposite);
        let step = farthest / COARSE_STEPS as Real;
        let is_in = |distance: &Real| touches(&self.pose(-distance));
        let mut distances = (0..COARSE_STEPS).map(|i| farthest - step * i as Real);
        let mut inside = distances.find(is_in)?;
        let mut outside = inside + step;
        loop {
            let middle = 0.5 * (inside + outside);
            if middle <= inside || middle >= outside {
                return Some(inside);
            }
            *(if is_in(&middle) { &mut inside } else { &mut outside }) = middle;
        }
    }

    fn pose(&self, advance: Real) -> Pose3 {
        Pose3::from_parts((self.touch - advance) * self.direction, self.rotation)
    }
}

impl Place {
    /// A direction in which to slide along the first mesh, and an axis about which to turn that is
    /// neither that of rolling nor that of spinning on the spot.
    pub fn motion(&self) -> (Vec3, Vec3) {
        let slide = self.direction.any_orthonormal_vector();
        let roll = self.direction.cross(slide);
        (slide, FRAC_1_SQRT_2 * (self.direction + roll))
    }
}

/// How far a mesh reaches in a direction from its origin.
fn reach(shape: &SharedShape, direction: Vec3) -> Real {
    let vertices = shape.as_trimesh().map_or(&[][..], |mesh| mesh.vertices());
    vertices.iter().map(|vertex| vertex.dot(direction)).fold(Real::NEG_INFINITY, Real::max)
}
