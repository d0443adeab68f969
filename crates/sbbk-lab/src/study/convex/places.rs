//! Poses around the first touch.

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, QueryDispatcher};

use super::kinds::{Kind, Upright};
use crate::scene::random;
use crate::study::contacts::Place;

/// How far beyond the first touch the mesh is stopped, in prediction distances: about to touch, touching, and somewhat
/// deeper than a body at rest is.
const ADVANCES: [Real; 5] = [-0.95, -0.5, 0.0, 0.5, 2.0];
/// Steps of the coarse search for the first touch.
const COARSE_STEPS: usize = 64;
/// Ways tried until one touches: all but those past a shape do.
const TRIES: usize = 100;

/// The places of one approach: poses of the mesh in the frame of the shape.
pub(super) fn places(
    mesh: &SharedShape,
    kind: &Kind,
    prediction: Real,
    random: &mut Rand32,
) -> Vec<Place> {
    let way = (0..TRIES).find_map(|_| Way::new(mesh, kind, random));
    let places = |way: Way| ADVANCES.map(|advance| way.place(advance * prediction));
    way.map(places).map(Vec::from).unwrap_or_default()
}

/// A straight way towards a shape.
struct Way {
    rotation: Quat,
    direction: Vec3,
    /// Where the way ends, and how far before that the mesh first touches.
    end: Vec3,
    touch: Real,
}

impl Way {
    /// A random way; `None` if the mesh does not touch.
    fn new(mesh: &SharedShape, kind: &Kind, random: &mut Rand32) -> Option<Self> {
        let rotation = random::rotation(random);
        let [x, z] = [(); 2].map(|()| 20.0 * random.rand_float() - 10.0);
        let mut way = match kind.floor {
            None => Self::along(random::direction(random), rotation, Vec3::ZERO),
            Some(Upright::No) => Self::along(Vec3::Y, rotation, Vec3::new(x, 0.0, z)),
            Some(Upright::Yes) => Self::along(Vec3::Y, Quat::IDENTITY, Vec3::new(x, 0.0, z)),
        };
        way.touch = way.first_touch(mesh, kind)?;
        Some(way)
    }

    fn along(direction: Vec3, rotation: Quat, end: Vec3) -> Self {
        Self { rotation, direction, end, touch: 0.0 }
    }

    /// Distance from the end at which the shapes touch and a bit farther away do not.
    fn first_touch(&self, mesh: &SharedShape, kind: &Kind) -> Option<Real> {
        let extent = mesh.compute_local_bounding_sphere();
        let thickness = if kind.floor.is_some() { 1.0 } else { 2.0 };
        let farthest = extent.center.length() + extent.radius + thickness;
        let step = farthest / COARSE_STEPS as Real;
        let touches = |distance: Real| {
            let pose = self.pose(distance);
            let answer = DefaultQueryDispatcher.intersection_test(&pose, &*kind.shape.0, &*mesh.0);
            answer.is_ok_and(|answer| answer.intersecting)
        };
        let mut distances = (0..COARSE_STEPS).map(|i| farthest - step * i as Real);
        let mut inside = distances.find(|&distance| touches(distance))?;
        let mut outside = inside + step;
        while outside - inside > 1e-5 * farthest {
            let middle = 0.5 * (inside + outside);
            *(if touches(middle) { &mut inside } else { &mut outside }) = middle;
        }
        Some(inside)
    }

    fn pose(&self, distance: Real) -> Pose3 {
        Pose3::from_parts(self.end + distance * self.direction, self.rotation)
    }

    fn place(&self, advance: Real) -> Place {
        Place { pos12: self.pose(self.touch - advance), direction: self.direction }
    }
}
